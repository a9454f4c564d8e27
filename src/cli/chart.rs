//! A small chart of a front for the terminal, in braille dots.

use crate::run::OptimizeResult;
use textplots::{Chart, Plot, Shape};

/// Dots of the chart: two to a column, four to a row.
const WIDTH: u32 = 120;
const HEIGHT: u32 = 44;

/// Fewer members are easier to read in the table.
const FEWEST: usize = 5;

/// The front in the plane of its first two objectives, the first along the horizontal axis; `None`
/// if there is too little to see.
pub(crate) fn front(result: &OptimizeResult) -> Option<String> {
    let plane = |n: usize| -> Option<Vec<f32>> {
        let values = result
            .front
            .iter()
            .map(|m| Some(m.objectives.get(n)?.1 as f32));
        values.collect()
    };
    let (across, up) = (plane(0)?, plane(1)?);
    if across.len() < FEWEST {
        return None;
    }
    let (left, right) = ends(&across)?;
    let (bottom, top) = ends(&up)?;
    let points: Vec<(f32, f32)> = across.into_iter().zip(up).collect();
    let dots = Shape::Points(&points);
    let mut chart = Chart::new_with_y_range(WIDTH, HEIGHT, left, right, bottom, top);
    let chart = chart.lineplot(&dots);
    chart.axis();
    chart.figures();
    let names = &result.front.first()?.objectives;
    Some(format!("{} over {}\n{chart}", names[1].0, names[0].0))
}

/// The smallest and the largest value with a margin, which does not go below 0 where no value does; `None` if they
/// are equal.
fn ends(values: &[f32]) -> Option<(f32, f32)> {
    let lo = values.iter().copied().fold(f32::INFINITY, f32::min);
    let hi = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let margin = 0.05 * (hi - lo);
    let floor = if lo < 0.0 { f32::NEG_INFINITY } else { 0.0 };
    (hi > lo).then_some(((lo - margin).max(floor), hi + margin))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No count is negative, so that no axis of counts begins below 0.
    #[test]
    fn a_margin_stays_where_values_can_be() {
        assert_eq!(ends(&[0.0, 20.0]), Some((0.0, 21.0)));
        assert_eq!(ends(&[10.0, 30.0]), Some((9.0, 31.0)));
        assert_eq!(ends(&[-10.0, 10.0]), Some((-11.0, 11.0)));
        assert_eq!(ends(&[5.0, 5.0]), None);
    }
}
