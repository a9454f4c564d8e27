//! Planted skies, singular ones and some that are nearly so, against 60 digits: one verdict on every
//! path.

use super::*;
use crate::constellation::gnss::{GnssOrbit, GnssSatellite};
use crate::dop::{ClockGroup, DopFamily, Geometry, pivot_floor};
use crate::ephemeris::EphemerisSatellite;
use crate::frames::{Position, State, Teme};
use crate::keyword::Keyword;
use crate::orbit::j2::SecularOrbit;
use crate::orbit::{MeanElements, PropagationError, Propagator};
use std::f64::consts::FRAC_PI_2;

/// Made by `validation/external/make_skies.py`.
const SKIES: &str = include_str!("../../../validation/cases/skies.csv");

/// No PDOP of the table is within 5 % of one of these.
const CAPS: [f64; 3] = [100.0, 1e4, 1e6];

/// Elevation and azimuth, degrees.
type Direction = (f64, f64);

struct Sky {
    /// The line of the table.
    text: &'static str,
    weights: ObservationWeights,
    groups: Vec<Vec<Direction>>,
    truth: Option<Truth>,
}

struct Truth {
    pdop: f64,
    hdop: f64,
    vdop: f64,
    tdop: Vec<f64>,
}

fn skies() -> Vec<Sky> {
    let number = |text: &str| text.parse::<f64>().unwrap();
    let direction = |text: &str| {
        let (elevation, azimuth) = text.split_once('/').unwrap();
        (number(elevation), number(azimuth))
    };
    let sky = |line: &'static str| {
        let fields: Vec<_> = line.split(',').collect();
        let group = |text: &str| text.split(' ').map(direction).collect();
        let truth = (!fields[3].is_empty()).then(|| Truth {
            pdop: number(fields[3]),
            hdop: number(fields[4]),
            vdop: number(fields[5]),
            tdop: fields[6].split('|').map(number).collect(),
        });
        Sky {
            text: line,
            weights: ObservationWeights::from_keyword(fields[1]).unwrap(),
            groups: fields[2].split('|').map(group).collect(),
            truth,
        }
    };
    SKIES.lines().skip(1).map(sky).collect()
}

fn site() -> Site {
    Site::new(Surface::Wgs84, 40.0, 116.0, 1.0).unwrap()
}

fn unit((elevation_deg, azimuth_deg): Direction) -> Vector3<f64> {
    let local = site().local;
    let (sin_e, cos_e) = elevation_deg.to_radians().sin_cos();
    let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
    (local.east * sin_a + local.north * cos_a) * cos_e + local.up * sin_e
}

impl Sky {
    fn is_solved_up_to(&self, cap: f64) -> bool {
        self.truth.as_ref().is_some_and(|truth| truth.pdop <= cap)
    }

    fn clock_groups(&self) -> Vec<ClockGroup> {
        let group = |directions: &Vec<Direction>| {
            let mut group = ClockGroup::default();
            for &direction in directions {
                let unit = unit(direction);
                group.add(unit, self.weights.weight(unit.dot(&site().local.up)));
            }
            group
        };
        self.groups.iter().map(group).collect()
    }

    /// Relative error of a dilution. The normal matrix is wrong by one floor of its pivots at
    /// most, which any of them feels by its square; angles of up to 2π are rounded by 5e-16.
    fn tolerance(&self, pdop: f64) -> f64 {
        let satellites: usize = self.groups.iter().map(Vec::len).sum();
        pivot_floor(satellites as f64) * pdop * pdop + 1e-14 * pdop
    }

    /// Satellites in these directions at the first instant; they move on.
    fn satellites(&self, group: usize) -> Vec<GnssSatellite> {
        let orbit = |&direction: &Direction| {
            let position = site().local.origin_km + unit(direction) * 20_000.0;
            let teme = EarthRotation::from_gmst(epoch().gmst_rad(0.0)).to_teme(position);
            let (x, y, z) = (teme.km().x, teme.km().y, teme.km().z);
            GnssOrbit::Secular(SecularOrbit::two_body(&MeanElements {
                semi_major_axis_km: teme.norm(),
                eccentricity: 0.0,
                inclination_rad: FRAC_PI_2,
                raan_rad: y.atan2(x),
                arg_perigee_rad: 0.0,
                mean_anomaly_rad: z.atan2(x.hypot(y)),
            }))
        };
        let orbits = self.groups[group].iter().map(orbit).enumerate();
        orbits
            .map(|(n, orbit)| GnssSatellite {
                name: format!("{group}-{n}"),
                orbit,
            })
            .collect()
    }

