//! What proves from a part of the samples that a constraint cannot be kept ([M-61](crate::models#m-61)).
//!
//! A rule may only reject what an evaluation of all samples rejects too. Counts are whole numbers, so that their
//! rules are exact; what rests on sums of PDOP needs a little more than the bound.

use crate::evaluate::{SampleTiles, Setup};
use crate::search::{Constraint, Quantity, Relation};

/// How far a sum of PDOP must be beyond its bound, relative: sums in another order differ by less than 1e-10 for 1e6
/// samples, and the tail moves by up to 1e-9 of a sample.
pub(super) const SUM_MARGIN: f64 = 1e-8;

/// How far a single PDOP must be beyond a bound on an order statistic, relative: the statistic is computed again in
/// f64, and its value in f32 is off by up to 1e-6.
const SINGLE_MARGIN: f64 = 4e-6;

/// How far a violation must be beyond another, relative and absolute: far more than either is rounded.
const VIOLATION_MARGIN: f64 = 1e-12;

/// A sample that counts against a constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum BadSample {
    /// Unsolved, or PDOP above the availability threshold.
    Unavailable(f32),
    /// Unsolved.
    Unsolved,
    /// Solved, and PDOP above a value.
    Above(f32),
    /// Fewer LEO satellites in view.
    FewerLeo(u32),
    /// Fewer satellites in view, LEO and GNSS.
    FewerTotal(u32),
}

/// A proof that a constraint cannot be kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Proof {
    /// Bad samples of more than this weight.
    Count { bad: BadSample, allowed: u64 },
    /// Samples above the bound, more than a quantile of this level leaves of those that can be solved.
    Quantile { above: BadSample, level: f64 },
    /// The mean PDOP with the least that the rest can have.
    Mean { bound: f64 },
    /// The mean of the worst samples so far.
    Tail { bound: f64 },
    /// Mean plus weighted tail.
    MeanAndTail { bound: f64, weight: f64 },
    /// So many unavailable samples in a row at a point.
    Run { samples: u32 },
}

/// A proof with the place of its constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SampleRule {
    pub(super) constraint: usize,
    pub(super) proof: Proof,
}

/// What the rules of a search depend on.
pub(super) struct RuleSet {
    pub(super) rules: Vec<SampleRule>,
    pub(super) shape: SampleTiles,
    /// α of the tail.
    pub(super) tail_level: f64,
    pub(super) step_s: f64,
    pub(super) sites: usize,
    /// c of the least PDOP c/√N.
    pub(super) least_pdop: f64,
    pub(super) gnss: usize,
}

impl RuleSet {
    pub(super) fn new(
        constraints: &[Constraint],
        setup: &Setup,
        shape: SampleTiles,
        gnss: usize,
    ) -> Self {
        let mut set = Self {
            rules: Vec::new(),
            shape,
            tail_level: setup.metrics.cvar_level.get(),
            step_s: setup.grid.step_s(),
            sites: setup.sites.len(),
            least_pdop: super::bound::of_setup(setup),
            gnss,
        };
        for (place, constraint) in constraints.iter().enumerate() {
            let proofs = set.proofs(constraint, setup.metrics.cvar_weight);
            let rule = |proof| SampleRule {
                constraint: place,
                proof,
            };
            set.rules.extend(proofs.into_iter().map(rule));
        }
        set
    }

    /// The rules that prove a violation beyond `most` of one constraint or another, so that of all together is beyond it
    /// too. The part of a violation that unsolved samples are is left out.
    pub(super) fn beyond(
        constraints: &[Constraint],
        most: f64,
        setup: &Setup,
        shape: SampleTiles,
        gnss: usize,
    ) -> Self {
        let relaxed: Vec<Constraint> = constraints.iter().map(|one| relaxed(one, most)).collect();
        let mut set = Self::new(&relaxed, setup, shape, gnss);
        set.rules.retain(|rule| {
            let of_unsolved = matches!(
                rule.proof,
                Proof::Count {
                    bad: BadSample::Unsolved,
                    ..
                }
            );
            !of_unsolved
        });
        set
    }

