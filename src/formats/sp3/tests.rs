use super::*;
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::formats::metadata::Theory;
use crate::formats::text::finding::{Finding, FindingList};
use crate::frames::{Teme, from_teme};
use crate::orbit::Model;
use crate::time::TimeGrid;
use nalgebra::Vector3;
use proptest::prelude::*;

fn ephemeris(design: &str) -> Ephemeris {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 600.0, 97.5).unwrap();
    let design: Design = design.parse().unwrap();
    Ephemeris::of_design(&design, Model::J2, grid).unwrap()
}

fn written(ephemeris: &Ephemeris, version: Sp3Version, letter: char) -> Result<String, WriteError> {
    let epoch = ephemeris.grid().epoch();
    let metadata = Metadata {
        originator: "NAVWALKER".to_owned(),
        creation: epoch,
        frame: Frame::EarthFixed,
        time_system: TimeSystem::Gps,
        theory: Theory::Propagated(Model::J2),
        subject: vec!["Design: delta:55:20/5/1@925".to_owned()],
        frame_note: None,
        from_files: false,
    };
    let objects = Object::all(ephemeris.satellites(), epoch).unwrap();
    let satellites: Vec<_> = ephemeris.satellites().iter().zip(&objects).collect();
    let sampled = Sampled::new(ephemeris, EarthFixed);
    let mut out = Vec::new();
    write(&mut out, version, letter, &metadata, &sampled, &satellites)?;
    Ok(String::from_utf8(out).unwrap())
}

fn findings(text: impl AsRef<[u8]>) -> Vec<Finding> {
    let mut findings = FindingList::of_linter(20);
    parse(text.as_ref(), &mut findings).unwrap();
    findings.into_vec()
}

/// Columns of SP3-c: the first two lines of a file of 1 January 2025, 0h UTC, which is 18 s into
/// Wednesday of GPS week 2347; modified Julian day 60676.
#[test]
fn validate_columns_of_the_header() {
    let text = written(&ephemeris("delta:55:20/5/1@925"), Sp3Version::C, 'L').unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[0],
        "#cV2025  1  1  0  0 18.00000000       7 ORBIT ITRF  EXT  NWK"
    );
    assert_eq!(
        lines[1],
        "## 2347 259218.00000000    97.50000000 60676 0.0002083333333"
    );
    assert_eq!(
        lines[2],
        "+   20   L01L02L03L04L05L06L07L08L09L10L11L12L13L14L15L16L17"
    );
    assert_eq!(
        lines[3],
        "+        L18L19L20  0  0  0  0  0  0  0  0  0  0  0  0  0  0"
    );
    assert_eq!(
        lines[7],
        "++         0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0"
    );
    assert_eq!(
        lines[12],
        "%c L  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc"
    );
    // Twenty-two lines before the first epoch (SP3-c, table of the header).
    assert_eq!(lines[22], "*  2025  1  1  0  0 18.00000000");
    assert!(lines[23].starts_with("PL01") && lines[24].starts_with("VL01"));
    assert!(lines[..22].iter().all(|line| line.len() <= 60));
    assert_eq!((lines[23].len(), lines[24].len()), (60, 60));
    assert_eq!(lines.last(), Some(&"EOF"));
}

#[test]
fn states_survive_with_their_units() {
    let ephemeris = ephemeris("delta:55:20/5/1@925");
    for version in [Sp3Version::C, Sp3Version::D] {
        let text = written(&ephemeris, version, 'X').unwrap();
        assert_eq!(findings(&text), [], "{version}");
        let file = read(text.as_bytes()).unwrap();
        assert_eq!((file.ids.len(), file.frame.as_str()), (20, "ITRF"));
        assert_eq!(file.ids[19], "X20");
        for (satellite, states) in ephemeris.satellites().iter().zip(&file.states) {
            assert_eq!(states.len(), 7);
            for (found, expected) in states.iter().zip(ephemeris.states(satellite)) {
                let (elapsed_s, teme) = expected.unwrap();
                let expected =
                    from_teme(teme, Frame::EarthFixed, ephemeris.grid().epoch(), elapsed_s);
                // Half a digit of 1e-6 km and of 1e-6 dm/s in three components.
                assert!((found.position_km - expected.position_km).norm() < 1e-6);
                assert!((found.velocity_km_s.unwrap() - expected.velocity_km_s).norm() < 1e-10);
                assert_eq!(found.at.seconds_since(ephemeris.grid().epoch()), elapsed_s);
            }
        }
    }
}

