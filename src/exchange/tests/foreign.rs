//! Files as other programs and agencies write them, in the layout of their documents and with
//! numbers of our own.

use crate::exchange::import::Fleet;
use crate::exchange::lint::{Format, lint};
use crate::formats::trajectory::Trajectory;
use crate::frames::Frame;
use crate::time::Epoch;
use nalgebra::Vector3;

/// The satellites of a text in the detected format; no error, and these warnings.
fn read(text: &str, format: Format, warnings: &[&str]) -> Fleet {
    let report = lint(text.as_bytes(), None, None, 100).unwrap();
    assert_eq!(report.format, Some(format));
    let mut rules: Vec<_> = report.findings.iter().map(|finding| finding.rule).collect();
    rules.dedup();
    assert_eq!(rules, warnings, "{:?}", report.findings);
    let name = "dir/SAT-7.e";
    let read = Fleet::read(text.as_bytes(), Some(format), Some(name));
    read.unwrap().fleet
}

fn sets(fleet: Fleet) -> Vec<sgp4::Elements> {
    match fleet {
        Fleet::Sets(sets) => sets,
        other => panic!("{}", other.content()),
    }
}

fn sampled(fleet: Fleet) -> Vec<Trajectory> {
    match fleet {
        Fleet::Sampled(trajectories) => trajectories,
        other => panic!("{}", other.content()),
    }
}

fn utc(text: &str) -> Epoch {
    Epoch::from_utc(text.parse().unwrap())
}

fn assert_iss(sets: &[sgp4::Elements], name: Option<&str>) {
    let [set] = sets else { panic!("{sets:?}") };
    assert_eq!(set.object_name.as_deref(), name);
    assert_eq!(set.norad_id, 25_544);
    assert_eq!(set.international_designator.as_deref(), Some("1998-067A"));
    assert_eq!(set.inclination, 51.6416);
    assert_eq!(set.eccentricity, 0.000_670_3);
    assert_eq!(set.drag_term, -0.11606e-4);
    assert_eq!(set.datetime.to_string(), "2008-09-20 12:25:40.104192");
}

const LINES: &str = "\
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
";

/// Two lines alone, a padded name as `CelesTrak` has it, `0 ` before it as Space-Track has it.
#[test]
fn validate_element_sets_of_catalogues() {
    assert_iss(&sets(read(LINES, Format::Tle, &[])), None);
    for name in [
        "ISS (ZARYA)\n",
        "ISS (ZARYA)             \r\n",
        "0 ISS (ZARYA)\n",
    ] {
        assert_iss(
            &sets(read(&format!("{name}{LINES}"), Format::Tle, &[])),
            Some("ISS (ZARYA)"),
        );
    }
    let twice = format!("\n{LINES}\n{}", LINES.replace('\n', "   \r\n"));
    assert_eq!(sets(read(&twice, Format::Tle, &["tle-repeated"])).len(), 2);
}

