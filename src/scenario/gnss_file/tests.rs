use super::*;
use crate::constellation::gnss::Preset;
use crate::ephemeris::Ephemeris;
use crate::formats::yuma::{Almanac, Applicability};
use crate::orbit::Propagator;
use crate::time::Epoch;

fn grid(duration_s: f64, step_s: f64) -> TimeGrid {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    TimeGrid::new(epoch, duration_s, step_s).unwrap()
}

/// SP3 of presets under the letters of their systems, for some hours.
fn sp3(presets: &[(char, Preset)], start_h: u32, hours: u32) -> String {
    let epoch = grid(60.0, 60.0).epoch();
    let satellites: Vec<(String, _)> = presets
        .iter()
        .flat_map(|(letter, preset)| {
            let satellites = preset.satellites(epoch).into_iter().zip(1..);
            satellites.map(move |(satellite, n)| (format!("{letter}{n:02}"), satellite))
        })
        .collect();
    let mut ids: Vec<String> = satellites.iter().map(|(id, _)| id.clone()).collect();
    ids.resize(5 * 17, "  0".to_owned());
    let epochs = 4 * hours;
    let mut text =
        format!("#dP2025  1  1 {start_h:2}  0 18.00000000 {epochs:>7} ORBIT IGS20 FIT  TST\n");
    text += "## 2347 259218.00000000   900.00000000 60676 0.0002083333333\n";
    for (n, line) in ids.chunks(17).enumerate() {
        let count = if n == 0 {
            format!("{:>3}", satellites.len())
        } else {
            "   ".to_owned()
        };
        text += &format!("+  {count}   {}\n", line.concat());
    }
    text += "%c M  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n";
    for k in 0..epochs {
        let minutes = 60 * start_h + 15 * k;
        text += &format!(
            "*  2025  1  1 {:2} {:2} 18.00000000\n",
            minutes / 60,
            minutes % 60
        );
        let t = f64::from(minutes) * 60.0;
        for (id, satellite) in &satellites {
            let teme = satellite.orbit.state_at(t).unwrap();
            let r = crate::frames::from_teme(teme, crate::frames::EarthFixed, epoch, t)
                .position_km
                .km();
            text += &format!("P{id}{:14.6}{:14.6}{:14.6} 999999.999999\n", r.x, r.y, r.z);
        }
    }
    text + "EOF\n"
}

fn systems(files: &[(&str, &[u8])], grid: TimeGrid) -> Result<GnssFile, GnssFileError> {
    let mut all = GnssFiles::default();
    for (name, bytes) in files {
        all.add(name, bytes, grid)?;
    }
    all.finish(grid)
}

fn names(found: &GnssFile) -> Vec<(&str, usize)> {
    let epoch = grid(60.0, 60.0).epoch();
    found
        .systems
        .iter()
        .map(|one| (one.name(), one.satellites(epoch).len()))
        .collect()
}

/// A file of several systems is one clock each, its satellites where the presets are off the step too; two parts of a day
/// follow each other.
#[test]
fn states_of_many_systems_are_split_by_their_letter() {
    let presets = [('G', Preset::Gps), ('E', Preset::Galileo)];
    let (first, second) = (sp3(&presets, 0, 3), sp3(&presets, 3, 3));
    let study = grid(5.5 * 3_600.0, 300.0);
    let files = [
        ("dir/igs.sp3", first.as_bytes()),
        ("igs2.sp3", second.as_bytes()),
    ];
    let found = systems(&files, study).unwrap();
    assert_eq!(names(&found), [("igs-gps", 24), ("igs-galileo", 24)]);
    assert_eq!(found.notes.len(), 1, "{:?}", found.notes);
    assert!(
        found.notes[0].contains("48 satellites are interpolated"),
        "{:?}",
        found.notes
    );
    for (system, preset) in found.systems.iter().zip([Preset::Gps, Preset::Galileo]) {
        let expected = Ephemeris::of_gnss(preset.satellites(study.epoch()), study);
        let found = Ephemeris::of_gnss(system.satellites(study.epoch()), study);
        for (one, other) in found.satellites().iter().zip(expected.satellites()) {
            for t in study.iter() {
                let apart = found.state(one, t).unwrap().position_km
                    - expected.state(other, t).unwrap().position_km;
                // Millimetres in the file, and eleven nodes at 900 s, one-sided at the ends: below a metre.
                assert!(apart.norm() < 1e-3, "{} at {t}: {}", one.name, apart.norm());
            }
        }
    }
    let beyond = systems(&files[..1], study).err().unwrap().to_string();
    assert!(beyond.contains("has no state at"), "{beyond}");
}

