//! What a user asks of the axis of a measure.

use super::{Axis, AxisScale, Chart, FigureError, MeasureAxis};

/// The axis of the measure, or the scale of its colours, as asked for.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AxisChoice {
    /// Whether values are spread by their logarithms.
    pub is_log: bool,
    /// Its ends.
    pub range: Option<[f64; 2]>,
    /// The percentile of the values at which it ends.
    pub clip_percentile: Option<f64>,
}

impl AxisChoice {
    /// Gives a chart this axis.
    ///
    /// # Errors
    /// If the chart has no such axis, or its values do not allow it.
    pub fn apply(&self, chart: &mut Chart) -> Result<(), FigureError> {
        if *self == Self::default() {
            return Ok(());
        }
        let (axis, mut values) = match chart {
            Chart::Map(chart) => {
                let values = chart.cells.iter().filter_map(|cell| cell.2);
                (&mut chart.colours, values.collect::<Vec<f64>>())
            }
            Chart::Plane(chart) => {
                let points = chart.layers.iter().flat_map(|layer| &layer.points);
                match chart.measure {
                    MeasureAxis::X => (&mut chart.x, points.map(|point| point.0).collect()),
                    MeasureAxis::Y => (&mut chart.y, points.map(|point| point.1).collect()),
                    MeasureAxis::Neither => return Err(no_axis()),
                }
            }
            _ => return Err(no_axis()),
        };
        values.sort_unstable_by(f64::total_cmp);
        self.set(axis, &values)
    }

    /// Sets the axis of some values, which rise.
    fn set(&self, axis: &mut Axis, values: &[f64]) -> Result<(), FigureError> {
        let least = values.first().copied().unwrap_or(1.0);
        if self.is_log {
            let from = self.range.map_or(least, |[from, _]| from);
            if from <= 0.0 {
                return Err(FigureError::Axis(format!(
                    "a logarithmic axis needs values above 0, and this one begins at {from}; give another with --range"
                )));
            }
            axis.scale = AxisScale::Log;
        }
        if let Some(range) = self.range {
            axis.range = Some(range);
        }
        if let Some(percentile) = self.clip_percentile {
            let from = axis.range.map_or(least, |[from, _]| from);
            let last = values.len().saturating_sub(1);
            let at = (percentile / 100.0 * last as f64).round() as usize;
            let to = values.get(at.min(last)).copied().unwrap_or(from);
            axis.range = Some([from, to.max(from)]);
        } else if self.is_log && self.range.is_none() {
            // The range of probabilities begins at 0.
            axis.range = None;
        }
        Ok(())
    }
}

fn no_axis() -> FigureError {
    FigureError::Axis(
        "--log, --range and --clip-percentile are of the figures map, cdf, series, phases and failures".to_owned(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_a_percentile_and_a_logarithm_set_the_axis() {
        let values: Vec<f64> = (1..=101).map(f64::from).collect();
        let set = |choice: AxisChoice, values: &[f64]| {
            let mut axis = Axis::default();
            choice
                .set(&mut axis, values)
                .map(|()| (axis.scale, axis.range))
        };
        let percentile = AxisChoice {
            clip_percentile: Some(95.0),
            ..AxisChoice::default()
        };
        assert_eq!(set(percentile, &values).unwrap().1, Some([1.0, 96.0]));
        let log = AxisChoice {
            is_log: true,
            ..AxisChoice::default()
        };
        assert_eq!(set(log, &values).unwrap(), (AxisScale::Log, None));
        assert!(set(log, &[0.0, 1.0]).is_err());
        let from = AxisChoice {
            range: Some([0.1, 5.0]),
            ..log
        };
        assert_eq!(set(from, &[0.0, 1.0]).unwrap().1, Some([0.1, 5.0]));
        assert!(set(percentile, &[]).is_ok());
    }
}
