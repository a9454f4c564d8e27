//! Whether a search is still improving at its end.

use crate::optimize::Record;
use crate::run::Diagnostic;
use crate::search::Quantity;

/// Relative rise that counts as progress.
const RISE: f64 = 1e-4;

/// Fraction of the generations without progress above which this is reported.
const IDLE_SHARE: f64 = 1.0 / 3.0;

/// The last fraction of the generations, and the relative rise during it above which more of them
/// would help.
const LAST_SHARE: f64 = 0.2;
const LAST_RISE: f64 = 1e-3;

/// Minimum number of generations for these diagnostics.
const FEWEST_GENERATIONS: usize = 5;

/// The measure of progress in a history: the best value so far, which never falls.
struct SearchCourse {
    /// Its name.
    what: String,
    /// The verb of its progress, in the past tense.
    verb: &'static str,
    values: Vec<f64>,
    /// The value to which a change is relative.
    scale: f64,
}

impl SearchCourse {
    /// The best value of a single objective, otherwise the hypervolume; `None` until something
    /// feasible is known.
    fn of(history: &[Record], objectives: &[Quantity]) -> Option<Self> {
        let last = history.last()?;
        if let ([objective], Some(ideal)) = (objectives, &last.ideal) {
            let best = |record: &Record| -record.ideal.as_ref().map_or(f64::INFINITY, |i| i[0]);
            return Some(Self {
                what: format!("best value of {objective}"),
                verb: "improved",
                values: best_so_far(history.iter().map(best)),
                scale: if ideal[0] == 0.0 { 1.0 } else { ideal[0].abs() },
            });
        }
        let volumes = Record::volumes(history);
        let values = best_so_far(volumes.iter().map(|v| v.unwrap_or(0.0)));
        let scale = *values.last()?;
        (scale > 0.0).then(|| Self {
            what: "best hypervolume so far".to_owned(),
            verb: "rose",
            values,
            scale,
        })
    }
}

/// The running maximum.
fn best_so_far(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let best = |best: &mut f64, value: f64| {
        *best = best.max(value);
        Some(*best)
    };
    values.scan(f64::NEG_INFINITY, best).collect()
}

/// Whether the last population has lost hypervolume that an earlier one had.
pub(super) fn lost_volume(history: &[Record], objectives: &[Quantity]) -> Option<Diagnostic> {
    if objectives.len() == 1 {
        return None;
    }
    let volumes: Vec<f64> = Record::volumes(history)
        .into_iter()
        .map(|v| v.unwrap_or(0.0))
        .collect();
    let (generation, best) = (1..)
        .zip(&volumes)
        .max_by(|a: &(u64, _), b| a.1.total_cmp(b.1))?;
    let last = volumes.last()?;
    let lost = (best - last) / best;
    (*best > 0.0 && lost > LAST_RISE).then(|| {
        Diagnostic::new(
            "lost-volume",
            format!(
                "the hypervolume is {:.2} % below that of generation {generation}; a larger population loses \
                 less",
                100.0 * lost
            ),
        )
    })
}