/// `CelesTrak`: bare numbers and no header; Space-Track: strings, nulls and members of its own.
#[test]
fn validate_mean_elements_of_catalogues() {
    let celestrak = r#"[{"OBJECT_NAME":"ISS (ZARYA)","OBJECT_ID":"1998-067A","EPOCH":"2008-09-20T12:25:40.104192","MEAN_MOTION":15.72125391,"ECCENTRICITY":0.0006703,"INCLINATION":51.6416,"RA_OF_ASC_NODE":247.4627,"ARG_OF_PERICENTER":130.536,"MEAN_ANOMALY":325.0288,"EPHEMERIS_TYPE":0,"CLASSIFICATION_TYPE":"U","NORAD_CAT_ID":25544,"ELEMENT_SET_NO":292,"REV_AT_EPOCH":56353,"BSTAR":-1.1606e-5,"MEAN_MOTION_DOT":-2.182e-5,"MEAN_MOTION_DDOT":0}]"#;
    assert_iss(
        &sets(read(celestrak, Format::OmmJson, &[])),
        Some("ISS (ZARYA)"),
    );
    let space_track = r#"[
  {
    "CCSDS_OMM_VERS": "3.0", "COMMENT": "GENERATED VIA SPACE-TRACK.ORG API",
    "CREATION_DATE": "2008-09-20T20:36:18", "ORIGINATOR": "18 SPCS",
    "OBJECT_NAME": "ISS (ZARYA)", "OBJECT_ID": "1998-067A", "CENTER_NAME": "EARTH",
    "REF_FRAME": "TEME", "TIME_SYSTEM": "UTC", "MEAN_ELEMENT_THEORY": "SGP4",
    "EPOCH": "2008-09-20T12:25:40.104192", "MEAN_MOTION": "15.72125391",
    "ECCENTRICITY": "0.00067030", "INCLINATION": "51.6416", "RA_OF_ASC_NODE": "247.4627",
    "ARG_OF_PERICENTER": "130.5360", "MEAN_ANOMALY": "325.0288", "EPHEMERIS_TYPE": "0",
    "CLASSIFICATION_TYPE": "U", "NORAD_CAT_ID": "25544", "ELEMENT_SET_NO": "292",
    "REV_AT_EPOCH": "56353", "BSTAR": "-0.00001160600000", "MEAN_MOTION_DOT": "-0.00002182",
    "MEAN_MOTION_DDOT": "0.0000000000000", "SEMIMAJOR_AXIS": "6730.960", "DECAY_DATE": null,
    "TLE_LINE0": "0 ISS (ZARYA)"
  }
]"#;
    assert_iss(
        &sets(read(space_track, Format::OmmJson, &[])),
        Some("ISS (ZARYA)"),
    );
    let table = "OBJECT_NAME,OBJECT_ID,EPOCH,MEAN_MOTION,ECCENTRICITY,INCLINATION,RA_OF_ASC_NODE,ARG_OF_PERICENTER,MEAN_ANOMALY,EPHEMERIS_TYPE,CLASSIFICATION_TYPE,NORAD_CAT_ID,ELEMENT_SET_NO,REV_AT_EPOCH,BSTAR,MEAN_MOTION_DOT,MEAN_MOTION_DDOT\r\nISS (ZARYA),1998-067A,2008-09-20T12:25:40.104192,15.72125391,.0006703,51.6416,247.4627,130.5360,325.0288,0,U,25544,292,56353,-.11606E-4,-.2182E-4,0\r\n";
    assert_iss(&sets(read(table, Format::OmmCsv, &[])), Some("ISS (ZARYA)"));
    let xml = r#"<?xml version="1.0" encoding="UTF-8"?>
<ndm xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="https://sanaregistry.org/r/ndmxml_unqualified/ndmxml-2.0.0-master-2.0.xsd">
<omm id="CCSDS_OMM_VERS" version="2.0"><header><CREATION_DATE/><ORIGINATOR/></header><body><segment>
<metadata><OBJECT_NAME>ISS (ZARYA)</OBJECT_NAME><OBJECT_ID>1998-067A</OBJECT_ID><CENTER_NAME>EARTH</CENTER_NAME><REF_FRAME>TEME</REF_FRAME><TIME_SYSTEM>UTC</TIME_SYSTEM><MEAN_ELEMENT_THEORY>SGP4</MEAN_ELEMENT_THEORY></metadata>
<data><meanElements><EPOCH>2008-09-20T12:25:40.104192</EPOCH><MEAN_MOTION>15.72125391</MEAN_MOTION><ECCENTRICITY>.0006703</ECCENTRICITY><INCLINATION>51.6416</INCLINATION><RA_OF_ASC_NODE>247.4627</RA_OF_ASC_NODE><ARG_OF_PERICENTER>130.5360</ARG_OF_PERICENTER><MEAN_ANOMALY>325.0288</MEAN_ANOMALY></meanElements>
<tleParameters><EPHEMERIS_TYPE>0</EPHEMERIS_TYPE><CLASSIFICATION_TYPE>U</CLASSIFICATION_TYPE><NORAD_CAT_ID>25544</NORAD_CAT_ID><ELEMENT_SET_NO>292</ELEMENT_SET_NO><REV_AT_EPOCH>56353</REV_AT_EPOCH><BSTAR>-.11606E-4</BSTAR><MEAN_MOTION_DOT>-.2182E-4</MEAN_MOTION_DOT><MEAN_MOTION_DDOT>0</MEAN_MOTION_DDOT></tleParameters></data>
</segment></body></omm></ndm>"#;
    assert_iss(
        &sets(read(xml, Format::OmmXml, &["ccsds-empty", "ccsds-point"])),
        Some("ISS (ZARYA)"),
    );
}

