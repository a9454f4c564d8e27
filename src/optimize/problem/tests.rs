use super::*;

fn real(name: &str, lo: f64, hi: f64) -> Variable {
    let name = name.to_owned();
    Variable {
        name,
        kind: VariableKind::Real { lo, hi },
    }
}

fn integer(name: &str, lo: i64, hi: i64) -> Variable {
    let name = name.to_owned();
    Variable {
        name,
        kind: VariableKind::Integer { lo, hi },
    }
}

/// A problem that answers every genome with the same evaluation.
struct Fixed {
    space: Space,
    names: Vec<String>,
    answers: Vec<Evaluation>,
    repaired: f64,
}

impl Fixed {
    fn answering(objectives: Vec<f64>, violation: f64) -> Self {
        Self {
            space: Space::new(vec![real("x", 0.0, 1.0)]).unwrap(),
            names: vec!["a".to_owned(), "b".to_owned()],
            answers: vec![Evaluation {
                objectives,
                violation,
            }],
            repaired: 0.5,
        }
    }
}

impl Problem for Fixed {
    fn space(&self) -> &Space {
        &self.space
    }
    fn objective_names(&self) -> &[String] {
        &self.names
    }
    fn repair(&self, genome: &mut [f64]) {
        genome[0] = self.repaired;
    }
    fn evaluate(&self, _batch: &[Vec<f64>]) -> Vec<Evaluation> {
        self.answers.clone()
    }
}

#[test]
fn space_refuses_bounds_that_make_no_box() {
    let refused = |variable| Space::new(vec![variable]).unwrap_err();
    assert_eq!(Space::new(Vec::new()), Err(OptimizeError::NoVariable));
    assert!(matches!(
        refused(real("x", f64::NAN, 1.0)),
        OptimizeError::BoundNotFinite { .. }
    ));
    assert!(matches!(
        refused(real("x", 0.0, f64::INFINITY)),
        OptimizeError::BoundNotFinite { .. }
    ));
    assert!(matches!(
        refused(real("x", -f64::MAX, f64::MAX)),
        OptimizeError::BoundNotFinite { .. }
    ));
    assert!(matches!(
        refused(integer("n", i64::MIN, 0)),
        OptimizeError::IntegerTooLarge {
            value: i64::MIN,
            ..
        }
    ));
    assert_eq!(
        refused(real("x", 2.0, 1.0)).to_string(),
        "the bounds of x are reversed: 2 is above 1"
    );
    assert_eq!(
        refused(integer("n", 5, 4)).to_string(),
        "the bounds of n are reversed: 5 is above 4"
    );
    assert!(matches!(
        Space::new(vec![real("x", 0.0, 1.0), integer("x", 0, 1)]),
        Err(OptimizeError::DuplicateVariable { .. })
    ));
}

#[test]
fn clamp_finds_the_nearest_value() {
    let space = Space::new(vec![integer("n", -2, 3), real("x", -1.0, 0.5)]).unwrap();
    for (given, expected) in [
        ([1.5, 0.25], [2.0, 0.25]),
        ([9.0, 9.0], [3.0, 0.5]),
        ([-9.0, -9.0], [-2.0, -1.0]),
        ([f64::NAN, f64::NAN], [-2.0, -1.0]),
        ([f64::INFINITY, f64::NEG_INFINITY], [3.0, -1.0]),
    ] {
        let mut genome = given;
        space.clamp(&mut genome);
        assert_eq!(genome, expected, "{given:?}");
        assert_eq!(space.check(&genome), Ok(()));
    }
    let mut zero = [-0.2, -0.0];
    space.clamp(&mut zero);
    assert!(zero.iter().all(|value| value.to_bits() == 0), "{zero:?}");
}

#[test]
fn check_names_the_value_that_does_not_fit() {
    let space = Space::new(vec![integer("n", 0, 3), real("x", 0.0, 1.0)]).unwrap();
    let outside = |genome: &[f64]| space.check(genome).unwrap_err().to_string();
    assert_eq!(outside(&[1.5, 0.5]), "1.5 is not a value of variable n");
    assert_eq!(outside(&[1.0, 1.5]), "1.5 is not a value of variable x");
    assert_eq!(
        outside(&[1.0, f64::NAN]),
        "NaN is not a value of variable x"
    );
    assert_eq!(outside(&[1.0]), "a genome has 1 values for 2 variables");
}

#[test]
fn draws_cover_every_integer_and_stay_inside() {
    let space = Space::new(vec![
        integer("n", -1, 2),
        real("x", 3.0, 4.0),
        integer("one", 5, 5),
    ])
    .unwrap();
    let mut generator = Generator::new(3, 0);
    let mut counts = [0_i32; 4];
    for _ in 0..40_000 {
        let genome = space.draw(&mut generator);
        assert_eq!(space.check(&genome), Ok(()));
        assert_eq!(genome[2], 5.0);
        counts[(genome[0] + 1.0) as usize] += 1;
    }
    // Five standard deviations of a binomial count: 5 sqrt(40000 * 1/4 * 3/4) = 433.
    assert!(
        counts.iter().all(|count| (count - 10_000).abs() < 433),
        "{counts:?}"
    );
}

#[test]
fn answers_that_cannot_be_compared_are_refused() {
    let answer = |objectives, violation| {
        let problem = Fixed::answering(objectives, violation);
        evaluate(&problem, vec![vec![0.5]])
    };
    assert!(answer(vec![1.0, 2.0], 0.0).is_ok());
    assert!(answer(vec![f64::INFINITY, 2.0], 0.1).is_ok());
    for (objectives, violation) in [
        (vec![f64::NAN, 2.0], 0.0),
        (vec![f64::NAN, 2.0], 1.0),
        (vec![1.0, f64::INFINITY], 0.0),
        (vec![1.0, f64::NEG_INFINITY], 1.0),
    ] {
        assert!(matches!(
            answer(objectives, violation),
            Err(OptimizeError::Objective { .. })
        ));
    }
    for violation in [f64::NAN, -1.0, f64::INFINITY] {
        assert!(matches!(
            answer(vec![1.0, 2.0], violation),
            Err(OptimizeError::Violation { .. })
        ));
    }
    assert!(matches!(
        answer(vec![1.0], 0.0),
        Err(OptimizeError::ObjectiveCount {
            found: 1,
            expected: 2
        })
    ));
    let problem = Fixed::answering(vec![1.0, 2.0], 0.0);
    assert!(matches!(
        evaluate(&problem, vec![vec![0.1], vec![0.2]]),
        Err(OptimizeError::BatchLength {
            found: 1,
            expected: 2
        })
    ));
}

#[test]
fn repair_follows_the_clamp_and_must_stay_inside() {
    let mut problem = Fixed::answering(vec![1.0, 2.0], 0.0);
    assert_eq!(admit(&problem, vec![7.0]), Ok(vec![0.5]));
    problem.repaired = 2.0;
    assert!(matches!(
        admit(&problem, vec![0.1]),
        Err(OptimizeError::OutsideSpace { .. })
    ));
}

#[test]
fn an_infinite_objective_survives_json() {
    let individual = Individual {
        genome: vec![0.1 + 0.2],
        objectives: vec![f64::INFINITY, 1.0 / 3.0],
        violation: 0.25,
    };
    let text = serde_json::to_string(&individual).unwrap();
    assert_eq!(
        serde_json::from_str::<Individual>(&text).unwrap(),
        individual
    );
    assert!(text.contains("null"), "{text}");
}
