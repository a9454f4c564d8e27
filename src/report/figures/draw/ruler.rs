//! The ends and the ticks of an axis.

use crate::report::figures::{Axis, AxisScale};

/// Share of an axis left free on either side of the data.
const MARGIN: f64 = 0.04;

/// Fewer decades than these have ticks between the powers of ten.
const FEW_DECADES: f64 = 2.0;

/// An axis ready to be drawn, where values are at their own place or at that of their logarithm.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ruler {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Labelled places.
    pub(super) ticks: Vec<f64>,
    /// Places without a label.
    pub(super) minor: Vec<f64>,
    labels: Labels,
    scale: AxisScale,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Labels {
    /// With so many decimals.
    Decimals(usize),
    /// In units of a power of ten.
    Scientific(i32, usize),
    /// As powers of ten.
    Powers,
    /// Shortest, of a value whose logarithm is the place.
    Plain,
}

impl Ruler {
    /// The axis for some values with at most about so many ticks; `is_tight` if it ends at the data.
    pub(super) fn new(
        axis: &Axis,
        values: impl Iterator<Item = f64>,
        most_ticks: usize,
        is_tight: bool,
    ) -> Self {
        let place = |value: f64| match axis.scale {
            AxisScale::Linear => value,
            AxisScale::Log => value.max(f64::MIN_POSITIVE).log10(),
        };
        let [low, high] = match axis.range {
            Some(range) => range.map(place),
            None => {
                let margin = if is_tight { 0.0 } else { MARGIN };
                ends(values.filter(|x| x.is_finite()).map(place), margin)
            }
        };
        let (low, high) = widened(low, high);
        match axis.scale {
            AxisScale::Log => Self::log(low, high, most_ticks),
            AxisScale::Linear => Self::linear(low, high, most_ticks, axis.is_whole),
        }
    }

    fn linear(low: f64, high: f64, most_ticks: usize, is_whole: bool) -> Self {
        let mut step = nice_step((high - low) / most_ticks.max(2) as f64);
        if is_whole {
            step = step.max(1.0).round();
        }
        let largest = low.abs().max(high.abs());
        let exponent = largest.max(f64::MIN_POSITIVE).log10().floor() as i32;
        let decimals = |step: f64| (-(step * 1.000_001).log10().floor()).clamp(0.0, 15.0) as usize;
        let labels = if (-4..=6).contains(&exponent) {
            Labels::Decimals(decimals(step))
        } else {
            Labels::Scientific(exponent, decimals(step / 10_f64.powi(exponent)))
        };
        Self {
            low,
            high,
            ticks: multiples(step, low, high),
            minor: Vec::new(),
            labels,
            scale: AxisScale::Linear,
        }
    }

    fn log(low: f64, high: f64, most_ticks: usize) -> Self {
        let decades = high - low;
        let within = |tick: &f64| (low - 1e-9..=high + 1e-9).contains(tick);
        let powers = || low.floor() as i32..=high.ceil() as i32;
        let between = |digits: &'static [u32]| {
            powers().flat_map(move |power| {
                let at = move |digit: &u32| f64::from(*digit).log10() + f64::from(power);
                digits.iter().map(at)
            })
        };
        let (ticks, labels): (Vec<f64>, _) = if decades >= FEW_DECADES {
            let every = (decades / most_ticks.max(2) as f64).ceil().max(1.0) as i32;
            let ticks = powers().filter(|power| power.rem_euclid(every) == 0);
            (
                ticks.map(f64::from).filter(within).collect(),
                Labels::Powers,
            )
        } else {
            let ticks: Vec<f64> = between(&[1, 2, 5]).filter(within).collect();
            if ticks.len() >= 3 {
                (ticks, Labels::Plain)
            } else {
                let (low, high) = (10_f64.powf(low), 10_f64.powf(high));
                let step = nice_step((high - low) / most_ticks.max(2) as f64);
                let ticks = multiples(step, low, high).into_iter();
                let logs = ticks.filter(|x| *x > 0.0).map(f64::log10).collect();
                (logs, Labels::Plain)
            }
        };
        let minor = between(&[2, 3, 4, 5, 6, 7, 8, 9]).filter(within);
        Self {
            low,
            high,
            ticks,
            minor: if decades <= 8.0 {
                minor.collect()
            } else {
                Vec::new()
            },
            labels,
            scale: AxisScale::Log,
        }
    }

    /// Where a value is.
    pub(super) fn place(&self, value: f64) -> f64 {
        match self.scale {
            AxisScale::Linear => value,
            AxisScale::Log => value.max(f64::MIN_POSITIVE).log10(),
        }
    }

    /// Where a value is, as a share of the axis.
    pub(super) fn share(&self, value: f64) -> f64 {
        (self.place(value) - self.low) / (self.high - self.low)
    }

    /// The label at a place.
    pub(super) fn label(&self, place: f64) -> String {
        let text = match self.labels {
            Labels::Decimals(decimals) => format!("{place:.decimals$}"),
            Labels::Scientific(exponent, decimals) => {
                let mantissa = place / 10_f64.powi(exponent);
                if mantissa == 0.0 {
                    return "0".to_owned();
                }
                format!("{mantissa:.decimals$}×10^{{{exponent}}}")
            }
            Labels::Powers => format!("10^{{{}}}", place.round()),
            Labels::Plain => {
                let value = 10_f64.powf(place);
                let decimals = (3.0 - place.floor()).clamp(0.0, 12.0) as usize;
                crate::units::round_decimal(value, decimals).to_string()
            }
        };
        // A minus sign, not a hyphen.
        text.replace('-', "\u{2212}")
    }
}

