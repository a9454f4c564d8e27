use super::*;
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::exchange::export::testing::{in_memory, subject};
use crate::exchange::export::{Choices, Product};
use crate::formats::text::timestamp::TimeSystem;
use crate::formats::trajectory::Trajectory;
use crate::frames::Position;
use crate::keyword::Keyword;
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use nalgebra::Vector3;
use std::collections::BTreeMap;

fn grid() -> TimeGrid {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    TimeGrid::new(epoch, 3_600.0, 60.0).unwrap()
}

fn design() -> Design {
    "delta:55:6/3/1@925".parse().unwrap()
}

fn exported(products: &[Product], choices: Choices) -> BTreeMap<String, Vec<u8>> {
    let subject = subject(design(), grid());
    let mut files = in_memory(&subject, products, choices).1;
    files.remove("manifest.json");
    files
}

fn fleet(files: &BTreeMap<String, Vec<u8>>) -> Fleet {
    let read = |(path, bytes): (&String, &Vec<u8>)| {
        Fleet::read(bytes.as_slice(), None, path.rsplit('/').next())
            .unwrap()
            .fleet
    };
    let mut fleets = files.iter().map(read);
    let mut first = fleets.next().unwrap();
    fleets.for_each(|next| first.append(next));
    first
}

/// Largest distance from the design, km.
fn apart_km(propagated: &Ephemeris) -> f64 {
    let truth = Ephemeris::of_design(&design(), Model::J2, grid()).unwrap();
    assert_eq!(propagated.satellites().len(), 6);
    let mut worst = 0.0_f64;
    for (a, b) in propagated.satellites().iter().zip(truth.satellites()) {
        for t in grid().iter() {
            let (a, b) = (propagated.state(a, t).unwrap(), truth.state(b, t).unwrap());
            worst = worst.max((a.position_km - b.position_km).norm());
            assert!((a.velocity_km_s - b.velocity_km_s).norm() < 0.02);
        }
    }
    worst
}

/// Every product can be propagated again: states to their digits, SGP4 to the J3 terms and the shift of the
/// radius that mean J2 lacks (under 20 km at 55° in an hour).
#[test]
fn every_product_propagates_where_the_design_does() {
    for frame in Frame::ALL {
        for time_system in [TimeSystem::Utc, TimeSystem::Gps] {
            let choices = Choices {
                frame: *frame,
                time_system,
                ..Choices::default()
            };
            for product in [Product::Oem, Product::Opm, Product::Stk] {
                let propagated = fleet(&exported(&[product], choices))
                    .propagate(grid(), Model::J2)
                    .unwrap();
                // Nine decimals, and rotations there and back in doubles.
                assert!(apart_km(&propagated) < 1e-8, "{frame} {product}");
            }
        }
    }
    for oem_combined in [false, true] {
        let choices = Choices {
            oem: oem::OemSyntax::Xml,
            oem_combined,
            ..Choices::default()
        };
        let propagated = fleet(&exported(&[Product::Oem], choices))
            .propagate(grid(), Model::J2)
            .unwrap();
        assert!(apart_km(&propagated) < 1e-8);
    }
    let sp3 = fleet(&exported(&[Product::Sp3], Choices::default()));
    // Six decimals of a kilometre in three components.
    assert!(apart_km(&sp3.propagate(grid(), Model::J2).unwrap()) < 1e-6);
    let czml = fleet(&exported(&[Product::Czml], Choices::default()));
    // The metre between samples, and decimetres.
    assert!(apart_km(&czml.propagate(grid(), Model::J2).unwrap()) < 2.2e-3);
    let mut tables = exported(&[Product::Csv], Choices::default());
    let states = tables.remove("states.csv").unwrap();
    assert!(apart_km(&fleet(&tables).propagate(grid(), Model::J2).unwrap()) < 1e-8);
    let states = Fleet::read(states.as_slice(), None, None).unwrap().fleet;
    assert!(apart_km(&states.propagate(grid(), Model::J2).unwrap()) < 1e-8);
    for notation in OmmSyntax::ALL {
        let choices = Choices {
            omm: *notation,
            ..Choices::default()
        };
        let sets = fleet(&exported(&[Product::Omm], choices))
            .propagate(grid(), Model::J2)
            .unwrap();
        assert!(apart_km(&sets) < 20.0, "{notation}");
    }
    let sets = fleet(&exported(&[Product::Tle], Choices::default()));
    assert!(apart_km(&sets.propagate(grid(), Model::J2).unwrap()) < 20.0);
}