    /// The proofs for a constraint; none where only an evaluation of all samples decides.
    fn proofs(&self, constraint: &Constraint, cvar_weight: f64) -> Vec<Proof> {
        let &Constraint {
            quantity,
            relation,
            bound,
        } = constraint;
        let count = |bad, allowed| Proof::Count { bad, allowed };
        if relation == Relation::AtLeast {
            let at_least = |share: f64| share >= bound;
            return match (quantity, quantity.coverage_levels()) {
                (Quantity::Availability, _) => {
                    let bad = BadSample::Unavailable(self.shape.available_up_to);
                    vec![count(bad, self.spare(at_least))]
                }
                (Quantity::LeastVisible, _) => least_count(bound)
                    .map(|least| count(BadSample::FewerLeo(least), 0))
                    .into_iter()
                    .collect(),
                (_, Some((satellites, is_total))) => {
                    let least = satellites as u32;
                    let bad = match is_total {
                        true => BadSample::FewerTotal(least),
                        false => BadSample::FewerLeo(least),
                    };
                    vec![count(bad, self.spare(at_least))]
                }
                _ => Vec::new(),
            };
        }
        let unsolved = || {
            let is_enough = |solved: f64| quantity.unsolved_share(solved) == 0.0;
            count(BadSample::Unsolved, self.spare(is_enough))
        };
        let above = BadSample::Above(((bound * (1.0 + SINGLE_MARGIN)) as f32).next_up());
        let quantile = |level| Proof::Quantile { above, level };
        match quantity {
            Quantity::MaxPdop => vec![unsolved(), count(above, 0)],
            Quantity::P95Pdop => vec![unsolved(), quantile(0.95)],
            Quantity::P99Pdop => vec![unsolved(), quantile(0.99)],
            Quantity::MeanPdop => vec![unsolved(), Proof::Mean { bound }],
            Quantity::CvarPdop => vec![unsolved(), Proof::Tail { bound }],
            Quantity::JPos if cvar_weight >= 0.0 => {
                let weight = cvar_weight;
                vec![unsolved(), Proof::MeanAndTail { bound, weight }]
            }
            Quantity::LongestOutageS => self.run(bound).into_iter().collect(),
            _ => Vec::new(),
        }
    }

    /// The greatest weight of bad samples with which the share of the good ones is enough, computed as the metrics
    /// are; 0 if not even all are.
    fn spare(&self, is_enough: impl Fn(f64) -> bool) -> u64 {
        let total = self.shape.total_weight;
        let suffices = |bad: u64| is_enough((total - bad) as f64 / total as f64);
        let (mut most, mut too_many) = (0, total.saturating_add(1));
        while too_many - most > 1 {
            let middle = most + (too_many - most) / 2;
            if suffices(middle) {
                most = middle;
            } else {
                too_many = middle;
            }
        }
        most
    }

    /// The shortest run of samples that is longer than a bound in seconds.
    fn run(&self, bound_s: f64) -> Option<Proof> {
        let is_longer = |samples: &u32| f64::from(*samples) * self.step_s > bound_s;
        let about = (bound_s / self.step_s).floor().max(0.0);
        let about = if about < self.shape.instants as f64 {
            about as u32
        } else {
            return None;
        };
        let samples = (about.saturating_sub(1)..=about + 2)
            .find(is_longer)?
            .max(1);
        Some(Proof::Run { samples })
    }

    /// Whether a proof counts towards the mean of PDOP.
    pub(super) fn sums_pdop(&self) -> bool {
        self.rules.iter().any(|rule| {
            matches!(
                rule.proof,
                Proof::Mean { .. } | Proof::Tail { .. } | Proof::MeanAndTail { .. }
            )
        })
    }

    pub(super) fn has_tail(&self) -> bool {
        let of_tail = |rule: &SampleRule| {
            matches!(rule.proof, Proof::Tail { .. } | Proof::MeanAndTail { .. })
        };
        self.rules.iter().any(of_tail)
    }

    pub(super) fn has_runs(&self) -> bool {
        let of_run = |rule: &SampleRule| matches!(rule.proof, Proof::Run { .. });
        self.rules.iter().any(of_run)
    }
}

