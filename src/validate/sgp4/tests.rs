use super::*;
use crate::constellation::Shell;
use crate::evaluate::Evaluator;
use crate::time::{Epoch, TimeGrid};
use crate::units::SECONDS_PER_DAY;
use crate::validate::testing;

const INCLINATIONS_DEG: [f64; 6] = [40.0, 50.0, 55.0, 60.0, 86.4, 90.0];

fn day() -> TimeGrid {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    TimeGrid::new(epoch, SECONDS_PER_DAY, 300.0).unwrap()
}

fn design(inclination_deg: f64, altitude_km: f64) -> Shell {
    format!("delta:{inclination_deg}:30/6/1@{altitude_km}")
        .parse()
        .unwrap()
}

/// A study with few points over a day.
fn evaluator() -> Evaluator {
    testing::evaluator(day())
}

fn found(design: Shell) -> Findings {
    against_sgp4(&Subject::new(design, &evaluator())).unwrap()
}

fn line<'a>(findings: &'a Findings, case: &str) -> &'a BudgetLine {
    findings
        .budget
        .iter()
        .find(|line| line.case == case)
        .unwrap()
}

/// Drift of the naive mean motion against J2 with its dM/dt term at 925 km, from an independent
/// calculation with SGP4's secular rates (km/day, printed to 1 km/day).
#[test]
fn validate_drift_of_the_kepler_slot() {
    let expected = [-301.0, -95.0, 4.0, 98.0, 391.0, 395.0];
    for (inclination_deg, expected) in INCLINATIONS_DEG.into_iter().zip(expected) {
        let findings = found(design(inclination_deg, 925.0));
        let growth = line(&findings, "kepler-slot").growth_km_per_day.in_track;
        // Half a printed digit, and a chord that is 0.05 km shorter than its arc of 400 km.
        assert!(
            (growth - expected).abs() < 0.6,
            "{inclination_deg}: {growth}"
        );
    }
}

/// RIC RMS at 55° and 925 km over a day, from an independent implementation: 4.4 / 8.7 / 1.5 km,
/// and 0.7 / 0.4 / 1.5 km without J3 and J4 (two digits printed).
#[test]
fn validate_rms_of_the_budget() {
    let findings = found(design(55.0, 925.0));
    // The cases of mean J2 are the same beside every model.
    for (case, expected) in [
        ("mean-j2/sgp4", [4.4, 8.7, 1.5]),
        ("mean-j2/sgp4-no-j3j4", [0.7, 0.4, 1.5]),
        // Three digits were given for these, 0.006 / 0.10 / 0.07.
        ("osculating-j2/sgp4-no-j3j4", [0.006, 0.10, 0.07]),
    ] {
        let rms = line(&findings, case).rms_km;
        for (ours, theirs) in [rms.radial, rms.in_track, rms.cross_track]
            .iter()
            .zip(expected)
        {
            let digit = if theirs < 0.3 { 0.005 } else { 0.05 };
            assert!((ours - theirs).abs() <= digit, "{case}: {ours} {theirs}");
        }
    }
}

/// The sweep agrees with single designs: the drift of the naive mean motion as above at 40, 50,
/// 55, 60 and 86.4°.
#[test]
fn validate_the_sweep() {
    let findings = found(design(55.0, 925.0));
    let drifts = [
        (40.0, -301.0),
        (50.0, -95.0),
        (55.0, 4.0),
        (60.0, 98.0),
        (86.4, 391.0),
    ];
    for (inclination_deg, expected) in drifts {
        let at = |cell: &&SweepCell| {
            cell.inclination_deg == inclination_deg && cell.altitude_km == 925.0
        };
        let cell = findings.sweep.iter().find(at).unwrap();
        let kepler = cell.budget.iter().find(|line| line.case == "kepler-slot");
        let growth = kepler.unwrap().growth_km_per_day.in_track;
        // As above, plus up to 0.5 km/day that twelve satellites do not average out.
        assert!(
            (growth - expected).abs() < 1.1,
            "{inclination_deg}: {growth}"
        );
    }
    assert_eq!(findings.sweep.len(), 24);
}

/// The budget, the rates and the frozen eccentricity that fail their gates.
fn failures_beside_the_sweep(subject: &Subject<'_>) -> Vec<String> {
    let grid = subject.grid();
    let scale = GateScale::of(subject, grid);
    let propagations = Propagations::new(subject, grid).unwrap();
    let mut findings = Findings::default();
    let budget = propagations.budget().unwrap();
    findings.checks.extend(scale.budget_checks(&budget));
    findings
        .checks
        .extend(rates::checks(subject, &scale).unwrap());
    findings
        .checks
        .extend(frozen::checks(subject, &scale).unwrap());
    let told = |check: &Check| {
        let gate = check.gate.unwrap_or(f64::NAN);
        format!("{} {:e} of {gate:e}", check.name, check.value)
    };
    findings.failures().map(told).collect()
}

