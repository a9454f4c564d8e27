//! Values over time: a line where there are few, and a median with its band where there are many.

use super::{Layer, Style};

/// Most values of a line that a reader can follow.
const MOST: usize = 200;

/// Most parts of the time that have a median and a band each.
const MOST_PARTS: f64 = 100.0;

/// Lengths of a part, hours: round minutes, then hours and days.
const PARTS_H: [f64; 13] = [
    1.0 / 60.0,
    2.0 / 60.0,
    5.0 / 60.0,
    0.25,
    0.5,
    1.0,
    2.0,
    3.0,
    6.0,
    12.0,
    24.0,
    72.0,
    240.0,
];

/// Name and values over time, hours, of one constellation; `None` where there is no value.
pub(super) type Course = (String, Vec<(f64, Option<f64>)>);

/// A part of the time.
struct Part {
    start_h: f64,
    end_h: f64,
    /// Least, median and greatest value; `None` if there is no value.
    values: Option<[f64; 3]>,
}

/// The layers, with the first constellation on top, and what to add to the label of the time.
pub(super) fn layers(courses: &[Course]) -> (Vec<Layer>, String) {
    let most = courses
        .iter()
        .map(|(_, samples)| samples.len())
        .max()
        .unwrap_or(0);
    let ends = courses.iter().filter_map(|(_, samples)| samples.last());
    let end_h = ends.map(|(time, _)| *time).fold(0.0, f64::max);
    let long_enough = |part: &f64| end_h / part <= MOST_PARTS;
    let part_h = PARTS_H
        .into_iter()
        .find(long_enough)
        .unwrap_or(end_h / MOST_PARTS);
    let numbered = || courses.iter().enumerate().rev();
    if most <= MOST {
        let lines = numbered().flat_map(|(n, (name, samples))| {
            let runs = samples.split(|(_, value)| value.is_none());
            let points =
                runs.map(|run| run.iter().filter_map(|(x, y)| Some((*x, (*y)?))).collect());
            named_once(points, name, Style::Line(n))
        });
        return (lines.collect(), String::new());
    }
    let parts: Vec<(usize, &str, Vec<Part>)> = numbered()
        .map(|(n, (name, samples))| (n, name.as_str(), parts(samples, part_h)))
        .collect();
    let is_gap = |part: &Part| part.values.is_none();
    let bands = parts.iter().flat_map(|(n, _, parts)| {
        let runs = parts.split(is_gap).map(band);
        named_once(runs, "", Style::Band(*n))
    });
    let lines = parts.iter().flat_map(|(n, name, parts)| {
        let runs = parts.split(is_gap).map(|run| steps(run, 1));
        named_once(runs, name, Style::Line(*n))
    });
    let length = match part_h {
        h if h < 1.0 => format!("{:.0} min", 60.0 * h),
        h => format!("{} h", crate::units::round_decimal(h, 3)),
    };
    let note = format!("; median and range of {length}");
    (bands.chain(lines).collect(), note)
}

/// A layer for each run of points, of which the first has the name.
fn named_once(runs: impl Iterator<Item = Vec<(f64, f64)>>, name: &str, style: Style) -> Vec<Layer> {
    let runs = runs.filter(|points| !points.is_empty()).enumerate();
    let layer = |(n, points): (usize, Vec<(f64, f64)>)| Layer {
        name: if n == 0 {
            name.to_owned()
        } else {
            String::new()
        },
        points,
        style,
    };
    runs.map(layer).collect()
}

fn parts(samples: &[(f64, Option<f64>)], part_h: f64) -> Vec<Part> {
    let number = |time_h: f64| (time_h / part_h + 1e-9).floor();
    let chunks = samples.chunk_by(|a, b| number(a.0) == number(b.0));
    let part = |chunk: &[(f64, Option<f64>)]| {
        let start_h = number(chunk[0].0) * part_h;
        let mut values: Vec<f64> = chunk.iter().filter_map(|(_, value)| *value).collect();
        values.sort_unstable_by(f64::total_cmp);
        let count = values.len();
        let summary = (count > 0).then(|| {
            let median = 0.5 * (values[(count - 1) / 2] + values[count / 2]);
            [values[0], median, values[count - 1]]
        });
        Part {
            start_h,
            end_h: start_h + part_h,
            values: summary,
        }
    };
    chunks.map(part).collect()
}

/// The n-th value of each part as steps.
fn steps(parts: &[Part], n: usize) -> Vec<(f64, f64)> {
    let step = |part: &Part| {
        let value = part.values.map(|values| values[n]);
        value.map(|value| [(part.start_h, value), (part.end_h, value)])
    };
    parts.iter().filter_map(step).flatten().collect()
}

/// The closed line around the least and the greatest values.
fn band(parts: &[Part]) -> Vec<(f64, f64)> {
    let above = steps(parts, 2).into_iter().rev();
    steps(parts, 0).into_iter().chain(above).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_values_are_a_median_in_a_band_and_gaps_stay_gaps() {
        let sample = |n: u32| {
            let time = f64::from(n) / 60.0;
            (time, (n / 60 != 3).then_some(f64::from(n % 15)))
        };
        let courses = [("it".to_owned(), (0..1440).map(sample).collect::<Vec<_>>())];
        let (layers, note) = layers(&courses);
        assert_eq!(note, "; median and range of 15 min");
        // Two bands and two lines around the hour without a value.
        let styles: Vec<Style> = layers.iter().map(|layer| layer.style).collect();
        assert_eq!(
            styles,
            [
                Style::Band(0),
                Style::Band(0),
                Style::Line(0),
                Style::Line(0)
            ]
        );
        assert_eq!(layers[2].points[..2], [(0.0, 7.0), (0.25, 7.0)]);
        assert_eq!(layers[2].points.last(), Some(&(3.0, 7.0)));
        assert_eq!(layers[0].points.len(), 4 * 12);
        assert_eq!(
            (layers[2].name.as_str(), layers[3].name.as_str()),
            ("it", "")
        );
    }

    #[test]
    fn few_values_are_a_line_and_none_are_nothing() {
        let few = [(
            "it".to_owned(),
            vec![(0.0, Some(1.0)), (1.0, None), (2.0, Some(3.0))],
        )];
        assert_eq!(layers(&few).0.len(), 2);
        assert!(
            layers(&[("it".to_owned(), vec![(0.0, None); 300])])
                .0
                .is_empty()
        );
        assert!(layers(&[]).0.is_empty());
    }
}
