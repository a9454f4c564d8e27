use super::*;
use crate::time::{Epoch, TimeGrid};
use crate::validate::testing;

fn found(model: Model, notation: &str) -> Findings {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 3_600.0, 600.0).unwrap();
    let evaluator = testing::evaluator_of(model, grid);
    against_integration(&Subject::new(notation.parse().unwrap(), &evaluator)).unwrap()
}

/// Asserts that all gates are met, and says of all that are not by how much.
fn assert_met(studies: &[(Model, &str)]) {
    let failed = |(model, notation): &(Model, &str)| -> Vec<String> {
        let findings = found(*model, notation);
        let line = |check: &Check| {
            let gate = check.gate.unwrap_or(f64::NAN);
            format!(
                "{model} {notation} {} {:e} of {gate:e}",
                check.name, check.value
            )
        };
        findings.failures().map(line).collect()
    };
    let failed: Vec<String> = studies.par_iter().flat_map(failed).collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn validate_secular_rates_over_inclinations() {
    assert_met(&[
        (Model::J2, "delta:20:12/4/1@925"),
        (Model::J2, "delta:40:12/4/1@400"),
        (Model::J2, "delta:55:12/4/1@925"),
        (Model::J2, "star:90:12/4/1@925"),
        (Model::J2, "delta:120:12/4/1@1500"),
        (Model::J2Osculating, "delta:20:4/4/1@400"),
        (Model::J2Osculating, "delta:55:4/4/1@925"),
        (Model::J2Osculating, "star:90:4/4/1@925"),
    ]);
}

#[test]
fn validate_an_eccentric_design() {
    let notation = "lattice:63.4:12/4/3@1200,e=0.02,w=270";
    assert_met(&[
        (Model::TwoBody, notation),
        (Model::J2, notation),
        (Model::J2Osculating, notation),
        (Model::Sgp4, notation),
    ]);
}

/// Kepler's ellipse returns to its start after each period.
#[test]
fn validate_the_integrator_on_two_bodies() {
    let elements = "delta:55:1/1/0@925,e=0.1"
        .parse::<crate::constellation::Shell>()
        .unwrap();
    let orbit = elements.satellites()[0].elements;
    let start = crate::orbit::j2::SecularOrbit::two_body(&orbit).state(0.0);
    let period_s = TAU / orbit.kepler_mean_motion_rad_s();
    let times: Vec<f64> = (0..=100).map(|k| f64::from(k) * period_s).collect();
    let field = ZonalField::POINT_MASS;
    let states = field
        .integrate(ZonalField::acceleration, &start, &times)
        .unwrap();
    let apart = (states[100].position_km - start.position_km).norm();
    // A hundred revolutions at 1e-13 a step: some 1e-6 km in-track.
    assert!(apart < 1e-5, "{apart:e}");
}

/// Two bodies and SGP4 are judged in their own fields, which the report says.
#[test]
fn validate_each_model_in_its_own_field() {
    let (low, polar) = ("delta:40:4/4/1@400", "star:86.4:4/4/1@925");
    assert_met(&[
        (Model::TwoBody, low),
        (Model::TwoBody, polar),
        (Model::Sgp4, low),
        (Model::Sgp4, polar),
    ]);
    for (model, field) in [
        (Model::TwoBody, "point mass"),
        (Model::Sgp4, "J2, J3 and J4"),
    ] {
        let notes = found(model, "delta:40:1/1/0@400").notes;
        assert!(notes.iter().any(|note| note.contains(field)), "{notes:?}");
    }
}