/// The gates are closed forms that are valid at all inclinations and LEO altitudes, for every model
/// that must meet them.
#[test]
fn gates_follow_inclination_and_altitude() {
    let mut failed = Vec::new();
    for model in [Model::J2, Model::J2Osculating, Model::Sgp4] {
        let evaluator = testing::evaluator_of(model, day());
        for inclination_deg in (0..=18).map(|n| f64::from(n) * 10.0) {
            for altitude_km in [400.0, 2000.0] {
                let subject = Subject::new(design(inclination_deg, altitude_km), &evaluator);
                let failures = failures_beside_the_sweep(&subject);
                let at =
                    |text: String| format!("{model} {inclination_deg}° {altitude_km} km {text}");
                failed.extend(failures.into_iter().map(at));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// The model of the study comes first in the first case and must meet its gates; mean J2 is reported
/// too, under its usual names.
#[test]
fn the_model_of_the_study_is_on_trial() {
    let cases = |model| {
        let evaluator = testing::evaluator_of(model, day());
        let subject = Subject::new(design(55.0, 925.0), &evaluator);
        let findings = against_sgp4(&subject).unwrap();
        let gated = findings.checks.iter().filter(|check| check.gate.is_some());
        let gated: std::collections::BTreeSet<String> = gated
            .filter_map(|check| {
                Some(
                    check
                        .name
                        .strip_prefix("sgp4/")?
                        .rsplit_once('/')?
                        .0
                        .to_owned(),
                )
            })
            .filter(|case| case.contains("/sgp4"))
            .collect();
        let names: Vec<_> = findings
            .budget
            .iter()
            .map(|line| line.case.clone())
            .collect();
        let failed: Vec<_> = findings
            .failures()
            .map(|check| check.name.clone())
            .collect();
        (names, gated, failed)
    };
    let beside = [
        "mean-j2/sgp4",
        "mean-j2/sgp4-no-j3j4",
        "osculating-j2/sgp4-no-j3j4",
        "osculating-j2/sgp4",
        "kepler-slot",
    ];
    for (model, own) in [
        (Model::J2, &[][..]),
        (Model::TwoBody, &["two-body/sgp4", "two-body/sgp4-no-j3j4"]),
        (
            Model::J2Osculating,
            &["j2-osculating/sgp4", "j2-osculating/sgp4-no-j3j4"],
        ),
        (Model::Sgp4, &["sgp4/sgp4", "sgp4/sgp4-no-j3j4"]),
    ] {
        let (names, gated, failed) = cases(model);
        let expected: Vec<&str> = own.iter().chain(&beside).copied().collect();
        assert_eq!(names[..expected.len()], expected, "{model}");
        let label = names[0].split_once('/').unwrap().0;
        assert!(
            gated.iter().all(|case| case.starts_with(label)) && !gated.is_empty(),
            "{model}: {gated:?}"
        );
        // Two-body propagation lacks the effect of J2; the others meet their gates.
        assert_eq!(
            failed.is_empty(),
            model != Model::TwoBody,
            "{model}: {failed:?}"
        );
    }
}

/// A mean over few satellites and samples holds a rest of the periodic terms, more of it with a step near a fraction of
/// the revolution.
#[test]
fn gates_follow_the_samples() {
    let mut failed = Vec::new();
    for (text, hours, step_s) in [
        ("delta:53:2/2/1@550", 12.0, 1200.0),
        ("star:86.4:2/2/1@780", 12.0, 1200.0),
        ("delta:40:2/1/0@1000", 12.0, 1200.0),
        ("delta:55:2/1/0@500", 12.0, 1200.0),
        ("delta:63.4:1/1/0@1200", 5.0, 1500.0),
        ("delta:30:1/1/0@700", 24.0, 2950.0),
        ("delta:30:3/3/0@700", 24.0, 60.0),
    ] {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, hours * 3600.0, step_s).unwrap();
        for model in [Model::J2, Model::J2Osculating, Model::Sgp4] {
            let evaluator = testing::evaluator_of(model, grid);
            let subject = Subject::new(text.parse().unwrap(), &evaluator);
            let failures = failures_beside_the_sweep(&subject);
            let of = |check: String| format!("{model} {text} {check}");
            failed.extend(failures.into_iter().map(of));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// A sine that is sampled: its mean and the slope of the straight line through it, whatever its phase, are within the
/// bounds of a single satellite, and come close to them.
#[test]
fn validate_what_samples_leave_of_a_sine() {
    let shell: Shell = "delta:55:1/1/0@925".parse().unwrap();
    let satellites = shell.satellites();
    let n = satellites[0].elements.kepler_mean_motion_rad_s();
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let mut closest = [0.0_f64; 2];
    for step_s in [60.0, 600.0, 1200.0, 1500.0, 2900.0, 3050.0] {
        for hours in [5.0, 12.0, 23.0, 24.0] {
            let grid = TimeGrid::new(epoch, hours * 3600.0, step_s).unwrap();
            let bounds = Leftover::of(&satellites, grid);
            let days: Vec<f64> = grid.iter().map(|t| t / SECONDS_PER_DAY).collect();
            for (place, harmonic) in [1.0, 2.0, 4.0].into_iter().enumerate() {
                for phase in 0..24 {
                    let phase = f64::from(phase) * std::f64::consts::TAU / 24.0;
                    let sine = |t: f64| (harmonic * n * t + phase).sin();
                    let values: Vec<f64> = grid.iter().map(sine).collect();
                    let mean = values.iter().sum::<f64>() / values.len() as f64;
                    let (_, slope) = crate::stats::line_fit(&days, &values).unwrap();
                    let shares = [
                        mean.abs() / bounds.mean[place],
                        slope.abs() / bounds.slope_per_day[place],
                    ];
                    for (closest, share) in closest.iter_mut().zip(shares) {
                        *closest = closest.max(share);
                    }
                }
            }
        }
    }
    // The slope leaves out a term that is smaller by the number of radians in the span, 9 or more here.
    assert!(closest[0] <= 1.0 && closest[1] <= 1.2, "{closest:?}");
    assert!(closest[0] > 0.9 && closest[1] > 0.9, "{closest:?}");
}

#[test]
fn an_eccentric_design_keeps_its_gates() {
    let text = "lattice:63.4:30/6/5@950,e=0.01,w=270";
    let findings = found(text.parse().unwrap());
    let failed: Vec<_> = findings.failures().collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn a_decayed_orbit_is_an_error() {
    let evaluator = evaluator();
    // J3's frozen eccentricity takes a circular orbit at 1 km about 6 km below the ground.
    let subject = Subject::new("delta:55:4/2/1@1".parse().unwrap(), &evaluator);
    let error = against_sgp4(&subject).unwrap_err().to_string();
    assert!(
        error.starts_with("NW-P") && error.contains("the orbit has decayed"),
        "{error}"
    );
    // At 20 km it stays above the ground, and everything else is fine.
    let subject = Subject::new("delta:55:4/2/1@20".parse().unwrap(), &evaluator);
    let findings = against_sgp4(&subject).unwrap();
    let failed: Vec<_> = findings.failures().collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn deep_space_is_reported_only() {
    let findings = found("delta:55:4/2/1@20000".parse().unwrap());
    // The design's own; the sweep covers low orbits.
    let budget = |check: &&Check| check.name.starts_with("sgp4/mean-j2/sgp4");
    assert!(findings.passed());
    assert!(
        findings
            .checks
            .iter()
            .filter(budget)
            .all(|check| check.gate.is_none())
    );
}

/// The published verification set: every state of it, in both modes.
#[test]
fn validate_the_crate_against_the_verification_set() {
    let findings = against_the_verification_set(Sgp4Theory::STANDARD);
    let states: Vec<_> = findings.distributions.iter().map(|d| d.n).collect();
    // 700 lines minus 33 headings minus the state of the rejected set; the C++ code rejects two more.
    assert_eq!(states, [666, 665, 665]);
    assert!(findings.passed(), "{:#?}", findings.checks);
}

/// An epoch between two steps of a TLE: the elements are propagated, not relabelled.
#[test]
fn the_epoch_of_a_tle_costs_nothing() {
    let epoch = Epoch::from_utc("2025-03-20T11:22:33.4444444Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 7_200.0, 300.0).unwrap();
    let evaluator = testing::evaluator(grid);
    let subject = Subject::new(design(55.0, 925.0), &evaluator);
    let findings = against_sgp4(&subject).unwrap();
    let failed: Vec<_> = findings.failures().collect();
    assert!(failed.is_empty(), "{failed:#?}");
}
