use super::*;
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::formats::metadata::Object;
use crate::formats::text::finding::{Finding, FindingList};
use crate::frames::ric_basis;
use crate::orbit::PropagatorDistance;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit};
use crate::orbit::{Model, Propagator};
use crate::time::TimeGrid;
use proptest::prelude::*;

/// `CelesTrak`'s documentation (ISS), the AIAA 2006-6753 verification set (Vanguard 1, a
/// decaying low orbit with a second derivative, a transfer orbit), and the Blue Book's GOES 9.
const PUBLISHED: &str = "\
ISS (ZARYA)
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
VANGUARD 1
1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753
2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667
28350
1 28350U 04020A   06167.21788666  .16154492  76267-5  18678-3 0  8894
2 28350  64.9977 345.6130 0024870 260.7578  99.9590 16.47856722116490
23599
1 23599U 95029B   06171.76535463  .00085586  12891-6  12956-2 0  2905
2 23599   6.9327   0.2849 5782022 274.4436  25.2425  4.47796565123555
";

fn epoch() -> Epoch {
    Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap())
}

fn written(sets: &[sgp4::Elements]) -> String {
    let mut out = Vec::new();
    for set in sets {
        write(&mut out, set).unwrap();
    }
    String::from_utf8(out).unwrap()
}

fn findings(text: impl AsRef<[u8]>) -> Vec<Finding> {
    let mut findings = FindingList::of_linter(20);
    parse(text.as_ref(), &mut findings, |_| ()).unwrap();
    findings.into_vec()
}

fn first_set() -> sgp4::Elements {
    read(PUBLISHED.as_bytes()).unwrap().remove(0)
}

fn design_sets(design: &Design, slot: MeanMotionSlot, at: Epoch) -> Vec<sgp4::Elements> {
    let set = |(index, satellite): (usize, &crate::constellation::Satellite)| {
        let name = crate::ephemeris::object_name(satellite.slot);
        let object = Object::numbered(&name, index, at).unwrap();
        crate::formats::element_set(&satellite.elements, &object, at, slot)
    };
    design.satellites().iter().enumerate().map(set).collect()
}

#[test]
fn validate_published_sets_survive_reading_and_writing() {
    let sets = read(PUBLISHED.as_bytes()).unwrap();
    assert_eq!(sets.len(), 4);
    assert_eq!(written(&sets), PUBLISHED);
    let iss = &sets[0];
    assert_eq!(iss.international_designator.as_deref(), Some("1998-067A"));
    assert_eq!(iss.drag_term, -0.11606e-4);
    // Day 264.51782528 of 2008, a leap year: 20 September, 0.51782528 day.
    assert_eq!(iss.datetime.to_string(), "2008-09-20 12:25:40.104192");
}

#[test]
fn line_ends_marks_and_prefixes_do_not_matter() {
    let expected = read(PUBLISHED.as_bytes()).unwrap();
    let windows = format!("\u{feff}{}", PUBLISHED.replace('\n', "\r\n"));
    assert_eq!(read(windows.as_bytes()).unwrap(), expected);
    let prefixed = PUBLISHED.replace("ISS", "0 ISS");
    assert_eq!(read(prefixed.as_bytes()).unwrap(), expected);
    let bare = PUBLISHED.lines().skip(1).take(2).collect::<Vec<_>>();
    let sets = read(bare.join("\n").as_bytes()).unwrap();
    assert_eq!(sets[0].object_name, None);
    assert_eq!(written(&sets), bare.join("\n") + "\n");
}

