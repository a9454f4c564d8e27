//! Satellites out of service are as if they were not there.

use super::*;
use crate::constellation::gnss::System;
use crate::ephemeris::EphemerisSatellite;

fn study() -> Setup {
    let base = setup([3.0, 54.0], Surface::Wgs84);
    let site = |latitude, weight| Site::new(Surface::Wgs84, latitude, 100.0, weight).unwrap();
    Setup {
        sites: vec![site(-40.0, 1.0), site(5.0, 3.0), site(30.0, 2.0)],
        grid: TimeGrid::new(base.grid.epoch(), 7200.0, 240.0).unwrap(),
        gnss: vec![Preset::Gps.into(), Preset::Beidou3.into()],
        ..base
    }
}

fn outage(satellite: &str, interval_s: Option<std::ops::Range<f64>>) -> SatelliteOutage {
    SatelliteOutage {
        satellite: satellite.to_owned(),
        origin: "test".to_owned(),
        interval_s,
    }
}

const DESIGN: &str = "delta:53:60/6/1@1000+star:87:30/5/1@1100";

fn leo(setup: &Setup) -> Ephemeris {
    Ephemeris::of_design(&DESIGN.parse().unwrap(), setup.model, setup.grid).unwrap()
}

/// The LEO satellites and the GNSS listed without those that are down, one by one: the same to the bit on both paths.
#[test]
fn outages_equal_a_constellation_without_the_satellites() {
    let outages = vec![
        outage("NW-A-P02", None),
        outage("NW-B-P01-S04", None),
        outage("gps:A3", None),
        outage("GEO-1", None),
    ];
    let down = study().with_outages(outages).unwrap();
    let ours = down.in_service("it", leo(&down)).unwrap();
    let listed = |system: &System| {
        let mut satellites = system.satellites(down.grid.epoch());
        satellites.retain(|one| one.name != "A3" && one.name != "GEO-1");
        System::Listed {
            name: system.name().to_owned(),
            satellites,
        }
    };
    let without = Setup {
        gnss: study().gnss.iter().map(listed).collect(),
        ..study()
    };
    let mut satellites: Vec<EphemerisSatellite> = leo(&without).into_satellites();
    satellites.retain(|one| !one.name.starts_with("NW-A-P02") && one.name != "NW-B-P01-S04");
    assert_eq!(satellites.len(), 79);
    let theirs = Ephemeris::new(without.grid, satellites);
    for clocks in [Clocks::PerSystem, Clocks::Shared] {
        let [ours, theirs] = [(&down, &ours), (&without, &theirs)].map(|(setup, ephemeris)| {
            let evaluator = Evaluator::new(setup.clone().with_clocks(clocks)).unwrap();
            let plain = evaluator.evaluate_plain(ephemeris).unwrap();
            (evaluator.evaluate_ephemeris(ephemeris).unwrap(), plain)
        });
        assert_eq!(ours.1, theirs.1);
        // The lanes propagate a whole shell by angle addition.
        for (ours, theirs) in [
            (ours.0.mean_visible, theirs.0.mean_visible),
            (ours.0.mean_gnss_visible, theirs.0.mean_gnss_visible),
            (ours.0.mean_pdop.unwrap(), theirs.0.mean_pdop.unwrap()),
            (ours.0.max_pdop.unwrap(), theirs.0.max_pdop.unwrap()),
        ] {
            assert!((ours / theirs - 1.0).abs() < 1e-6, "{ours} {theirs}");
        }
    }
}

/// A satellite that is down at all instants but one is missed at these.
#[test]
fn an_interval_counts_while_it_lasts() {
    let of = |outages: Vec<SatelliteOutage>| {
        let setup = study().with_outages(outages).unwrap();
        let ephemeris = setup.in_service("it", leo(&setup)).unwrap();
        let evaluator = Evaluator::new(setup).unwrap();
        let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
        let fast = evaluator.evaluate_ephemeris(&ephemeris).unwrap();
        assert_eq!(plain.mean_total_visible, fast.mean_total_visible);
        evaluator.series(&ephemeris).unwrap().epochs
    };
    let whole = of(Vec::new());
    let interval = Some(1200.0..3600.0);
    let left = of(vec![
        outage("NW-A", interval.clone()),
        outage("GEO-1", interval),
    ]);
    for (left, whole) in left.iter().zip(&whole) {
        let is_down = (1200.0..3600.0).contains(&left.elapsed_s);
        assert_eq!(
            left.mean_visible < whole.mean_visible,
            is_down,
            "{}",
            left.elapsed_s
        );
        assert_eq!(left == whole, !is_down, "{}", left.elapsed_s);
    }
    assert!(
        left.iter()
            .zip(&whole)
            .any(|(left, whole)| left.mean_gnss_visible < whole.mean_gnss_visible)
    );
}

#[test]
fn a_name_of_two_systems_needs_the_system() {
    let setup = Setup {
        gnss: vec![Preset::Beidou3.into(), Preset::Navic.into()],
        ..study()
    };
    let error = setup.clone().with_outages(vec![outage("GEO-1", None)]);
    let error = error.unwrap_err().to_string();
    assert_eq!(
        error,
        "test: 'GEO-1' is a satellite of beidou-3 and of navic; write beidou-3:GEO-1"
    );
    let one = setup
        .with_outages(vec![outage("navic:GEO-1", None)])
        .unwrap();
    let counts: Vec<usize> = one
        .gnss_in_service()
        .iter()
        .map(|(_, all)| all.len())
        .collect();
    assert_eq!(counts, [30, 6]);
}