    /// The first group as the constellation, the others as systems.
    fn study(&self, cap: f64) -> (Setup, Ephemeris) {
        let grid = TimeGrid::new(epoch(), 1.0, 1.0).unwrap();
        let system = |group| System::Listed {
            name: format!("system {group}"),
            satellites: self.satellites(group),
        };
        let setup = Setup::new(grid, vec![site()])
            .with_mask(Mask::from_degrees(0.0).unwrap())
            .with_gnss((1..self.groups.len()).map(system).collect())
            .with_observation_weights(self.weights)
            .with_pdop_cap(cap);
        (setup, Ephemeris::new(grid, propagated(self.satellites(0))))
    }
}

fn epoch() -> Epoch {
    Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap())
}

fn propagated(satellites: Vec<GnssSatellite>) -> Vec<EphemerisSatellite> {
    let propagate = |satellite: GnssSatellite| EphemerisSatellite {
        name: satellite.name,
        slot: None,
        propagator: Box::new(satellite.orbit),
    };
    satellites.into_iter().map(propagate).collect()
}

/// The table holds what it is for: each verdict often, and as many satellites as states.
#[test]
fn the_table_has_skies_of_every_kind() {
    let skies = skies();
    let count = |is: &dyn Fn(&Sky) -> bool| skies.iter().filter(|sky| is(sky)).count();
    assert!(count(&|sky| sky.truth.is_none()) > 100);
    assert!(count(&|sky| sky.is_solved_up_to(100.0)) > 60);
    assert!(count(&|sky| sky.is_solved_up_to(1e6) && !sky.is_solved_up_to(100.0)) > 60);
    assert!(count(&|sky| sky.truth.is_some() && !sky.is_solved_up_to(1e6)) > 60);
    let surplus = |sky: &Sky| {
        sky.groups
            .iter()
            .map(|group| group.len() - 1)
            .sum::<usize>()
    };
    assert!(count(&|sky| surplus(sky) == 3 && sky.is_solved_up_to(1e6)) > 5);
    assert!(count(&|sky| surplus(sky) < 3) > 5);
}

/// The rule itself: whatever the cap, no singular sky is solved, and none refused that has a
/// solution.
#[test]
fn validate_verdicts_and_dilutions_of_planted_skies() {
    for sky in skies() {
        let groups = sky.clock_groups();
        let mut geometry = Geometry::default();
        groups.iter().for_each(|group| geometry.add(group));
        for cap in CAPS {
            let pdop = geometry.pdop(cap);
            let dops = DopFamily::of(&groups, &site().local, cap);
            let expected = sky.is_solved_up_to(cap);
            assert_eq!(pdop.is_some(), expected, "{cap} {pdop:?} {}", sky.text);
            assert_eq!(pdop, dops.as_ref().map(|dops| dops.pdop), "{}", sky.text);
            let (Some(dops), Some(truth)) = (dops, &sky.truth) else {
                continue;
            };
            let mut pairs = vec![
                (dops.pdop, truth.pdop),
                (dops.hdop, truth.hdop),
                (dops.vdop, truth.vdop),
            ];
            assert_eq!(dops.tdop.len(), truth.tdop.len());
            let clocks = dops.tdop.iter().map(|tdop| tdop.unwrap());
            pairs.extend(clocks.zip(truth.tdop.iter().copied()));
            let gdop2 = truth.tdop.iter().map(|tdop| tdop * tdop).sum::<f64>();
            pairs.push((dops.gdop, truth.pdop.hypot(gdop2.sqrt())));
            for (ours, theirs) in pairs {
                let apart = (ours / theirs - 1.0).abs();
                assert!(
                    apart <= sky.tolerance(truth.pdop),
                    "{ours} {theirs} {apart:e} {}",
                    sky.text
                );
            }
        }
        // Without a cap the pivots alone decide: no PDOP up to 2.4e7 over the root of the weight is
        // refused; a third of it leaves room for rounding.
        let uncapped = geometry.pdop(f64::INFINITY);
        assert!(sky.truth.is_some() || uncapped.is_none(), "{}", sky.text);
        assert!(
            !sky.is_solved_up_to(1.5e6) || uncapped.is_some(),
            "{}",
            sky.text
        );
    }
}

/// What one path says about a sky of one sample.
#[derive(Debug, PartialEq)]
struct Verdict {
    solved: f64,
    pdop: Option<f64>,
}

