use super::*;
use crate::keyword::Keyword;
use crate::time::{Epoch, TimeGrid};
use crate::validate::testing;

fn found(model: Model, notation: &str) -> Findings {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 3_600.0, 600.0).unwrap();
    let evaluator = testing::evaluator_of(model, grid);
    against_integration(&Subject::new(notation.parse().unwrap(), &evaluator)).unwrap()
}

#[test]
fn validate_secular_rates_over_inclinations() {
    for (model, notation) in [Model::J2, Model::J2Osculating]
        .into_iter()
        .flat_map(|model| {
            [
                "delta:20:12/4/1@925",
                "delta:40:12/4/1@400",
                "delta:55:12/4/1@925",
                "star:90:12/4/1@925",
                "delta:120:12/4/1@1500",
            ]
            .map(|notation| (model, notation))
        })
    {
        let findings = found(model, notation);
        let failed: Vec<_> = findings.failures().collect();
        assert!(failed.is_empty(), "{model} {notation}: {failed:#?}");
    }
}

#[test]
fn validate_an_eccentric_design() {
    for model in Model::ALL {
        let findings = found(*model, "lattice:63.4:12/4/3@1200,e=0.02,w=270");
        let failed: Vec<_> = findings.failures().collect();
        assert!(failed.is_empty(), "{model}: {failed:#?}");
    }
}

/// Kepler's ellipse comes back to its start after each period.
#[test]
fn validate_the_integrator_on_two_bodies() {
    let elements = "delta:55:1/1/0@925,e=0.1"
        .parse::<crate::constellation::Design>()
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
    // A hundred revolutions at 1e-13 a step: some 1e-6 km along the track.
    assert!(apart < 1e-5, "{apart:e}");
}

/// Two bodies and SGP4 are judged in their own fields, which the report says.
#[test]
fn validate_each_model_in_its_own_field() {
    for (model, field) in [
        (Model::TwoBody, "point mass"),
        (Model::Sgp4, "J2, J3 and J4"),
    ] {
        for notation in ["delta:40:12/4/1@400", "star:86.4:12/4/1@925"] {
            let findings = found(model, notation);
            let failed: Vec<_> = findings.failures().collect();
            assert!(failed.is_empty(), "{model} {notation}: {failed:#?}");
            assert!(findings.notes.iter().any(|note| note.contains(field)));
        }
    }
}