/// SP3-d of an analysis centre: 2010 time systems, accuracies, flags and correlations, gaps.
fn igs(system: &str) -> String {
    let ids = |first: &str, rest: &str| format!("+    3   {first}{rest}\n");
    let mut text = String::from("#dP2025  1  1  0  0  0.00000000       2 ORBIT IGS20 HLM  IGS\n");
    text += "## 2347 259200.00000000   300.00000000 60676 0.0000000000000\n";
    text += &ids("G01E11C19", &"  0".repeat(14));
    for _ in 0..8 {
        text += &format!("+        {}\n", "  0".repeat(17));
    }
    for _ in 0..9 {
        text += &format!("++       {}\n", "  5".repeat(17));
    }
    text += &format!("%c M  cc {system} ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n");
    text += "%c cc cc ccc ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n";
    text += "%f  1.2500000  1.025000000  0.00000000000  0.000000000000000\n";
    text += "%f  0.0000000  0.000000000  0.00000000000  0.000000000000000\n";
    text += &"%i    0    0    0    0      0      0      0      0         0\n".repeat(2);
    text += &"/* FINAL ORBIT COMBINATION OF SEVERAL CENTRES, WITH COMMENTS UP TO EIGHTY COLUMNS\n"
        .repeat(6);
    for minute in [0, 5] {
        text += &format!("*  2025  1  1  0 {minute:>2}  0.00000000\n");
        text += "PG01  10138.887000  -7221.350000  23465.100000     86.923774  7  8  6 109 EP  M\n";
        text +=
            "EP    55   55   55     222  1234567 -1234567  5999999      -30       21 -1230000\n";
        text += "PE11 -29600.300000   1000.000000    -12.500000 999999.999999\n";
        text += "PC19      0.000000      0.000000      0.000000 999999.999999            M  P\n";
    }
    text + "EOF\n"
}

#[test]
fn validate_orbits_of_an_analysis_centre() {
    // Seconds of each system ahead of UTC in 2025 (SP3-d, table 1; BDS-SIS-ICD for BeiDou).
    for (system, ahead_s) in [
        ("GPS", 18.0),
        ("GAL", 18.0),
        ("QZS", 18.0),
        ("IRN", 18.0),
        ("BDT", 4.0),
        ("TAI", 37.0),
        ("UTC", 0.0),
        ("GLO", 0.0),
    ] {
        let satellites = sampled(read(&igs(system), Format::Sp3, &[]));
        // C19 has no position at all.
        let names: Vec<_> = satellites.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["G01", "E11"]);
        assert_eq!(satellites[0].arcs[0].frame, Frame::EarthFixed);
        let (at, _, state) = satellites[0].samples()[1];
        let late_s = utc("2025-01-01T00:05:00Z").seconds_since(at);
        assert!((late_s - ahead_s).abs() < 1e-9, "{system}: {late_s}");
        assert_eq!(
            state.position_km.km(),
            Vector3::new(10_138.887, -7_221.35, 23_465.1)
        );
    }
    read(&igs("ccc"), Format::Sp3, &["sp3-time-system"]);
    let version_c = igs("GPS")
        .replacen("#dP", "#cP", 1)
        .replace("IGS20", "ITR14");
    assert_eq!(sampled(read(&version_c, Format::Sp3, &[])).len(), 2);
}

