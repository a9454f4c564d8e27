//! Problems with known fronts, for the tests of every strategy.

use super::problem::{Evaluation, Problem, Space, Variable, VariableKind};

type Function = fn(&[f64]) -> (Vec<f64>, f64);

/// A problem defined by a function from a genome to objectives and violation.
pub(super) struct TestProblem {
    space: Space,
    names: Vec<String>,
    function: Function,
    repair: fn(&mut [f64]),
}

impl TestProblem {
    pub(super) fn new(kinds: &[VariableKind], objectives: usize, function: Function) -> Self {
        let variable = |(k, &kind): (usize, &VariableKind)| Variable {
            name: format!("x{k}"),
            kind,
        };
        let variables = kinds.iter().enumerate().map(variable).collect();
        Self {
            space: Space::new(variables).unwrap(),
            names: (0..objectives).map(|m| format!("f{m}")).collect(),
            function,
            repair: |_| {},
        }
    }

    pub(super) fn with_repair(mut self, repair: fn(&mut [f64])) -> Self {
        self.repair = repair;
        self
    }
}

impl Problem for TestProblem {
    fn space(&self) -> &Space {
        &self.space
    }
    fn objective_names(&self) -> &[String] {
        &self.names
    }
    fn repair(&self, genome: &mut [f64]) {
        (self.repair)(genome);
    }
    fn evaluate(&self, batch: &[Vec<f64>]) -> Vec<Evaluation> {
        let answer = |genome: &Vec<f64>| {
            let (objectives, violation) = (self.function)(genome);
            Evaluation {
                objectives,
                violation,
            }
        };
        batch.iter().map(answer).collect()
    }
}

pub(super) const UNIT: VariableKind = VariableKind::Real { lo: 0.0, hi: 1.0 };

/// The g of the ZDT problems (E. Zitzler, K. Deb, L. Thiele, "Comparison of
/// multiobjective evolutionary algorithms: empirical results", Evolutionary
/// Computation 8(2), 2000): 1 on the front.
fn zdt_g(x: &[f64]) -> f64 {
    1.0 + 9.0 * x[1..].iter().sum::<f64>() / (x.len() - 1) as f64
}

pub(super) fn zdt1() -> TestProblem {
    TestProblem::new(&[UNIT; 30], 2, |x| {
        let g = zdt_g(x);
        (vec![x[0], g * (1.0 - (x[0] / g).sqrt())], 0.0)
    })
}

pub(super) fn zdt2() -> TestProblem {
    TestProblem::new(&[UNIT; 30], 2, |x| {
        let g = zdt_g(x);
        (vec![x[0], g * (1.0 - (x[0] / g).powi(2))], 0.0)
    })
}

pub(super) fn zdt3() -> TestProblem {
    TestProblem::new(&[UNIT; 30], 2, |x| {
        let g = zdt_g(x);
        let wave = x[0] / g * (10.0 * std::f64::consts::PI * x[0]).sin();
        (vec![x[0], g * (1.0 - (x[0] / g).sqrt() - wave)], 0.0)
    })
}

/// The constrained problem of T. T. Binh and U. Korn, "MOBES: a multiobjective
/// evolution strategy for constrained optimization problems", Mendel 1997. Its
/// front is x = y in 0..=3, then y = 3 with x in 3..=5.
pub(super) fn binh_korn() -> TestProblem {
    let kinds = [
        VariableKind::Real { lo: 0.0, hi: 5.0 },
        VariableKind::Real { lo: 0.0, hi: 3.0 },
    ];
    TestProblem::new(&kinds, 2, |v| {
        let (x, y) = (v[0], v[1]);
        let inner = (x - 5.0).powi(2) + y * y - 25.0;
        let outer = 7.7 - (x - 8.0).powi(2) - (y + 3.0).powi(2);
        let objectives = vec![
            4.0 * x * x + 4.0 * y * y,
            (x - 5.0).powi(2) + (y - 5.0).powi(2),
        ];
        (objectives, inner.max(0.0) + outer.max(0.0))
    })
}

/// CONSTR of Deb et al. 2002: f1 = x, f2 = (1 + y)/x, y + 9 x >= 6 and
/// -y + 9 x >= 1. Its front is y = 6 - 9 x up to x = 2/3, then y = 0.
pub(super) fn constr() -> TestProblem {
    let kinds = [
        VariableKind::Real { lo: 0.1, hi: 1.0 },
        VariableKind::Real { lo: 0.0, hi: 5.0 },
    ];
    TestProblem::new(&kinds, 2, |v| {
        let (x, y) = (v[0], v[1]);
        let violation = (6.0 - y - 9.0 * x).max(0.0) + (1.0 + y - 9.0 * x).max(0.0);
        (vec![x, (1.0 + y) / x], violation)
    })
}

/// A choice of three, an integer, and two reals: t = (n + x)/8 and 1 - t, each plus a loss that is 0 if y = 0.3 and
/// the choice is that of the third of the range in which t is, in an order of their own. The front is t + f = 1.
pub(super) fn categorical() -> TestProblem {
    let kinds = [
        VariableKind::Category { count: 3 },
        VariableKind::Integer { lo: 0, hi: 7 },
        UNIT,
        UNIT,
    ];
    TestProblem::new(&kinds, 2, |v| {
        const BEST: [f64; 4] = [1.0, 2.0, 0.0, 0.0];
        let t = (v[1] + v[2]) / 8.0;
        let wrong = if v[0] == BEST[(3.0 * t) as usize] {
            0.0
        } else {
            0.3
        };
        let loss = wrong + (v[3] - 0.3).powi(2);
        (vec![t + loss, 1.0 - t + loss], 0.0)
    })
}

/// The area that the front of [`categorical`] dominates at (1.1, 1.1): the triangle below (0, 1) and (1, 0), and
/// two strips of width 0.1.
pub(super) const CATEGORICAL_AREA: f64 = 0.5 + 0.1 + 0.1 + 0.01;

/// Two integers and two reals: n and 12 - n, each plus a loss that is 0 if the
/// other variables are at (4, 1, 0.3): an integer and a real at their upper
/// bounds and a real inside. The front is every n in 0..=12 without loss.
pub(super) fn mixed() -> TestProblem {
    let kinds = [
        VariableKind::Integer { lo: 0, hi: 12 },
        VariableKind::Integer { lo: 0, hi: 4 },
        UNIT,
        UNIT,
    ];
    TestProblem::new(&kinds, 2, |v| {
        let loss = (4.0 - v[1]) + (1.0 - v[2]) + (v[3] - 0.3).powi(2);
        (vec![v[0] + loss, 12.0 - v[0] + loss], 0.0)
    })
}

/// Two counts from 10 to 15 and two reals; the objective is the product of the counts, and a product is feasible within a
/// circle whose radius shrinks with it: 0.09 for 13 · 14 = 182, 0.05 for 12 · 15 = 180, which is the least, each at
/// a place of its own.
pub(super) fn islands() -> TestProblem {
    let count = VariableKind::Integer { lo: 10, hi: 15 };
    TestProblem::new(&[count, count, UNIT, UNIT], 1, |v| {
        let (product, centre) = (v[0] * v[1], 0.5 + 0.1 * (v[0] - v[1]));
        let off = (v[2] - centre).powi(2) + (v[3] - 0.9).powi(2);
        let violation = (0.895 - product / 200.0 + 2.0 * off).max(0.0);
        (vec![product], violation)
    })
}