#[test]
fn broken_rules_are_named_with_their_place() {
    let cases: [(&str, &str, (usize, usize, &str)); 10] = [
        ("2927\n", "2928\n", (2, 69, "tle-checksum")),
        ("2 25544  51", "2 25545  51", (3, 69, "tle-checksum")),
        ("247.4627", "247,4627", (3, 21, "tle-column")),
        ("98067A  ", "98067A ", (2, 69, "tle-length")),
        ("1 25544U", "1 25544X", (2, 8, "tle-column")),
        ("1 25544U", "1 I5544U", (2, 3, "tle-column")),
        ("264.5178", "264 5178", (2, 24, "tle-column")),
        (
            "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927\n",
            "",
            (2, 1, "tle-pair"),
        ),
        (
            "\n2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537",
            "",
            (2, 1, "tle-pair"),
        ),
        ("1 25544U 98", "1\u{7f}25544U 98", (2, 2, "character")),
    ];
    let iss = PUBLISHED.lines().take(3).collect::<Vec<_>>().join("\n") + "\n";
    for (from, to, (line, column, rule)) in cases {
        let text = iss.replace(from, to);
        assert_ne!(text, iss, "{from}");
        let found = findings(&text);
        let first = found.first().unwrap_or_else(|| panic!("{to} passes"));
        assert_eq!(
            (first.line, first.column, first.rule),
            (line, column, rule),
            "{first}"
        );
        let error = read(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(error, first.to_string());
    }
    assert_eq!(findings("")[0].rule, "tle-empty");
    assert_eq!(findings("just a name\n")[0].rule, "tle-line");
}

/// Replaces columns and corrects the checksum, so that only the value is wrong.
fn with_columns(line: &str, from: usize, text: &str) -> String {
    let mut line = line.to_owned();
    line.replace_range(from..from + text.len(), text);
    let sum = checksum(&line.as_bytes()[..LINE - 1]);
    line.replace_range(LINE - 1.., &sum.to_string());
    line
}

#[test]
fn values_out_of_range_are_named() {
    let lines: Vec<&str> = PUBLISHED.lines().collect();
    let cases = [
        (1, 20, "000.51782528", 21),
        (1, 20, "367.51782528", 21),
        (2, 8, "180.0001", 9),
        (2, 17, "360.0001", 18),
        (2, 52, "99.72125391", 53),
    ];
    for (line, from, text, column) in cases {
        let mut changed: Vec<String> = lines[..3].iter().map(|l| (*l).to_owned()).collect();
        changed[line] = with_columns(&changed[line], from, text);
        let found = findings(changed.join("\n"));
        assert_eq!(
            (found[0].column, found[0].rule),
            (column, "tle-range"),
            "{text}"
        );
    }
}

#[test]
fn what_does_not_fit_the_columns_is_refused() {
    let change = |edit: fn(&mut sgp4::Elements)| {
        let mut set = first_set();
        edit(&mut set);
        lines(&set).unwrap_err().to_string()
    };
    assert!(change(|s| s.norad_id = 340_000).contains("339999"));
    assert!(change(|s| s.mean_motion = 100.0).contains("99.99999999"));
    assert!(change(|s| s.eccentricity = 1.0).contains("0.9999999"));
    assert!(change(|s| s.inclination = -1.0).contains("0 to 360"));
    assert!(change(|s| s.inclination = f64::NAN).contains("0 to 360"));
    assert!(change(|s| s.drag_term = 1e10).contains("B*"));
    assert!(change(|s| s.mean_motion_dot = 1.0).contains("derivative"));
    assert!(change(|s| s.element_set_number = 10_000).contains("too many digits"));
    assert!(change(|s| s.datetime += chrono::TimeDelta::nanoseconds(1)).contains("1e-8 day"));
    assert!(change(|s| s.international_designator = Some("X".into())).contains("1998-067A"));
    let mut set = first_set();
    set.object_name = Some("A NAME THAT IS TOO LONG FOR IT".to_owned());
    assert!(write(&mut Vec::new(), &set).is_err());
}

#[test]
fn epochs_are_rounded_to_the_step() {
    let at = Epoch::from_utc("2025-06-30T23:59:59.999700Z".parse().unwrap());
    // 300 µs before midnight, which is the nearest step of 864 µs.
    assert_eq!(rounded_epoch(at).to_string(), "2025-07-01T00:00:00Z");
    let at = Epoch::from_utc("2025-06-30T00:00:00.000500Z".parse().unwrap());
    assert_eq!(rounded_epoch(at).to_string(), "2025-06-30T00:00:00.000864Z");
    assert_eq!(rounded_epoch(rounded_epoch(at)), rounded_epoch(at));
}

#[test]
fn a_design_survives_its_file_and_tells_the_loss() {
    let design: Design = "delta:55:182/13/1@925".parse().unwrap();
    let sets = design_sets(&design, MeanMotionSlot::Kozai, epoch());
    let text = written(&sets);
    let read_back = read(text.as_bytes()).unwrap();
    assert_eq!(written(&read_back), text);
    assert!(text.starts_with(
        "NW-P01-S01\n1 90001U 25900A   25001.00000000  .00000000  00000-0  00000-0 0    1"
    ));
    let grid = TimeGrid::new(epoch(), 86_400.0, 600.0).unwrap();
    let orbit = |set: &sgp4::Elements| Sgp4Orbit::from_element_set(set, epoch()).unwrap();
    let (exact, rounded) = (orbit(&sets[17]), orbit(&read_back[17]));
    let loss = PropagatorDistance::between(&exact, &rounded, grid).unwrap();
    // Half a digit of an angle, 5e-5°, is 6.4 m at 7303 km; three angles add up to less than 20 m.
    // Half a digit of the mean motion, 5e-9 rev/day, is 0.2 m after a day.
    assert!(loss.max_km > 1e-4 && loss.max_km < 0.02, "{loss:?}");
    assert!(loss.rms_km <= loss.max_km);
    assert_eq!(as_written(&sets[17]).unwrap(), read_back[17]);
}

/// Slope of a straight line through the constellation's mean in-track difference between
/// mean J2 and SGP4 of the written file, km/day.
fn growth_km_per_day(inclination_deg: f64, slot: MeanMotionSlot) -> f64 {
    let design: Design = format!("delta:{inclination_deg}:6/3/1@925")
        .parse()
        .unwrap();
    let sets = read(written(&design_sets(&design, slot, epoch())).as_bytes()).unwrap();
    let grid = TimeGrid::new(epoch(), 86_400.0, 300.0).unwrap();
    let propagated = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
    let orbits: Vec<_> = sets
        .iter()
        .map(|set| Sgp4Orbit::from_element_set(set, epoch()).unwrap())
        .collect();
    let mean = |elapsed_s: f64| {
        let apart = |(satellite, orbit): (&crate::ephemeris::EphemerisSatellite, &Sgp4Orbit)| {
            let j2 = propagated.state(satellite, elapsed_s).unwrap();
            let sgp4 = orbit.state_at(elapsed_s).unwrap();
            (ric_basis(&j2).unwrap() * (sgp4.position_km - j2.position_km)).y
        };
        propagated
            .satellites()
            .iter()
            .zip(&orbits)
            .map(apart)
            .sum::<f64>()
            / orbits.len() as f64
    };
    let samples: Vec<_> = grid.iter().map(|t| (t / 86_400.0, mean(t))).collect();
    let n = samples.len() as f64;
    let (st, sy) = samples
        .iter()
        .fold((0.0, 0.0), |(a, b), (t, y)| (a + t, b + y));
    let (mt, my) = (st / n, sy / n);
    let cross: f64 = samples.iter().map(|(t, y)| (t - mt) * (y - my)).sum();
    let square: f64 = samples.iter().map(|(t, _)| (t - mt) * (t - mt)).sum();
    cross / square
}

/// The error that this format is known for. The Kepler drifts are those of un-Kozai'd SGP4
/// secular rates against J2 with dM/dt at 925 km, by a separate calculation:
/// -300, -95, 4, 98, 391, 395 km/day at 40, 50, 55, 60, 86.4, 90°.
#[test]
fn validate_drift_of_both_mean_motion_slots() {
    let kepler = [
        (40.0, -300.0),
        (50.0, -95.0),
        (55.0, 4.0),
        (60.0, 98.0),
        (86.4, 391.0),
        (90.0, 395.0),
    ];
    for (inclination_deg, expected) in kepler {
        let right = growth_km_per_day(inclination_deg, MeanMotionSlot::Kozai);
        // Second-order terms that mean J2 leaves out are worth about 1 km/day.
        assert!(right.abs() < 2.0, "{inclination_deg}°: {right} km/day");
        let naive = growth_km_per_day(inclination_deg, MeanMotionSlot::Kepler);
        assert!(
            (naive - expected).abs() < 2.5,
            "{inclination_deg}°: {naive} km/day"
        );
    }
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = findings(&bytes);
    }

    /// Digits changed at random inside valid lines: refused or read, never a panic.
    #[test]
    fn damaged_sets_never_panic(at in 0_usize..150, byte in b' '..=b'~') {
        let mut bytes = PUBLISHED.as_bytes().to_vec();
        bytes[at] = byte;
        let _ = findings(&bytes);
    }

    #[test]
    fn any_orbit_survives(
        i in 0.0..180.0_f64, e in 0.0..0.8_f64, angles in prop::array::uniform3(0.0..360.0_f64),
        n in 0.9..16.0_f64, drag in -1.0..1.0_f64, day in 0_i64..30_000,
    ) {
        let mut set = first_set();
        set.inclination = i;
        set.eccentricity = e;
        [set.right_ascension, set.argument_of_perigee, set.mean_anomaly] = angles;
        (set.mean_motion, set.drag_term) = (n, drag);
        set.datetime = chrono::NaiveDate::from_ymd_opt(1960, 1, 1).unwrap().and_hms_opt(0, 0, 0).unwrap()
            + chrono::TimeDelta::days(day) + chrono::TimeDelta::nanoseconds(day * 123_457 * EPOCH_STEP_NS % 86_400_000_000_000);
        let text = written(&[set]);
        prop_assert_eq!(written(&read(text.as_bytes()).unwrap()), text);
    }
}