/// Velocities, their accuracies, and a satellite whose missing position has a velocity of zeros.
#[test]
fn velocities_of_missing_positions_are_passed_over() {
    let velocities = "EP    55   55   55     222\nVG01  20298.880364 -18462.044804   1381.387685     -4.534317 14 14 14 191\nEV    22   22   22     111  1234567  1234567  1234567  1234567  1234567  1234567\n";
    let text = igs("GPS")
        .replacen("#dP", "#dV", 1)
        .replace("EP    55   55   55     222  1234567 -1234567  5999999      -30       21 -1230000\n", velocities)
        .replace("PC19      0.000000      0.000000      0.000000 999999.999999            M  P\n", "PC19      0.000000      0.000000      0.000000 999999.999999\nVC19      0.000000      0.000000      0.000000 999999.999999\n");
    let satellites = sampled(read(&text, Format::Sp3, &[]));
    assert_eq!(satellites.len(), 2);
    let velocity = satellites[0].samples()[0].2.velocity_km_s;
    // Decimetres per second.
    assert!(
        (velocity - Vector3::new(2.029_888_036_4, -1.846_204_480_4, 0.138_138_768_5)).norm()
            < 1e-15
    );
}

/// In the layout of GMAT's writer: version 1.0, blanks before the equals signs, Lagrange.
const GMAT: &str = "\
CCSDS_OEM_VERS = 1.0
CREATION_DATE  = 2026-01-05T08:15:30
ORIGINATOR     = GMAT USER

META_START
OBJECT_NAME          = LeoSat
OBJECT_ID            = LeoSatId
CENTER_NAME          = Earth
REF_FRAME            = EME2000
TIME_SYSTEM          = UTC
START_TIME           = 2026-01-01T11:59:28.000
USEABLE_START_TIME   = 2026-01-01T11:59:28.000
USEABLE_STOP_TIME    = 2026-01-01T12:01:28.000
STOP_TIME            = 2026-01-01T12:01:28.000
INTERPOLATION        = Lagrange
INTERPOLATION_DEGREE = 2
META_STOP

COMMENT  This block begins after propagation.
2026-01-01T11:59:28.000  7.100000000000000e+003  0.000000000000000e+000  1.300000000000000e+003  0.000000000000000e+000  7.350000000000000e+000  1.000000000000000e+000
2026-01-01T12:00:28.000  7.086000000000000e+003  4.410000000000000e+002  1.357000000000000e+003 -4.700000000000000e-001  7.340000000000000e+000  9.200000000000000e-001
2026-01-01T12:01:28.000  7.044000000000000e+003  8.790000000000000e+002  1.410000000000000e+003 -9.300000000000000e-001  7.310000000000000e+000  8.400000000000000e-001
";

#[test]
fn validate_an_ephemeris_message_of_gmat() {
    let satellites = sampled(read(GMAT, Format::Oem, &[]));
    assert_eq!((satellites.len(), satellites[0].samples().len()), (1, 3));
    assert_eq!(satellites[0].arcs[0].frame, Frame::Eme2000);
    assert_eq!(satellites[0].samples()[1].0, utc("2026-01-01T12:00:28Z"));
    assert_eq!(satellites[0].samples()[1].2.position_km.km().z, 1357.0);
}

/// In the layout of Orekit's writer: version 3.0, days of the year, microseconds, blanks for
/// alignment; two segments that share an instant, and covariances.
const OREKIT: &str = "\
CCSDS_OEM_VERS = 3.0
COMMENT written for a test
CREATION_DATE = 2026-005T08:15:30.123456789
ORIGINATOR = CS GROUP
MESSAGE_ID = 1