#[test]
fn a_grid_that_the_samples_do_not_cover_is_refused() {
    let fleet = fleet(&exported(&[Product::Oem], Choices::default()));
    let epoch = grid().epoch();
    for (duration_s, step_s, missing) in [
        (7_200.0, 60.0, "2025-01-01T01:00:00"),
        (3_600.0, 30.0, "2025-01-01T00:59:30"),
    ] {
        let longer = TimeGrid::new(epoch, duration_s, step_s).unwrap();
        let error = fleet.propagate(longer, Model::J2).err().unwrap();
        assert!(error.to_string().contains(missing), "{error}");
        assert!(
            error.to_string().contains("NW-P01-S01 has no state"),
            "{error}"
        );
    }
    let earlier = TimeGrid::new(epoch.plus_seconds(-60.0), 600.0, 60.0).unwrap();
    assert!(fleet.propagate(earlier, Model::J2).is_err());
    // Every other sample, from the tenth on.
    let inside = TimeGrid::new(epoch.plus_seconds(600.0), 1_200.0, 120.0).unwrap();
    let propagated = fleet.propagate(inside, Model::J2).unwrap();
    let between = propagated.satellites()[0].propagator.state_at(60.0);
    assert!(between.is_err());
}

#[test]
fn what_makes_no_constellation_is_refused() {
    let mut oem = fleet(&exported(&[Product::Oem], Choices::default()));
    let tle = fleet(&exported(&[Product::Tle], Choices::default()));
    // The designators of both agree.
    let mut mixed = oem.clone();
    mixed.append(tle.clone());
    assert_eq!(mixed.len(), 12);
    assert_eq!(mixed.content(), "sampled states, SGP4 element sets");
    let twice = "satellite NW-P01-S01 appears twice";
    let error = |fleet: &Fleet| {
        fleet
            .propagate(grid(), Model::J2)
            .err()
            .unwrap()
            .to_string()
    };
    assert!(error(&mixed).starts_with(twice), "{}", error(&mixed));
    oem.append(oem.clone());
    assert!(error(&oem).starts_with(twice), "{}", error(&oem));
    assert_eq!(
        Fleet::Sampled(Vec::new())
            .propagate(grid(), Model::J2)
            .err(),
        Some(FleetError::Empty)
    );
    let hollow = Trajectory::of_states("A", "A", Frame::Teme, Vec::new());
    assert!(
        Fleet::Sampled(vec![hollow])
            .propagate(grid(), Model::J2)
            .is_err()
    );
    let files = exported(&[Product::Opm], Choices::default());
    let text = String::from_utf8(files["opm/NW-P01-S01.opm"].clone()).unwrap();
    let foreign: String = text
        .lines()
        .filter(|line| !line.starts_with("USER_DEFINED"))
        .map(|line| format!("{line}\n"))
        .collect();
    let error = Fleet::read(foreign.as_bytes(), None, None).unwrap_err();
    assert!(error.to_string().contains("no mean elements"), "{error}");
}

/// Nine nodes reproduce the derivative of a polynomial of degree 8; SP3 without velocities.
#[test]
fn velocities_follow_from_positions() {
    let epoch = grid().epoch();
    let at = |t: f64| Vector3::new((t / 900.0).powi(8), 3.0 * t, -t * t / 1e4);
    let positions: Vec<_> = (0..9)
        .map(|k| f64::from(k) * 300.0)
        .map(|t| (epoch.plus_seconds(t), Position::<Frame>::new(at(t))))
        .collect();
    let velocities_of = |some: &[(Epoch, Position<Frame>)]| velocities(some.len(), |k| some[k]);
    for (k, velocity) in velocities_of(&positions).unwrap().iter().enumerate() {
        let t = k as f64 * 300.0;
        let exact = Vector3::new(8.0 / 900.0 * (t / 900.0).powi(7), 3.0, -2.0 * t / 1e4);
        // Rounding of differences of numbers up to 7200 over 300 s.
        assert!((velocity - exact).norm() < 1e-10, "{k}: {velocity}");
    }
    assert_eq!(velocities_of(&positions[..1]), None);
    let twice = [positions[0], positions[0]];
    assert_eq!(velocities_of(&twice), None);
    let files = exported(&[Product::Sp3], Choices::default());
    let text = String::from_utf8(files["sp3/part-01.sp3"].clone()).unwrap();
    let positions_only: String = text
        .lines()
        .filter(|line| !line.starts_with('V'))
        .map(|line| format!("{line}\n"))
        .collect();
    let fleet = Fleet::read(positions_only.as_bytes(), None, None)
        .unwrap()
        .fleet;
    assert!(apart_km(&fleet.propagate(grid(), Model::J2).unwrap()) < 1e-6);
}

/// Twelve hours in steps of five minutes.
fn wide_grid() -> TimeGrid {
    TimeGrid::new(grid().epoch(), 43_200.0, 300.0).unwrap()
}