/// Whether the history calls for more generations.
pub(super) fn of_history(history: &[Record], objectives: &[Quantity]) -> Option<Diagnostic> {
    let SearchCourse {
        what,
        verb,
        values,
        scale,
    } = SearchCourse::of(history, objectives)?;
    let count = values.len();
    let last = *values.last()?;
    if count < FEWEST_GENERATIONS {
        return None;
    }
    let idle = values
        .iter()
        .rev()
        .take_while(|value| last - **value <= RISE * scale)
        .count();
    if idle == count {
        return Some(Diagnostic::new(
            "no-progress",
            format!(
                "the {what} has been that of the first generation, within {} %, for all {count} \
                 generations",
                100.0 * RISE
            ),
        ));
    }
    if idle as f64 > IDLE_SHARE * count as f64 {
        return Some(Diagnostic::new(
            "no-progress",
            format!(
                "the {what} {verb} by at most {} % in the last {idle} of {count} generations; more \
                 generations are unlikely to help",
                100.0 * RISE
            ),
        ));
    }
    let tail = ((LAST_SHARE * count as f64).ceil() as usize).max(1);
    let rise = last - values[count - 1 - tail];
    (rise > LAST_RISE * scale).then(|| {
        let before = values[count - 1 - tail];
        let event = if !rise.is_finite() {
            "the first feasible design was found".to_owned()
        } else if before == 0.0 {
            format!("the {what} still {verb} from 0")
        } else {
            format!(
                "the {what} still {verb} by {:.2} %",
                100.0 * rise / before.abs()
            )
        };
        Diagnostic::new(
            "still-improving",
            format!("{event} in the last {tail} of {count} generations; consider more generations"),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_volume(generation: u64, volume: f64) -> Record {
        Record {
            hypervolume: Some(volume),
            ..record(generation, None)
        }
    }

    fn code(volumes: &[f64]) -> Option<String> {
        let history: Vec<Record> = (1..).zip(volumes).map(|(g, v)| of_volume(g, *v)).collect();
        of_history(&history, &[]).map(|d| d.code)
    }

    #[test]
    fn the_end_of_the_history_decides() {
        let rising: Vec<f64> = (1..=10_u8).map(f64::from).collect();
        assert_eq!(code(&rising).as_deref(), Some("still-improving"));
        let mut flat = rising.clone();
        flat.extend([10.0; 6]);
        assert_eq!(code(&flat).as_deref(), Some("no-progress"));
        // Slow but steady: neither stalled nor in need of more.
        let steady: Vec<f64> = (0..10_u8).map(|k| 1.0 + 3e-4 * f64::from(k)).collect();
        assert_eq!(code(&steady), None);
        assert_eq!(code(&rising[..4]), None);
        assert_eq!(code(&[0.0; 9]), None);
    }

    /// A falling volume is not progress, and the loss is reported.
    #[test]
    fn a_falling_volume_is_reported() {
        let volumes = [1.0, 6.0, 10.0, 9.5, 9.0, 8.0, 8.0, 7.5];
        assert_eq!(code(&volumes).as_deref(), Some("no-progress"));
        let history: Vec<Record> = (1..).zip(volumes).map(|(g, v)| of_volume(g, v)).collect();
        let lost = lost_volume(&history, &[]).unwrap();
        assert!(
            lost.message.contains("25.00 % below that of generation 3"),
            "{}",
            lost.message
        );
        assert!(lost_volume(&history[..3], &[]).is_none());
    }

    fn record(generation: u64, best: Option<f64>) -> Record {
        Record {
            generation,
            evaluations: 0,
            hypervolume: None,
            hypervolume_at_chosen: None,
            ideal: best.map(|best| vec![best]),
            front_size: 1,
            feasible: 1,
            front: Vec::new(),
        }
    }

    #[test]
    fn one_objective_is_told_by_its_best_value() {
        let told = |best: &[Option<f64>], objective| {
            let history: Vec<Record> = (1..).zip(best).map(|(g, b)| record(g, *b)).collect();
            of_history(&history, &[objective])
        };
        let mut falling: Vec<Option<f64>> = (0..10_u8)
            .map(|k| Some(3.0 - f64::from(k) / 10.0))
            .collect();
        let found = told(&falling, Quantity::MaxPdop).unwrap();
        assert_eq!(found.code, "still-improving");
        // From 2.3 to 2.1 in two generations: 0.2 of 2.3.
        assert!(
            found
                .message
                .contains("best value of max-pdop still improved by 8.70 %"),
            "{}",
            found.message
        );
        falling.extend([Some(2.1); 6]);
        assert_eq!(
            told(&falling, Quantity::MaxPdop).unwrap().code,
            "no-progress"
        );
        // What is maximised is negative here.
        let seen: Vec<Option<f64>> = (1..=10_u8).map(|k| Some(-f64::from(k))).collect();
        assert_eq!(
            told(&seen, Quantity::MeanVisible).unwrap().code,
            "still-improving"
        );
        let late = [None, None, None, None, None, Some(2.0)];
        let found = told(&late, Quantity::MaxPdop).unwrap();
        assert!(
            found.message.contains("first feasible design"),
            "{}",
            found.message
        );
        assert!(told(&[None; 9], Quantity::MaxPdop).is_none());
    }
}