/// A constraint that every design keeps whose violation of the original is at most `most`.
fn relaxed(constraint: &Constraint, most: f64) -> Constraint {
    // The violation and this bound are rounded.
    let most = most * (1.0 + VIOLATION_MARGIN) + VIOLATION_MARGIN;
    let by = most * constraint.bound.abs().max(1.0);
    Constraint {
        bound: match constraint.relation {
            Relation::AtMost => constraint.bound + by,
            Relation::AtLeast => constraint.bound - by,
        },
        ..*constraint
    }
}

/// The fewest satellites that meet a bound; `None` if any number does.
fn least_count(bound: f64) -> Option<u32> {
    (bound > 0.0).then(|| bound.ceil().min(f64::from(u32::MAX)) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::testing::setup;
    use crate::time::{Epoch, TimeGrid};

    fn rules(constraints: &[&str], total_weight: u64) -> Vec<Proof> {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 86_400.0, 60.0).unwrap();
        let shape = SampleTiles {
            tiles: 9,
            instants: 1440,
            total_weight,
            available_up_to: 1.5,
        };
        let constraints: Vec<Constraint> = constraints.iter().map(|c| c.parse().unwrap()).collect();
        let set = RuleSet::new(&constraints, &setup(grid, Vec::new(), 7.0), shape, 30);
        set.rules.iter().map(|rule| rule.proof).collect()
    }

    fn allowed(constraint: &str, total: u64) -> u64 {
        match rules(&[constraint], total)[0] {
            Proof::Count { allowed, .. } => allowed,
            _ => panic!("{constraint} is not counted"),
        }
    }

    /// 0.999 of 205 920 samples leave 205.92: the 206th bad one is too many.
    #[test]
    fn validate_availability_by_hand() {
        assert_eq!(allowed("availability >= 0.999", 205_920), 205);
        assert_eq!(allowed("coverage-4 >= 0.999", 205_920), 205);
        assert_eq!(allowed("coverage-total-9 >= 1", 205_920), 0);
        assert_eq!(allowed("availability >= 0", 205_920), 205_920);
    }

    /// The last weight that is allowed is kept by the metric, and the next is not, whatever rounding does.
    #[test]
    fn counts_round_as_the_metric() {
        for total in [7_u64, 1000, 205_920, (1 << 61) + 12_345] {
            for bound in [0.1, 0.5, 0.9, 0.95, 0.999, 1.0 - 1e-12] {
                let allowed = allowed(&format!("availability >= {bound}"), total);
                let share = |bad: u64| (total - bad) as f64 / total as f64;
                assert!(share(allowed) >= bound, "{total} {bound}");
                assert!(
                    allowed == total || share(allowed + 1) < bound,
                    "{total} {bound}"
                );
            }
        }
    }

    #[test]
    fn outages_are_counted_in_samples() {
        let run = |constraint: &str| rules(&[constraint], 10);
        for (bound, samples) in [(0, 1), (59, 1), (60, 2), (119, 2), (600, 11), (-5, 1)] {
            let expected = vec![Proof::Run { samples }];
            assert_eq!(
                run(&format!("longest-outage-s <= {bound}")),
                expected,
                "{bound}"
            );
        }
        // Longer than the span: no outage can be.
        assert_eq!(run("longest-outage-s <= 86400"), []);
    }

    #[test]
    fn the_other_side_is_left_to_the_evaluation() {
        let others = [
            "availability <= 0.9",
            "max-pdop >= 2",
            "longest-outage-s >= 60",
            "mean-visible >= 3",
            "j-cost <= 20",
            "least-visible >= 0",
        ];
        assert_eq!(rules(&others, 1000), []);
    }

    #[test]
    fn one_unsolved_sample_is_too_many_for_a_mean() {
        for constraint in [
            "mean-pdop <= 2",
            "cvar-pdop <= 2",
            "max-pdop <= 2",
            "j-pos <= 3",
        ] {
            assert_eq!(allowed(constraint, 205_920), 0, "{constraint}");
        }
        assert_eq!(allowed("p95-pdop <= 2", 205_920), 10_296);
        assert_eq!(allowed("p99-pdop <= 2", 205_920), 2059);
    }
}
