//! Whether a search still moves at its end.

use crate::optimize::Record;
use crate::run::Diagnostic;
use crate::search::Quantity;

/// Relative rise that counts as progress.
const RISE: f64 = 1e-4;

/// Share of the generations without progress from which on it is worth saying.
const IDLE_SHARE: f64 = 1.0 / 3.0;

/// The last share of the generations, and the relative rise in it from which on more of them
/// would help.
const LAST_SHARE: f64 = 0.2;
const LAST_RISE: f64 = 1e-3;

/// Fewer generations than this show nothing.
const FEWEST_GENERATIONS: usize = 5;

/// What a history measures its progress by, rising.
struct Course {
    /// What it is, in words.
    what: String,
    /// How it goes on.
    verb: [&'static str; 2],
    values: Vec<f64>,
    /// What a change is a share of.
    scale: f64,
}

impl Course {
    /// The best value of a single objective, else the hypervolume; the value is `None` before
    /// anything feasible is known.
    fn of(history: &[Record], objectives: &[Quantity]) -> Option<Self> {
        let last = history.last()?;
        if let ([objective], Some(ideal)) = (objectives, &last.ideal) {
            let best = |record: &Record| -record.ideal.as_ref().map_or(f64::INFINITY, |i| i[0]);
            return Some(Self {
                what: format!("best value of {objective}"),
                verb: ["improved", "improved"],
                values: history.iter().map(best).collect(),
                scale: if ideal[0] == 0.0 { 1.0 } else { ideal[0].abs() },
            });
        }
        let volumes = Record::volumes(history);
        let last = (*volumes.last()?)?;
        (last > 0.0).then(|| Self {
            what: "hypervolume".to_owned(),
            verb: ["risen", "rose"],
            values: volumes.iter().map(|v| v.unwrap_or(0.0)).collect(),
            scale: last,
        })
    }
}

/// What the history says about the number of generations.
pub(super) fn of_history(history: &[Record], objectives: &[Quantity]) -> Option<Diagnostic> {
    let Course {
        what,
        verb: [has, did],
        values,
        scale,
    } = Course::of(history, objectives)?;
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
    if idle as f64 > IDLE_SHARE * count as f64 {
        return Some(Diagnostic::new(
            "no-progress",
            format!(
                "the {what} has not {has} by more than {} % in the last {idle} of {count} \
                 generations: more of them will hardly help",
                100.0 * RISE
            ),
        ));
    }
    let tail = ((LAST_SHARE * count as f64).ceil() as usize).max(1);
    let rise = last - values[count - 1 - tail];
    (rise > LAST_RISE * scale).then(|| {
        let by = if rise.is_finite() {
            format!("{did} by {:.2} %", 100.0 * rise / scale)
        } else {
            "was first feasible".to_owned()
        };
        Diagnostic::new(
            "still-improving",
            format!(
                "the {what} {by} in the last {tail} of {count} generations: more of them may help"
            ),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn code(volumes: &[f64]) -> Option<String> {
        let record = |(generation, &volume): (u64, &f64)| Record {
            generation,
            evaluations: 0,
            hypervolume: Some(volume),
            hypervolume_at_chosen: None,
            ideal: None,
            front_size: 1,
            feasible: 1,
            front: Vec::new(),
        };
        let history: Vec<Record> = (1..).zip(volumes).map(record).collect();
        of_history(&history, &[]).map(|d| d.code)
    }

    #[test]
    fn the_end_of_the_history_decides() {
        let rising: Vec<f64> = (1..=10_u8).map(f64::from).collect();
        assert_eq!(code(&rising).as_deref(), Some("still-improving"));
        let mut flat = rising.clone();
        flat.extend([10.0; 6]);
        assert_eq!(code(&flat).as_deref(), Some("no-progress"));
        // Slow but steady: neither idle nor in need of more.
        let steady: Vec<f64> = (0..10_u8).map(|k| 1.0 + 3e-4 * f64::from(k)).collect();
        assert_eq!(code(&steady), None);
        assert_eq!(code(&rising[..4]), None);
        assert_eq!(code(&[0.0; 9]), None);
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
        // From 2.3 to 2.1 in two generations.
        assert!(
            found
                .message
                .contains("best value of max-pdop improved by 9.52 %"),
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
            found.message.contains("was first feasible"),
            "{}",
            found.message
        );
        assert!(told(&[None; 9], Quantity::MaxPdop).is_none());
    }
}