/// Positions of a satellite on the wide grid but for six hours without records, in each format that may leave
/// velocities out.
fn positions_with_a_gap() -> Vec<(&'static str, String)> {
    let lost = 36..108;
    let whole = subject(design(), wide_grid());
    let files = in_memory(&whole, &[Product::Sp3], Choices::default()).1;
    let mut epoch = 0;
    let mut sp3 = String::new();
    for line in std::str::from_utf8(&files["sp3/part-01.sp3"])
        .unwrap()
        .lines()
    {
        epoch += usize::from(line.starts_with("* "));
        let is_lost = epoch > 0 && lost.contains(&(epoch - 1)) && line.starts_with("PL01");
        match is_lost {
            _ if line.starts_with('V') => {}
            true => sp3 += &format!("PL01{} 999999.999999\n", format!("{:14.6}", 0.0).repeat(3)),
            false => sp3 += &format!("{line}\n"),
        }
    }
    let truth = Ephemeris::of_design(&design(), Model::J2, wide_grid()).unwrap();
    let kept = (0..144).filter(|k| !lost.contains(k)).map(|k| {
        let t = wide_grid().elapsed_s(k);
        let state = truth.state(&truth.satellites()[0], t).unwrap();
        (t, state.position_km.km() * 1e3)
    });
    let kept: Vec<_> = kept.collect();
    let rows = kept
        .iter()
        .map(|(t, r)| format!("{t} {} {} {}\n", r.x, r.y, r.z));
    let stk = format!(
        "stk.v.11.0\nBEGIN Ephemeris\nScenarioEpoch 01 Jan 2025 00:00:00\nCoordinateSystem TEMEOfDate\n\
         EphemerisTimePos\n{}END Ephemeris\n",
        rows.collect::<String>()
    );
    let fixed = crate::ephemeris::sampled::Sampled::new(&truth, Frame::EarthFixed);
    let numbers = kept.iter().map(|(t, _)| {
        let k = (t / 300.0) as usize;
        let r = fixed
            .state_at(&truth.satellites()[0], k)
            .unwrap()
            .position_km
            .km()
            * 1e3;
        format!("{t},{},{},{}", r.x, r.y, r.z)
    });
    let czml = format!(
        "[{{\"id\":\"document\",\"version\":\"1.0\"}},{{\"id\":\"A\",\"position\":{{\
         \"epoch\":\"2025-01-01T00:00:00Z\",\"interpolationAlgorithm\":\"LAGRANGE\",\
         \"interpolationDegree\":7,\"cartesian\":[{}]}}}}]",
        numbers.collect::<Vec<_>>().join(",")
    );
    vec![("sp3", sp3), ("stk", stk), ("czml", czml)]
}

/// The velocities at the edges of a gap come from their own side of it: the polynomial across six hours without records is
/// off by several times the bound and more.
#[test]
fn velocities_are_not_derived_across_a_gap() {
    let truth = Ephemeris::of_design(&design(), Model::J2, wide_grid()).unwrap();
    for (format, text) in positions_with_a_gap() {
        let fleet = Fleet::read(text.as_bytes(), None, None).unwrap().fleet;
        let Fleet::Sampled(trajectories) = &fleet else {
            panic!("{format}: {}", fleet.content())
        };
        let samples = trajectories[0].samples();
        assert_eq!(samples.len(), 72, "{format}");
        for (at, frame, state) in samples {
            let t = at.seconds_since(grid().epoch());
            let expected = truth.state(&truth.satellites()[0], t).unwrap();
            let expected = crate::frames::from_teme(expected, frame, grid().epoch(), t);
            let apart = (state.velocity_km_s - expected.velocity_km_s).norm();
            // The one-sided derivative through nine nodes is off by h⁸/9 times the ninth derivative of the position: r w⁹
            // with r = 7303 km and w = 1.09e-3 rad/s against the Earth.
            let bound_km_s = 300_f64.powi(8) / 9.0 * 7_303.0 * 1.09e-3_f64.powi(9);
            assert!(apart < bound_km_s, "{format} at {t} s: {apart} km/s");
        }
    }
}

/// A position between two gaps has no velocity: it is left out by name, in lint as in the reader.
#[test]
fn a_lone_position_without_velocity_is_left_out_by_name() {
    let (_, text) = positions_with_a_gap().swap_remove(0);
    let zeros = format!("PL01{} 999999.999999\n", format!("{:14.6}", 0.0).repeat(3));
    let lone = format!("PL01{:14.6}{}", 7303.0, &zeros[18..]);
    let second = text.match_indices(&zeros).nth(10).unwrap().0;
    let text = format!("{}{lone}{}", &text[..second], &text[second + zeros.len()..]);
    let read = Fleet::read(text.as_bytes(), None, None).unwrap();
    assert_eq!(
        read.left_out.to_string(),
        "left out: 1 (lone position without velocity: L01 at 2025-01-01T03:50:00Z)"
    );
    assert_eq!(read.fleet.len(), 6);
    let findings = crate::exchange::lint::lint(text.as_bytes(), None, None, 10)
        .unwrap()
        .findings;
    assert_eq!(findings.len(), 1, "{findings:?}");
    assert_eq!(findings[0].rule, "left-out");
    // One epoch alone: nothing is left to read.
    let epoch = "*  2025  1  1  0  5 18.00000000";
    let first = &text[..text.find(epoch).unwrap()];
    let first = format!(
        "{}EOF\n",
        first.replacen("    144 ORBIT", "      1 ORBIT", 1)
    );
    let found = crate::exchange::lint::lint(first.as_bytes(), None, None, 100)
        .unwrap()
        .findings;
    assert_eq!(found.last().unwrap().rule, "sp3-velocity", "{found:?}");
    let error = Fleet::read(first.as_bytes(), None, None)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("too few positions to derive them"),
        "{error}"
    );
}