fn verdicts(setup: &Setup, ephemeris: &Ephemeris) -> [(&'static str, Verdict); 5] {
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let of_metrics = |metrics: Metrics| Verdict {
        solved: metrics.solved_fraction,
        pdop: metrics.max_pdop,
    };
    let series = evaluator.series(ephemeris).unwrap();
    let dops = evaluator.dops(ephemeris).unwrap();
    let dops_plain = evaluator.dops_plain(ephemeris).unwrap();
    let named = dops.named();
    let numbers = named.iter().filter_map(|(_, summary)| *summary);
    assert!(numbers.map(|x| x.mean).all(f64::is_finite), "{named:?}");
    [
        (
            "plain",
            of_metrics(evaluator.evaluate_plain(ephemeris).unwrap()),
        ),
        (
            "kernel",
            of_metrics(evaluator.evaluate_ephemeris(ephemeris).unwrap()),
        ),
        (
            "series",
            Verdict {
                solved: series.points[0].solved_fraction,
                pdop: series.epochs[0].max_pdop,
            },
        ),
        (
            "dops",
            Verdict {
                solved: dops.solved_fraction,
                pdop: dops.pdop.map(|summary| summary.max),
            },
        ),
        (
            "plain dops",
            Verdict {
                solved: dops_plain.solved_fraction,
                pdop: dops_plain.pdop.map(|summary| summary.max),
            },
        ),
    ]
}

fn check_paths(sky: &Sky, setup: &Setup, ephemeris: &Ephemeris) {
    let paths = verdicts(setup, ephemeris);
    let expected = sky.is_solved_up_to(setup.pdop_cap);
    for (path, verdict) in &paths {
        let solved = f64::from(u8::from(expected));
        assert_eq!(
            verdict.solved, solved,
            "{path} {} {}",
            setup.pdop_cap, sky.text
        );
        assert_eq!(verdict.pdop.is_some(), expected, "{path} {}", sky.text);
        if let (Some(pdop), Some(truth)) = (verdict.pdop, &sky.truth) {
            let apart = (pdop / truth.pdop - 1.0).abs();
            // The kernel keeps values in f32, and makes those of a series in it; positions are rounded as angles are.
            let single = if *path == "series" { 1e-6 } else { 1e-7 };
            let tolerance = 2.0 * sky.tolerance(truth.pdop) + single;
            assert!(apart <= tolerance, "{path} {apart:e} {}", sky.text);
        }
    }
    // The dilutions of the plain path are from the same sums, and those of the kernel say its PDOP.
    for (one, other) in [(0, 4), (1, 3)] {
        assert_eq!(
            paths[one].1, paths[other].1,
            "{} {}",
            paths[other].0, sky.text
        );
    }
}

/// The same through every path from satellites to metrics, with clocks of their own.
#[test]
fn validate_every_path_on_planted_skies() {
    for sky in skies() {
        for cap in CAPS {
            let (setup, ephemeris) = sky.study(cap);
            check_paths(&sky, &setup, &ephemeris);
        }
    }
}

/// A sky of one clock, some of it GNSS satellites that share it with the constellation.
#[test]
fn validate_shared_clocks_on_planted_skies() {
    for sky in skies().into_iter().filter(|sky| sky.groups.len() == 1) {
        for shared in [1, sky.groups[0].len() / 2] {
            let (setup, ephemeris) = sky.study(1e6);
            let mut satellites = sky.satellites(0);
            let leo = satellites.split_off(shared);
            let gnss = System::Listed {
                name: "shared".to_owned(),
                satellites,
            };
            let setup = setup.with_gnss(vec![gnss]).with_clocks(Clocks::Shared);
            let ephemeris = Ephemeris::new(ephemeris.grid(), propagated(leo));
            check_paths(&sky, &setup, &ephemeris);
        }
    }
}

/// Nine hundred satellites, half of them GNSS, that leave a pivot close to its floor: sums
/// of the same satellites in another order would decide differently.
#[test]
fn pivots_at_the_floor_are_decided_by_the_same_sums() {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let elevation_deg = 40.0_f64;
    // Elevations spread evenly over ±s about a cone give a pivot of n s² cos² ε / 3.
    let at_floor_rad = (3.0 * pivot_floor(1.0)).sqrt() / elevation_deg.to_radians().cos();
    let (mut solved, mut unsolved) = (0, 0);
    for step in 0..60 {
        let spread_deg = at_floor_rad.to_degrees() * (0.8 + 0.014 * f64::from(step));
        let direction = |n: i32| {
            let along = (f64::from(n) * GOLDEN).fract() * 2.0 - 1.0;
            let azimuth_deg = (f64::from(n) * GOLDEN * GOLDEN).fract() * 360.0;
            (elevation_deg + along * spread_deg, azimuth_deg)
        };
        let all: Vec<Direction> = (0..900).map(direction).collect();
        let sky = Sky {
            text: "",
            weights: ObservationWeights::Unit,
            groups: vec![all[..450].to_vec(), all[450..].to_vec()],
            truth: None,
        };
        let (setup, ephemeris) = sky.study(1e6);
        for clocks in [Clocks::PerSystem, Clocks::Shared] {
            let paths = verdicts(&setup.clone().with_clocks(clocks), &ephemeris);
            for (path, verdict) in &paths[1..] {
                assert_eq!(verdict.solved, paths[0].1.solved, "{path} {step} {clocks}");
            }
            solved += i32::from(paths[0].1.solved == 1.0);
            unsolved += i32::from(paths[0].1.solved == 0.0);
        }
    }
    assert!(solved > 20 && unsolved > 20, "{solved} {unsolved}");
}

/// Satellites docked to each other in two places at most, as seen from anywhere: none of the many
/// samples with enough of them is solved, by any path at any cap.
#[test]
fn an_equatorial_ring_of_docked_satellites_solves_nothing() {
    let design: Design = "delta:0:36/6/0@3000".parse().unwrap();
    let grid = TimeGrid::new(epoch(), 7200.0, 600.0).unwrap();
    let region = Grid {
        latitude_deg: [-30.0, 30.0],
        longitude_deg: [-180.0, 175.0],
        step_deg: [10.0, 15.0],
        weights: PointWeights::Equal,
    };
    for cap in [100.0, 1e6] {
        let setup = Setup::new(grid, region.sites(Surface::Wgs84).unwrap()).with_pdop_cap(cap);
        let ephemeris = Ephemeris::of_design(&design, setup.model, grid).unwrap();
        let (_, rechecks) = Evaluator::new(setup.clone())
            .unwrap()
            .evaluate_counted(&design)
            .unwrap();
        assert!(rechecks.near_limit > 100, "{rechecks:?}");
        for (path, verdict) in verdicts(&setup, &ephemeris) {
            let nothing = Verdict {
                solved: 0.0,
                pdop: None,
            };
            assert_eq!(verdict, nothing, "{path} {cap}");
        }
    }
}

/// A satellite that stays where it is at the first instant.
struct Resting(Vector3<f64>);

impl Propagator for Resting {
    fn state_at(&self, _elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        Ok(State {
            position_km: Position::new(self.0),
            velocity_km_s: Vector3::zeros(),
        })
    }
}

/// A satellite on the horizon has no weight by elevation: it is in view, but has no part in a position, nor has its clock.
#[test]
fn a_satellite_without_weight_is_seen_and_not_used() {
    let mut pole = Site::new(Surface::Sphere, 90.0, 0.0, 1.0).unwrap();
    // Exactly, so that the elevation of what is beside it is 0 and not a rounding of it.
    let height_km = pole.local.origin_km.norm();
    pole.local.origin_km = Position::new(Vector3::z() * height_km);
    pole.local.up = Vector3::z();
    (pole.local.east, pole.local.north) = (Vector3::y(), -Vector3::x());
    let grid = TimeGrid::new(epoch(), 1.0, 1.0).unwrap();
    let beside = EphemerisSatellite {
        name: "beside".to_owned(),
        slot: None,
        propagator: Box::new(Resting(Vector3::new(2000.0, 0.0, height_km))),
    };
    let with = Ephemeris::new(grid, vec![beside]);
    let without = Ephemeris::new(grid, Vec::new());
    for clocks in [Clocks::PerSystem, Clocks::Shared] {
        let setup = Setup::new(grid, vec![pole.clone()])
            .with_mask(Mask::from_degrees(0.0).unwrap())
            .with_gnss(vec![Preset::Gps.into()])
            .with_clocks(clocks)
            .with_observation_weights(ObservationWeights::SineElevation);
        let evaluator = Evaluator::new(setup.clone()).unwrap();
        assert_eq!(
            evaluator.evaluate_ephemeris(&with).unwrap().mean_visible,
            1.0
        );
        let alone = verdicts(&setup, &without);
        assert_eq!(alone[0].1.solved, 1.0);
        assert_eq!(verdicts(&setup, &with), alone, "{clocks}");
    }
}
