use super::*;
use crate::ephemeris::arc::Interpolation;
use crate::exchange::export::testing::{in_memory, subject};
use crate::exchange::export::{Choices, Product};
use crate::exchange::manifest::Manifest;
use crate::formats::text::finding::FindingList;
use crate::formats::trajectory::Trajectory;
use crate::frames::{Frame, from_teme};
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use nalgebra::Vector3;
use serde_json::Value;

fn exported(design: &str) -> (Manifest, Vec<u8>) {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let subject = subject(
        design.parse().unwrap(),
        TimeGrid::new(epoch, 7_200.0, 60.0).unwrap(),
    );
    let (manifest, mut files) = in_memory(&subject, &[Product::Czml], Choices::default());
    (manifest, files.remove("scene.czml").unwrap())
}

fn packets(bytes: &[u8]) -> Vec<Value> {
    serde_json::from_slice(bytes).unwrap()
}

/// Between the samples the satellites are within a metre of the model, to both ends of the span,
/// on a circle and on an ellipse; a wrong order of coordinates or unit is thousands of kilometres.
#[test]
fn positions_are_within_a_metre_everywhere() {
    for design in ["delta:55:6/3/1@925", "lattice:63.4:4/2/1@9000,e=0.5,w=270"] {
        let (manifest, bytes) = exported(design);
        let error_km = manifest.files[0].loss.interpolation_max_km.unwrap();
        assert!(error_km > 0.0 && error_km <= TARGET_KM, "{error_km}");
        let tracks = read(bytes.as_slice()).unwrap();
        let design: crate::constellation::Design = design.parse().unwrap();
        assert_eq!(tracks.len(), design.satellite_count());
        for (track, satellite) in tracks.iter().zip(design.satellites()) {
            assert_eq!(track.name, format!("NW-{}", satellite.slot));
            let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
            let orbit = Model::J2.propagator(&satellite.elements, epoch).unwrap();
            for t in (0..=7_200).step_by(97).map(f64::from).chain([7_200.0]) {
                let teme = orbit.state_at(t).unwrap();
                let ours = from_teme(teme, Frame::EarthFixed, epoch, t);
                let (shown, _) = track.arcs[0].state(epoch.plus_seconds(t)).unwrap();
                assert!((shown.position_km - ours.position_km).norm() < 2.0 * TARGET_KM);
                // A metre over the half spacing of 150 s and more.
                assert!((shown.velocity_km_s - ours.velocity_km_s).norm() < 1e-4);
            }
        }
    }
}

/// Few samples: a day is a few hundred at most, so that a thousand satellites stay light.
#[test]
fn samples_are_few() {
    let (_, bytes) = exported("delta:55:6/3/1@925");
    for track in read(bytes.as_slice()).unwrap() {
        let nodes = &track.arcs[0].nodes;
        let step_s = nodes[1].0.seconds_since(nodes[0].0);
        assert!(step_s >= 300.0, "{step_s}");
    }
}

#[test]
fn the_document_holds_the_scenario() {
    let (manifest, bytes) = exported("delta:55:6/3/1@925");
    let packets = packets(&bytes);
    assert_eq!(packets[0]["id"], "document");
    assert_eq!(
        packets[0]["clock"]["interval"],
        "2025-01-01T00:00:00Z/2025-01-01T02:00:00Z"
    );
    let count = |test: &dyn Fn(&Value) -> bool| packets.iter().filter(|p| test(p)).count();
    assert_eq!(count(&|p| p["parent"] == "constellation"), 6);
    assert_eq!(count(&|p| p["parent"] == "gnss:beidou-3"), 30);
    assert_eq!(count(&|p| p["path"].is_object()), 3);
    assert_eq!(count(&|p| p["rectangle"].is_object()), 9);
    assert!(count(&|p| p["label"].is_object()) > 1);
    let mut ids: Vec<&str> = packets.iter().filter_map(|p| p["id"].as_str()).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), packets.len());
    // The middle column of the region is on the antimeridian.
    let across = |p: &Value| {
        let edges = &p["rectangle"]["coordinates"]["wsenDegrees"];
        edges[0] == 175.0 && edges[2] == -175.0
    };
    assert_eq!(count(&across), 3);
    assert!(
        manifest.files[0]
            .assumptions
            .iter()
            .any(|told| told.contains("mask"))
    );
}

