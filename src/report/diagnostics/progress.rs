//! Whether a search is still improving at its end.

use crate::optimize::Record;
use crate::run::Diagnostic;

/// Relative rise of the hypervolume that counts as progress.
const RISE: f64 = 1e-4;

/// Fraction of the generations without progress above which this is reported.
const IDLE_SHARE: f64 = 1.0 / 3.0;

/// The last fraction of the generations, and the relative rise during it above which more of them
/// would help.
const LAST_SHARE: f64 = 0.2;
const LAST_RISE: f64 = 1e-3;

/// Fewer generations than this are not judged.
const FEWEST_GENERATIONS: usize = 5;

/// Whether the history of the hypervolume calls for more generations.
pub(super) fn of_history(history: &[Record]) -> Option<Diagnostic> {
    let volumes: Vec<f64> = history
        .iter()
        .map(|r| r.hypervolume)
        .collect::<Option<_>>()?;
    let count = volumes.len();
    let last = *volumes.last()?;
    if count < FEWEST_GENERATIONS || last <= 0.0 {
        return None;
    }
    let short = |volume: &f64| last - volume > RISE * last;
    let idle = volumes
        .iter()
        .rev()
        .take_while(|volume| !short(volume))
        .count();
    if idle as f64 > IDLE_SHARE * count as f64 {
        return Some(Diagnostic::new(
            "no-progress",
            format!(
                "the hypervolume rose by less than {} % in the last {idle} of {count} generations; \
                 more generations are unlikely to help",
                100.0 * RISE
            ),
        ));
    }
    let tail = ((LAST_SHARE * count as f64).ceil() as usize).max(1);
    let before = volumes[count - 1 - tail];
    (last - before > LAST_RISE * last).then(|| {
        Diagnostic::new(
            "still-improving",
            format!(
                "the hypervolume still rose by {:.2} % in the last {tail} of {count} generations; \
                 consider more generations",
                100.0 * (last - before) / last
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
            ideal: None,
            front_size: 1,
            feasible: 1,
            front: Vec::new(),
        };
        let history: Vec<Record> = (1..).zip(volumes).map(record).collect();
        of_history(&history).map(|d| d.code)
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
}