META_START
COMMENT first arc
OBJECT_NAME          = LEOSAT
OBJECT_ID            = 2026-001A
CENTER_NAME          = EARTH
REF_FRAME            = ITRF-2014
TIME_SYSTEM          = TAI
START_TIME           = 2026-001T00:00:37.000000
STOP_TIME            = 2026-001T00:01:37.000000
INTERPOLATION        = HERMITE
INTERPOLATION_DEGREE = 3
META_STOP

2026-001T00:00:37.000000      7100.000000         0.000000      1300.000000     0.000000000     7.350000000     1.000000000
2026-001T00:01:37.000000      7086.000000       441.000000      1357.000000    -0.470000000     7.340000000     0.920000000

COVARIANCE_START
EPOCH = 2026-001T00:00:37.000000
COV_REF_FRAME = RTN
3.331349476038534e-04
4.618927349220216e-04 6.782421679971363e-04
-3.070007847730449e-04 -4.221234189514228e-04 3.231931992380369e-04
-3.349365033922630e-07 -4.686084221046758e-07 2.484949578400095e-07 4.296022805587290e-10
-2.211832501084875e-07 -2.864186892102733e-07 1.798098699846038e-07 2.608899201686016e-10 1.767514756338532e-10
-3.041346050686871e-07 -4.989496988610662e-07 3.540310904497689e-07 1.869263192954590e-10 1.008862586240695e-10 6.224444338635500e-10
COVARIANCE_STOP

META_START
COMMENT second arc
OBJECT_NAME          = LEOSAT
OBJECT_ID            = 2026-001A
CENTER_NAME          = EARTH
REF_FRAME            = ITRF-2014
TIME_SYSTEM          = TAI
START_TIME           = 2026-001T00:01:37.000000
STOP_TIME            = 2026-001T00:02:37.000000
META_STOP

2026-001T00:01:37.000000      7086.000001       441.000000      1357.000000    -0.480000000     7.340000000     0.920000000
2026-001T00:02:37.000000      7044.000000       879.000000      1410.000000    -0.930000000     7.310000000     0.840000000
";

#[test]
fn validate_an_ephemeris_message_of_orekit() {
    let satellites = sampled(read(OREKIT, Format::Oem, &[]));
    assert_eq!(satellites.len(), 1);
    let states = satellites[0].samples();
    assert_eq!(satellites[0].arcs[0].frame, Frame::EarthFixed);
    // The instant in both arcs is taken from the first.
    assert_eq!(states.len(), 3);
    assert_eq!(states[0].0, utc("2026-01-01T00:00:00Z"));
    assert_eq!(states[1].2.position_km.km().x, 7086.0);
    assert_eq!(states[2].0, utc("2026-01-01T00:02:00Z"));
}

/// In the layout of STK's message tool: indented, ICRF, accelerations, a comment among the lines.
#[test]
fn validate_an_ephemeris_message_of_stk() {
    let text = "CCSDS_OEM_VERS = 2.0\r\n\r\nCREATION_DATE = 2026-01-05T08:15:30.123\r\nORIGINATOR = STK\r\n\r\nMETA_START\r\n  OBJECT_NAME = LeoSat\r\n  OBJECT_ID = 2026-001-A\r\n  CENTER_NAME = Earth\r\n  REF_FRAME = ICRF\r\n  TIME_SYSTEM = UTC\r\n  START_TIME = 2026-01-01T00:00:00.000\r\n  STOP_TIME = 2026-01-01T00:01:00.000\r\n  INTERPOLATION = LAGRANGE\r\n  INTERPOLATION_DEGREE = 1\r\nMETA_STOP\r\n\r\n2026-01-01T00:00:00.000 7100.0 0.0 1300.0 0.0 7.35 1.0 -0.0077 0.0 -0.0014\r\nCOMMENT in between\r\n2026-01-01T00:01:00.000 7086.0 441.0 1357.0 -0.47 7.34 0.92 -0.0077 0.0 -0.0014\r\n";
    let satellites = sampled(read(text, Format::Oem, &["oem-comment"]));
    assert_eq!(satellites[0].arcs[0].frame, Frame::Gcrf);
    assert_eq!(satellites[0].samples().len(), 2);
}

