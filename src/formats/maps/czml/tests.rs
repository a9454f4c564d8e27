use super::*;
use crate::exchange::export::testing::{in_memory, subject};
use crate::exchange::export::{Choices, Product};
use crate::exchange::manifest::Manifest;
use crate::frames::{Frame, from_teme};
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
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

/// A polynomial of the seventh degree comes back, with its derivative.
#[test]
fn eight_nodes_hold_a_polynomial_of_degree_seven() {
    let f = |t: f64| Vector3::new(t.powi(7) - 3.0 * t, 1.0, t * t);
    let nodes: Vec<_> = (-3..=4).map(|k| (f64::from(k), f(f64::from(k)))).collect();
    let (value, slope) = lagrange(&nodes, 0.5);
    assert!((value - f(0.5)).norm() < 1e-11);
    let exact = Vector3::new(7.0 * 0.5_f64.powi(6) - 3.0, 0.0, 1.0);
    assert!((slope - exact).norm() < 1e-11);
    // On a node the product form divides by nothing that vanishes.
    assert!((lagrange(&nodes, 2.0).0 - f(2.0)).norm() < 1e-11);
}

/// CesiumJS takes nodes from both sides, as far as there are any.
#[test]
fn windows_lie_around_the_instant() {
    let nodes: Vec<_> = (0..20).map(|k| (f64::from(k), Vector3::zeros())).collect();
    let ends = |t: f64| {
        let window = window(&nodes, t, 7);
        (window[0].0, window[window.len() - 1].0)
    };
    assert_eq!(ends(9.5), (6.0, 13.0));
    assert_eq!(ends(0.2), (0.0, 7.0));
    assert_eq!(ends(18.7), (12.0, 19.0));
    assert_eq!(super::window(&nodes[..3], 1.0, 7).len(), 3);
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
            let orbit = Model::J2
                .propagator(&satellite.elements, track.epoch)
                .unwrap();
            for t in (0..=7_200).step_by(97).map(f64::from).chain([7_200.0]) {
                let teme = orbit.state_at(t).unwrap();
                let ours = from_teme(teme, Frame::EarthFixed, track.epoch, t);
                let shown = track.state(t).unwrap();
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
        let step_s = track.nodes[1].0 - track.nodes[0].0;
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
            packet(&format!("{{{samples} [0, 1, 2, 3, 0, 1, 2, 3]}}")),
            "czml-samples",
        ),
        (
            packet(&format!("{{{samples} [0, 1, 2, \"x\", 60, 1, 2, 3]}}")),
            "czml-samples",
        ),
        (
            packet(r#"{"cartesian": [0, 1, 2, 3, 60, 1, 2, 3]}"#),
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
                "{{{samples} [0, 1, 2, 3, 60, 1, 2, 3], \"interpolationAlgorithm\": \"HERMITE\"}}"
            )),
            "czml-interpolation",
        ),
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
}