/// Found by fuzzing: what a reader takes, a writer has to write, and the other way round.
#[test]
fn regress_what_is_read_can_be_written() {
    let [_, first, second] = PUBLISHED.lines().take(3).collect::<Vec<_>>()[..] else {
        panic!()
    };
    let read_back = |name: &str, first: &str, second: &str| {
        let sets = read(format!("{name}{first}\n{second}\n").as_bytes()).unwrap();
        assert_eq!(
            read(written(&sets).as_bytes()).unwrap(),
            sets,
            "{name}{first}\n{second}"
        );
        sets[0].clone()
    };
    // Blanks after the marker of a name, and a name that itself looks like a marker.
    assert_eq!(
        read_back("0   A\n", first, second).object_name.as_deref(),
        Some("A")
    );
    let marked = read_back("0 0 B\n", first, second);
    assert_eq!(marked.object_name.as_deref(), Some("0 B"));
    // B* below the smallest power of ten, and an angle of a whole turn.
    let small = with_columns(first, 53, " 00120-9");
    let drag = read_back("", &small, second).drag_term;
    assert!((drag - 1.2e-12).abs() < 1e-26, "{drag}");
    let turned = with_columns(second, 17, "360.0000");
    assert_eq!(read_back("", first, &turned).right_ascension, 0.0);
    // An invalid designator is dropped with a warning.
    let odd = with_columns(first, 9, "98067A B");
    assert_eq!(read_back("", &odd, second).international_designator, None);
    assert_eq!(
        findings(format!("{odd}\n{second}\n"))[0].rule,
        "tle-designator"
    );
    for (one, two, rule) in [
        (
            first.to_owned(),
            with_columns(second, 52, " 0.00000000"),
            "tle-range",
        ),
        (
            with_columns(first, 2, "2 5 4"),
            with_columns(second, 2, "2 5 4"),
            "tle-catalogue-number",
        ),
    ] {
        let found = findings(format!("{one}\n{two}\n"));
        assert_eq!(found[0].rule, rule, "{found:?}");
    }
}