#[test]
fn sp3d_names_every_satellite_in_its_comments() {
    let text = written(&ephemeris("delta:55:98/7/1@925"), Sp3Version::D, 'L').unwrap();
    assert!(text.contains("\n/* L98 = NW-P07-S14\n"));
    assert!(text.lines().all(|line| line.len() <= 80));
    assert_eq!(read(text.as_bytes()).unwrap().ids.len(), 98);
}

#[test]
fn what_does_not_fit_is_refused() {
    let error = |design: &str, version, letter| {
        written(&ephemeris(design), version, letter)
            .unwrap_err()
            .to_string()
    };
    assert!(error("delta:55:98/7/1@925", Sp3Version::C, 'L').contains("1 to 85"));
    assert!(error("delta:55:100/5/1@925", Sp3Version::D, 'L').contains("1 to 99"));
    assert!(error("delta:55:6/3/1@925", Sp3Version::D, 'l').contains("capital"));
}

#[test]
fn broken_rules_are_named_with_their_place() {
    let text = written(&ephemeris("delta:55:6/3/1@925"), Sp3Version::C, 'L').unwrap();
    let cases = [
        ("#cV", "#zV", (1, 1, "sp3-first-line")),
        ("      7 ORBIT", "      8 ORBIT", (114, 1, "sp3-count")),
        ("+    6 ", "+    7 ", (114, 1, "sp3-count")),
        ("L02L03", "L02L02", (3, 16, "sp3-id")),
        ("L02L03", "L020X3", (3, 16, "sp3-id")),
        ("cc GPS", "cc LOC", (13, 10, "sp3-time-system")),
        (
            "*  2025  1  1  0  1 55",
            "*  2025  1  1  0  0 17",
            (36, 4, "sp3-time-order"),
        ),
        (
            "*  2025  1  1  0  1 55",
            "*  2025  1 41  0  1 55",
            (36, 4, "sp3-time"),
        ),
        ("\nPL03", "\nPL09", (28, 2, "sp3-id")),
        ("\nPL03", "\nPL02", (28, 2, "sp3-repeated")),
        ("\nVL03", "\nVL04", (29, 1, "sp3-velocity")),
        ("\nPL03", "\nPL03 x", (28, 5, "sp3-number")),
        ("EOF\n", "EOF\nmore\n", (115, 1, "sp3-line")),
        ("/* T", "?? T", (20, 1, "sp3-line")),
    ];
    let mut misplaced = Vec::new();
    for (from, to, expected) in cases {
        let broken = text.replacen(from, to, 1);
        assert_ne!(broken, text, "{from}");
        assert!(read(broken.as_bytes()).is_err(), "{from}");
        let found = findings(&broken);
        if !found.iter().any(|f| (f.line, f.column, f.rule) == expected) {
            let places: Vec<_> = found.iter().map(|f| (f.line, f.column, f.rule)).collect();
            misplaced.push((from, to, expected, places));
        }
    }
    assert!(misplaced.is_empty(), "{misplaced:#?}");
    assert!(read(&b""[..]).is_err());
}

/// Products of laser ranging: comments of their own form, any characters in them, and no end mark.
#[test]
fn comments_and_the_end_are_taken_as_services_write_them() {
    let text = written(&ephemeris("delta:55:6/3/1@925"), Sp3Version::C, 'L').unwrap();
    let expected = read(text.as_bytes()).unwrap().states;
    let other = text.replacen("/* ", "%/* Universit\u{e4}t ", 1);
    let other = other.trim_end().strip_suffix("EOF").unwrap();
    let rules: Vec<_> = findings(other).iter().map(|f| f.rule).collect();
    assert_eq!(rules, ["character", "sp3-eof"]);
    assert_eq!(read(other.as_bytes()).unwrap().states, expected);
    let latin: Vec<u8> = text
        .replacen("/* ", "/* ~", 1)
        .bytes()
        .map(|b| if b == b'~' { 0xe4 } else { b })
        .collect();
    assert_eq!(read(latin.as_slice()).unwrap().states, expected);
    // With a satellite less at the last epoch it is cut short.
    let lines: Vec<&str> = other.lines().collect();
    let cut = lines[..lines.len() - 2].join("\n");
    assert!(findings(&cut).iter().any(|f| f.rule == "sp3-truncated"));
    assert!(read(cut.as_bytes()).is_err());
}