/// Two files of one system each keep their names, whatever the letters of their satellites.
#[test]
fn files_of_other_satellites_stay_apart() {
    let study = grid(2.0 * 3_600.0, 900.0);
    let (gps, galileo) = (
        sp3(&[('G', Preset::Gps)], 0, 3),
        sp3(&[('E', Preset::Galileo)], 0, 3),
    );
    let files = [
        ("mine.sp3", gps.as_bytes()),
        ("theirs.sp3", galileo.as_bytes()),
    ];
    let found = systems(&files, study).unwrap();
    assert_eq!(names(&found), [("mine", 24), ("theirs", 24)]);
}

/// One system is named by its file; catalogue names split a file of several.
#[test]
fn element_sets_are_split_by_their_names() {
    let set = |name: &str, number: u32| {
        format!(
            "{name}\n1 {number:05}U 25900A   25001.00000000  .00000000  00000-0  00000-0 0    0\n2 {number:05}  55.0000  10.0000 0001000  20.0000  30.0000  2.00000000    0\n"
        )
    };
    let checked = |text: String| -> String {
        let sum = |line: &str| {
            line.bytes()
                .map(|b| match b {
                    b'0'..=b'9' => u32::from(b - b'0'),
                    b'-' => 1,
                    _ => 0,
                })
                .sum::<u32>()
                % 10
        };
        let line = |line: &str| match line.starts_with("1 ") || line.starts_with("2 ") {
            true => format!("{line}{}\n", sum(line)),
            false => format!("{line}\n"),
        };
        text.lines().map(line).collect()
    };
    let one = checked(set("GPS BIIR-2  (PRN 13)", 24_876) + &set("NAVSTAR 43", 24_877));
    let found = systems(&[("a/real.tle", one.as_bytes())], grid(600.0, 60.0)).unwrap();
    assert_eq!(names(&found), [("real", 2)]);
    let many = checked(
        set("GPS BIIR-2  (PRN 13)", 24_876)
            + &set("GSAT0101 (GALILEO-PFM)", 37_846)
            + &set("GSAT0102", 37_847)
            + &set("COSMOS 2456 (730)", 36_111)
            + &set("BEIDOU-3 M1 (C19)", 43_001)
            + &set("LAGEOS 1", 8_820),
    );
    let found = systems(&[("gnss.txt", many.as_bytes())], grid(600.0, 60.0)).unwrap();
    let expected = [
        ("gnss-gps", 1),
        ("gnss-galileo", 2),
        ("gnss-glonass", 1),
        ("gnss-beidou", 1),
        ("gnss-other", 1),
    ];
    assert_eq!(names(&found), expected);
}

/// An almanac is a system; unhealthy satellites are left out and reported.
#[test]
fn almanacs_are_systems() {
    let study = grid(86_400.0, 3_600.0);
    let at = Applicability::next_to(study.epoch());
    let mut bytes = Vec::new();
    let satellites = Preset::Gps.satellites(study.epoch());
    for (satellite, prn) in satellites.iter().zip(1..) {
        let mut almanac = Almanac::of(satellite, prn, study.epoch(), at).unwrap();
        almanac.health = if prn == 5 { 63 } else { 0 };
        almanac.write(&mut bytes).unwrap();
    }
    let found = systems(&[("gps.alm", &bytes)], study).unwrap();
    assert_eq!(names(&found), [("gps", 23)]);
    assert_eq!(
        found.notes,
        ["gps.alm: left out: 1 (unhealthy satellite: PRN-05)"]
    );
    let satellite = &found.systems[0].satellites(study.epoch())[0];
    for t in study.iter() {
        let ours = satellites[0].orbit.state_at(t).unwrap();
        let theirs = satellite.orbit.state_at(t).unwrap();
        // The shift of the radius, up to 2 km, and the digits.
        assert!((ours.position_km - theirs.position_km).norm() < 2.0, "{t}");
        assert!(
            (ours.velocity_km_s - theirs.velocity_km_s).norm() < 1e-3,
            "{t}"
        );
    }
}