/// Least and greatest place with a margin; [0, 1] without values.
fn ends(places: impl Iterator<Item = f64>, margin: f64) -> [f64; 2] {
    let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    if low > high {
        return [0.0, 1.0];
    }
    let free = margin * (high - low);
    [low - free, high + free]
}

/// An axis of one value has some room around it.
fn widened(low: f64, high: f64) -> (f64, f64) {
    let least = 1e-9 * low.abs().max(high.abs());
    if high - low > least {
        return (low, high);
    }
    let room = if low == 0.0 { 0.5 } else { 0.05 * low.abs() };
    (low - room, high + room)
}

/// The step of 1, 2 or 5 times a power of ten that is not smaller.
fn nice_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
    let found = steps.into_iter().find(|step| *step >= least * (1.0 - 1e-9));
    found.unwrap_or(10.0 * power)
}

/// The multiples of a step between two values.
fn multiples(step: f64, low: f64, high: f64) -> Vec<f64> {
    let slack = 1e-9 * (high - low);
    let first = ((low - slack) / step).ceil() as i64;
    let last = ((high + slack) / step).floor() as i64;
    (first..=last).map(|n| n as f64 * step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, values: &[f64]) -> Vec<String> {
        let ruler = Ruler::new(axis, values.iter().copied(), 6, false);
        ruler.ticks.iter().map(|tick| ruler.label(*tick)).collect()
    }

    #[test]
    fn ticks_are_round_and_powers_of_ten_are_powers() {
        let log = Axis {
            scale: AxisScale::Log,
            ..Axis::default()
        };
        assert_eq!(
            labels(&Axis::share(""), &[]),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(labels(&Axis::default(), &[-1.0, 1.0])[0], "\u{2212}1.0");
        assert_eq!(
            labels(&log, &[0.001, 1e13]),
            [
                "10^{\u{2212}3}",
                "10^{0}",
                "10^{3}",
                "10^{6}",
                "10^{9}",
                "10^{12}"
            ]
        );
        assert_eq!(labels(&log, &[1.5, 60.0]), ["2", "5", "10", "20", "50"]);
        assert_eq!(labels(&log, &[1.51, 1.83]).len(), 4);
        assert_eq!(labels(&Axis::default(), &[0.0, 2.5e9])[1], "0.5×10^{9}");
    }

    #[test]
    fn degenerate_values_have_an_axis() {
        for values in [&[][..], &[0.0], &[7.0, 7.0], &[1e-300], &[-1e300, 1e300]] {
            for scale in [AxisScale::Linear, AxisScale::Log] {
                let axis = Axis {
                    scale,
                    ..Axis::default()
                };
                let ruler = Ruler::new(&axis, values.iter().copied(), 6, false);
                assert!(ruler.high > ruler.low, "{values:?}");
                assert!(ruler.ticks.len() <= 40, "{values:?}");
            }
        }
    }
}