/// Metres in place of decimetres, and velocities against the stars: 3 m/s and more of 37 000 dm/s.
#[test]
fn velocities_that_are_not_the_derivative_are_told() {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 1_800.0, 60.0).unwrap();
    let design: Design = "delta:55:2/1/0@925".parse().unwrap();
    let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
    let text = written(&ephemeris, Sp3Version::C, 'L').unwrap();
    assert_eq!(findings(&text), []);
    let scaled = |line: &str| {
        if !line.starts_with('V') {
            return format!("{line}\n");
        }
        let number = |at: usize| line[at..at + 14].trim().parse::<f64>().unwrap() / 10.0;
        let [x, y, z] = [4, 18, 32].map(number);
        format!("{}{x:14.6}{y:14.6}{z:14.6}{}\n", &line[..4], &line[46..])
    };
    let metres: String = text.lines().map(scaled).collect();
    let found = findings(&metres);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(
        (found[0].rule, found[0].severity),
        (
            "sp3-velocity-unit",
            crate::formats::text::finding::Severity::Warning
        )
    );
}

proptest! {
    #[test]
    fn damaged_files_never_panic(at in any::<prop::sample::Index>(), byte in any::<u8>(), cut in 0_usize..90) {
        let mut bytes = written(&ephemeris("delta:55:6/3/1@925"), Sp3Version::D, 'L').unwrap().into_bytes();
        let at = at.index(bytes.len());
        bytes[at] = byte;
        let end = (at + cut).min(bytes.len());
        bytes.drain(at..end);
        let _ = findings(&bytes);
    }
}

/// A satellite so far away, or so fast, that its numbers need more columns than SP3 has.
struct Distant(State<Teme>);

impl crate::orbit::Propagator for Distant {
    fn state_at(&self, _: f64) -> Result<State<Teme>, crate::orbit::PropagationError> {
        Ok(self.0)
    }
}

/// Found by fuzzing: such a number ran into the next one, and the file was not read back.
#[test]
fn regress_numbers_wider_than_their_columns_are_refused() {
    let near = ephemeris("delta:55:1/1/0@925");
    let grid = near.grid();
    for (position_km, velocity_km_s, fits) in [
        (499_999.0, 1.0, true),
        (1e7, 1.0, false),
        (7_000.0, 11_078.0, false),
    ] {
        let state = State::new(
            Vector3::new(0.0, 0.0, position_km),
            Vector3::new(0.0, 0.0, velocity_km_s),
        );
        let far = EphemerisSatellite {
            name: "FAR".to_owned(),
            slot: None,
            propagator: Box::new(Distant(state)),
        };
        let found = written(&Ephemeris::new(grid, vec![far]), Sp3Version::D, 'L');
        match found {
            Ok(text) => assert!(fits && read(text.as_bytes()).is_ok()),
            Err(error) => assert!(!fits && error.to_string().contains("14 columns"), "{error}"),
        }
    }
}

/// Found by fuzzing: a year of five digits shifted the columns, and weeks before 1980 were negative.
#[test]
fn regress_instants_without_a_week_are_refused() {
    for (epoch, fits) in [
        ("1980-01-05T00:00:00Z", false),
        ("1980-01-07T00:00:00Z", true),
        ("2171-08-01T00:00:00Z", true),
        ("2171-09-10T00:00:00Z", false),
    ] {
        let epoch = Epoch::from_utc(epoch.parse().unwrap());
        let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
        let design: Design = "delta:55:1/1/0@925".parse().unwrap();
        let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
        let found = written(&ephemeris, Sp3Version::D, 'L');
        assert_eq!(found.is_ok(), fits, "{epoch:?}");
        if let Err(error) = found {
            assert!(error.to_string().contains("1980-01-06"), "{error}");
        }
    }
}