#[test]
fn what_breaks_the_format_is_named() {
    let document = r#"{"id": "document", "version": "1.0"}"#;
    let packet = |position: &str| format!(r#"[{document}, {{"id": "a", "position": {position}}}]"#);
    let samples = r#""epoch": "2025-01-01T00:00:00Z", "cartesian": "#;
    for (text, rule) in [
        ("[]".to_owned(), "czml-document"),
        (r#"[{"id": "a"}]"#.to_owned(), "czml-document"),
        (r#"[{"id": "document"}]"#.to_owned(), "czml-version"),
        (
            packet(&format!("{{{samples} [0, 1, 2, 3, 60, 1, 2]}}")),
            "czml-samples",
        ),
        (
            packet(&format!("{{{samples} [60, 7e6, 2, 3, 0, 7e6, 2, 3]}}")),
            "czml-samples",
        ),
        (
            packet(&format!("{{{samples} [0, 1, 2, \"x\", 60, 1, 2, 3]}}")),
            "czml-samples",
        ),
        (
            packet(r#"{"cartesian": [0, 7e6, 2, 3, 60, 7e6, 2, 3]}"#),
            "czml-epoch",
        ),
        (
            packet(&format!(
                "{{{samples} [0, 1, 2, 3, 60, 1, 2, 3], \"referenceFrame\": \"#x\"}}"
            )),
            "czml-frame",
        ),
        (
            packet(&format!(
                "{{{samples} [0, 7e6, 2, 3, 60, 7e6, 2, 3], \"interpolationAlgorithm\": \"SPLINE\"}}"
            )),
            "czml-interpolation",
        ),
        (
            packet(&format!("{{{samples} [0, 7e3, 2, 3, 60, 7e3, 2, 3]}}")),
            "implausible-state",
        ),
        (
            packet(r#"{"interval": "2025-01-01T00:00:00Z", "cartesian": [7e6, 0, 0]}"#),
            "czml-interval",
        ),
        (packet(r#"{"reference": "b#position"}"#), "czml-reference"),
        (packet(r#"{"reference": "a#position"}"#), "czml-reference"),
        (packet(r#"{"cartesianVelocity": "x"}"#), "json-syntax"),
        (packet(r#"{"somewhere": [1, 2, 3]}"#), "czml-position"),
        (packet(r#"{"delete": true}"#), "czml-delete"),
    ] {
        match read(text.as_bytes()) {
            Err(crate::formats::ReadError::Rule(finding)) => {
                assert_eq!(finding.rule, rule, "{text}")
            }
            other => panic!("{text}: {other:?}"),
        }
    }
    let still = packet(r#"{"cartesian": [1, 2, 3]}"#);
    assert_eq!(read(still.as_bytes()).unwrap(), []);
    let mut findings = FindingList::of_reader();
    parse(still.as_bytes(), &mut findings).unwrap();
    assert_eq!(
        findings.left_out().to_string(),
        "left out: 1 (place that does not move: a)"
    );
}

fn document(packets: &str) -> Vec<Trajectory> {
    let text = format!(r#"[{{"id": "document", "version": "1.0"}}, {packets}]"#);
    read(text.as_bytes()).unwrap()
}

/// Position of the first satellite at a time of day, m.
fn metres(trajectories: &[Trajectory], time: &str) -> Option<[f64; 3]> {
    let at = Epoch::from_utc(format!("2025-01-01T{time}Z").parse().unwrap());
    let (state, _) = trajectories[0].arc_at(at)?.state(at)?;
    Some((state.position_km.km() * 1000.0).into())
}

/// Times as seconds, as texts and with an offset; several intervals and packets; each sample once.
#[test]
fn positions_are_read_however_they_are_written() {
    let plain = document(
        r#"{"id": "a", "position": {"epoch": "2025-01-01T00:00:00Z", "cartesian": [0, 7e6, 0, 0, 60, 7e6, 6e5, 0, 120, 7e6, 12e5, 0]}}"#,
    );
    let half = Some([7e6, 3e5, 0.0]);
    assert_eq!(metres(&plain, "00:00:30"), half);
    for packets in [
        r#"{"id": "a", "position": {"cartesian": ["2025-01-01T00:00:00Z", 7e6, 0, 0, "2025-01-01T01:01:00+01:00", 7e6, 6e5, 0, "2024-12-31T18:02:00-0600", 7e6, 12e5, 0]}}"#,
        r#"{"id": "a", "position": {"epoch": "2025-01-01T02:00:00+02:00", "cartesian": [0, 7e6, 0, 0, 60, 7e6, 6e5, 0, 120, 7e6, 12e5, 0]}}"#,
        r#"{"id": "a", "position": {"epoch": "2025-01-01T00:01:00Z", "cartesian": [0, 7e6, 6e5, 0, 60, 7e6, 12e5, 0]}},
           {"id": "a", "position": {"epoch": "2025-01-01T00:00:00Z", "cartesian": [0, 7e6, 0, 0]}}"#,
        // A repeated instant: the later sample is used, as in CesiumJS.
        r#"{"id": "a", "position": {"epoch": "2025-01-01T00:00:00Z", "cartesian": [0, 7e6, 0, 0, 60, 9e6, 9e6, 0, 60, 7e6, 6e5, 0, 120, 7e6, 12e5, 0]}}"#,
        r#"{"id": "a", "position": [{"epoch": "2025-01-01T00:00:00Z", "cartesian": [0, 7e6, 0, 0, 60, 7e6, 6e5, 0, 120, 7e6, 12e5, 0]}]}"#,
    ] {
        let found = document(packets);
        assert_eq!(found.len(), 1, "{packets}");
        assert_eq!(found[0].samples(), plain[0].samples(), "{packets}");
    }
    let two = document(
        r#"{"id": "a", "position": [
            {"interval": "2025-01-01T00:00:00Z/2025-01-01T00:01:00Z", "epoch": "2025-01-01T00:00:00Z", "cartesian": [0, 7e6, 0, 0, 120, 7e6, 12e5, 0]},
            {"interval": "2025-01-01T00:02:00Z/2025-01-01T00:03:00Z", "epoch": "2025-01-01T00:00:00Z", "cartesian": [120, 8e6, 0, 0, 180, 8e6, 6e5, 0]}]}"#,
    );
    assert_eq!(two[0].arcs.len(), 2);
    assert_eq!(metres(&two, "00:00:30"), half);
    // Between the intervals it is nowhere, although the samples of the first reach further.
    assert_eq!(metres(&two, "00:01:30"), None);
    assert_eq!(metres(&two, "00:02:30"), Some([8e6, 3e5, 0.0]));
    let available = document(
        r#"{"id": "a", "availability": "2025-01-01T00:00:40Z/9999-12-31T24:00:00Z", "position": {"epoch": "2025-01-01T00:00:00Z", "cartesian": [0, 7e6, 0, 0, 60, 7e6, 6e5, 0]}}"#,
    );
    assert_eq!(metres(&available, "00:00:30"), None);
    assert_eq!(metres(&available, "00:00:45"), Some([7e6, 4.5e5, 0.0]));
}

#[test]
fn every_form_of_position_is_read() {
    let of = |position: &str| {
        document(&format!(
            r#"{{"id": "a", "position": {{"epoch": "2025-01-01T00:00:00Z", {position}}}}}"#
        ))
    };
    let hermite = of(
        r#""interpolationAlgorithm": "HERMITE", "interpolationDegree": 3, "cartesianVelocity": [0, 7e6, 0, 0, 0, 7500, 0, 60, 7e6, 45e4, 0, 0, 7500, 0]"#,
    );
    assert_eq!(hermite[0].arcs[0].interpolation, Interpolation::Hermite(3));
    let [x, y, _] = metres(&hermite, "00:00:30").unwrap();
    assert!(
        (x - 7e6).abs() < 1e-6 && (y - 225e3).abs() < 1e-6,
        "{x} {y}"
    );
    // Without velocities CesiumJS takes the polynomial through the positions.
    let plain = of(
        r#""interpolationAlgorithm": "HERMITE", "interpolationDegree": 3, "cartesian": [0, 7e6, 0, 0, 60, 7e6, 0, 0]"#,
    );
    assert_eq!(plain[0].arcs[0].interpolation, Interpolation::Lagrange(3));
    // 90° E over the equator at 621 863 m is 7 000 000 m along y; the pole at 643 247.686 m is as far along z
    // (semi-axes 6 378 137 and 6 356 752.314 m).
    for position in [
        r#""cartographicDegrees": [0, 90, 0, 621863, 60, 0, 90, 643247.6858]"#,
        r#""cartographicRadians": [0, 1.5707963267948966, 0, 621863, 60, 0, 1.5707963267948966, 643247.6858]"#,
    ] {
        let found = of(position);
        for (time, expected) in [("00:00:00", [0.0, 7e6, 0.0]), ("00:01:00", [0.0, 0.0, 7e6])] {
            let apart = Vector3::from(metres(&found, time).unwrap()) - Vector3::from(expected);
            assert!(apart.norm() < 1e-3, "{position}: {apart}");
        }
        assert_eq!(found[0].arcs[0].frame, Frame::EarthFixed);
    }
    let shared = document(
        r#"{"id": "b", "position": {"reference": "a#position"}},
           {"id": "a", "position": {"epoch": "2025-01-01T00:00:00Z", "cartesian": [0, 7e6, 0, 0, 60, 7e6, 6e5, 0]}}"#,
    );
    assert_eq!((shared.len(), shared[0].name.as_str()), (2, "b"));
    assert_eq!(shared[0].arcs, shared[1].arcs);
}

/// A packet of 5 MB, as of some months of one satellite, is read.
#[test]
fn long_packets_are_read() {
    let sample = |k: usize| format!("{},7000000.123456,{k}.5,0", 10 * k);
    let samples: Vec<String> = (0..180_000).map(sample).collect();
    let cartesian = samples.join(",");
    assert!(cartesian.len() > 5_000_000);
    let found = document(&format!(
        r#"{{"id": "a", "position": {{"epoch": "2025-01-01T00:00:00Z", "cartesian": [{cartesian}]}}}}"#
    ));
    assert_eq!(found[0].arcs[0].nodes.len(), 180_000);
}