/// In the layout of STK's own export: tabs, comments among the keywords, metres by default.
fn stk(system: &str, unit: &str, table: &str) -> String {
    format!(
        "stk.v.11.0\r\n\r\n# WrittenBy    STK_v11.7.1\r\n\r\nBEGIN Ephemeris\r\n\r\n    NumberOfEphemerisPoints\t\t 3\r\n\r\n    ScenarioEpoch\t\t 1 Jan 2026 00:00:00.000000\r\n\r\n# Epoch in JDate format: 2461041.50000000000000\r\n\r\n    InterpolationMethod\t\t Lagrange\r\n\r\n    InterpolationSamplesM1\t\t 5\r\n\r\n    CentralBody\t\t Earth\r\n\r\n    CoordinateSystem\t\t {system}\r\n{unit}\r\n# Time of first point:  1 Jan 2026 00:00:00.000 UTCG\r\n\r\n    {table}\r\n\r\nEND Ephemeris\r\n"
    )
}

#[test]
fn validate_ephemerides_of_stk() {
    let with_velocities = "EphemerisTimePosVel\t\t\r\n\r\n 0.00000000000000e+00  7.10e+06  0.0e+00  1.3e+06  0.00e+00  7.35e+03  1.00e+03\r\n 6.00000000000000e+01  7.086e+06  4.41e+05  1.357e+06 -4.7e+02  7.34e+03  9.2e+02\r\n 1.20000000000000e+02  7.044e+06  8.79e+05  1.41e+06 -9.3e+02  7.31e+03  8.4e+02";
    for (system, frame) in [
        ("J2000", Frame::Eme2000),
        ("ICRF", Frame::Gcrf),
        ("Inertial", Frame::Gcrf),
        ("Fixed", Frame::EarthFixed),
        ("TEMEOfDate", Frame::Teme),
    ] {
        let satellites = sampled(read(&stk(system, "", with_velocities), Format::Stk, &[]));
        assert_eq!(
            (satellites[0].name.as_str(), satellites[0].arcs[0].frame),
            ("SAT-7", frame)
        );
        let (at, _, state) = satellites[0].samples()[1];
        assert_eq!(at, utc("2026-01-01T00:01:00Z"));
        assert!((state.position_km.km() - Vector3::new(7086.0, 441.0, 1357.0)).norm() < 1e-12);
        assert!((state.velocity_km_s - Vector3::new(-0.47, 7.34, 0.92)).norm() < 1e-15);
    }
    // Positions alone: x = 7100 - t²/100 km has the velocity -t/50, y = 7 t, z is constant.
    let positions = "EphemerisTimePos\r\n 0 7100 0 1300\r\n 60 7064 420 1300\r\n 120 6956 840 1300";
    for unit in [
        "    DistanceUnit\t\t Kilometers\r\n",
        "DistanceUnit kilometers\r\n",
    ] {
        let satellites = sampled(read(&stk("J2000", unit, positions), Format::Stk, &[]));
        for (k, (_, _, state)) in satellites[0].samples().iter().enumerate() {
            let expected = Vector3::new(-1.2 * k as f64, 7.0, 0.0);
            assert!(
                (state.velocity_km_s - expected).norm() < 1e-12,
                "{k}: {}",
                state.velocity_km_s
            );
        }
    }
    let one = "EphemerisTimePos\r\n 0 7100 0 1300";
    let text =
        stk("J2000", "DistanceUnit Kilometers\r\n", one).replace("Points\t\t 3", "Points\t\t 1");
    let report = lint(text.as_bytes(), None, None, 10).unwrap();
    assert_eq!(report.findings[0].rule, "stk-velocity");
}
