//! The tables of `--series` and the figures beside them, as typed: what they say of one another.

use crate::cli::ran;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Points at 60° N and, as one place, at the pole; outages of a PDOP above 2.
const STUDY: &str = "--design delta:55:60/6/1@925 --set region.latitude-deg=[60,90] --set region.longitude-deg=[0,120] \
    --set region.step-deg=30 --set time.duration-h=3 --set gnss.constellations=['gps'] --set objectives.availability-pdop=2";

/// The standard output of a command on the study.
fn done(place: &Path, command: &str) -> String {
    let (verb, rest) = command.split_once(' ').unwrap();
    let typed = format!("{verb} {STUDY} {rest}");
    let ran = ran(place, &typed.split_whitespace().collect::<Vec<_>>());
    assert_eq!(ran.status, 0, "{command}: {}", ran.stderr);
    ran.stdout
}

/// A table by column.
fn table(text: &str) -> BTreeMap<String, Vec<String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names: Vec<String> = reader
        .headers()
        .unwrap()
        .iter()
        .map(str::to_owned)
        .collect();
    let mut columns: BTreeMap<String, Vec<String>> = names
        .iter()
        .map(|name| (name.clone(), Vec::new()))
        .collect();
    for row in reader.records() {
        for (name, cell) in names.iter().zip(row.unwrap().iter()) {
            columns.get_mut(name).unwrap().push(cell.to_owned());
        }
    }
    columns
}

fn numbers(table: &BTreeMap<String, Vec<String>>, column: &str) -> Vec<f64> {
    table[column]
        .iter()
        .map(|cell| cell.parse().unwrap())
        .collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The same quantities in four tables: outages by point add up to those of the point, the histogram to the mean, coverage by
/// instant to coverage by point; a point is written alike in all.
#[test]
fn tables_of_a_series_agree() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    done(place, "evaluate --quiet --series s");
    let read = |name: &str| table(&fs::read_to_string(place.join("s").join(name)).unwrap());
    let (epochs, points) = (read("epochs.csv"), read("points.csv"));
    let (histogram, outages) = (read("histogram.csv"), read("outages.csv"));
    assert_eq!((epochs["elapsed_s"].len(), points["name"].len()), (180, 10));

    // Equal weights; fractions of 1800 samples are sums of as many roundings.
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
    for n in [1, 4, 12] {
        let coverage = |of| mean(&numbers(of, &format!("coverage_{n}")));
        near(coverage(&epochs), coverage(&points));
        let at_least = |column: &str| numbers(&histogram, column)[n..].iter().sum::<f64>();
        near(at_least("leo"), coverage(&points));
        near(
            at_least("all"),
            mean(&numbers(&points, &format!("coverage_total_{n}"))),
        );
    }
    for (column, of_points) in [
        ("leo", "mean_visible"),
        ("gnss", "mean_gnss_visible"),
        ("all", "mean_total_visible"),
    ] {
        let shares = numbers(&histogram, column);
        near(shares.iter().sum(), 1.0);
        let count = shares.iter().enumerate().map(|(n, share)| n as f64 * share);
        near(count.sum(), mean(&numbers(&points, of_points)));
    }

    // A place is written in the same characters in both tables.
    let place_of = |table: &BTreeMap<String, Vec<String>>, row: usize| {
        ["latitude_deg", "longitude_deg"].map(|column| table[column][row].clone())
    };
    let mut lengths: BTreeMap<[String; 2], Vec<f64>> = BTreeMap::new();
    for (row, length_s) in numbers(&outages, "length_s").into_iter().enumerate() {
        lengths
            .entry(place_of(&outages, row))
            .or_default()
            .push(length_s);
    }
    let (count, longest_s) = (
        numbers(&points, "outages"),
        numbers(&points, "longest_outage_s"),
    );
    let (total_s, availability) = (
        numbers(&points, "total_outage_s"),
        numbers(&points, "availability"),
    );
    for row in 0..10 {
        let of_point = &lengths[&place_of(&points, row)];
        assert_eq!(of_point.len() as f64, count[row]);
        assert_eq!(of_point.iter().copied().fold(0.0, f64::max), longest_s[row]);
        assert_eq!(of_point.iter().sum::<f64>(), total_s[row]);
        near(availability[row], 1.0 - total_s[row] / 10_800.0);
    }
    assert_eq!(lengths.len(), 10);
}

/// The figures of what users measure, and their tables: a row for the pole and not one for each of its points.
#[test]
fn figures_of_views_and_outages_are_drawn() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let timeline = table(&done(place, "plot --figure timeline --as csv"));
    let poles = timeline["latitude_deg"]
        .iter()
        .zip(&timeline["longitude_deg"]);
    let poles: BTreeSet<&String> = poles
        .filter_map(|(latitude, longitude)| (latitude == "90").then_some(longitude))
        .collect();
    assert_eq!(poles.len(), 1, "{poles:?}");
    assert_eq!(
        timeline["latitude_deg"]
            .iter()
            .collect::<BTreeSet<_>>()
            .len(),
        2
    );

    let svg = done(place, "plot --figure timeline");
    assert!(svg.contains("Outages: delta:55:60/6/1@925"), "{svg}");
    assert_eq!(svg.matches("\n90°, ").count(), 1);

    // Without an outage the figure is empty and says so.
    let none = "plot --set objectives.availability-pdop=99 --figure timeline";
    let svg = done(place, none);
    assert!(
        svg.contains("No point has an outage: delta:55:60/6/1@925"),
        "{svg}"
    );
    assert_eq!(done(place, &format!("{none} --as csv")).lines().count(), 1);

    let histogram = table(&done(place, "plot --figure histogram --as csv"));
    let shares = numbers(&histogram, "leo");
    assert!(
        (shares.iter().sum::<f64>() - 1.0).abs() < 1e-12,
        "{shares:?}"
    );
    for (figure, measure) in [
        ("map", "longest-outage-s"),
        ("map", "coverage-4"),
        ("cdf", "gain-mean-pdop"),
        ("series", "coverage-2"),
    ] {
        let plot = format!("plot --figure {figure} --measure {measure}");
        let data = done(place, &format!("{plot} --as csv"));
        assert!(data.lines().count() > 5, "{plot}: {data}");
        assert!(done(place, &plot).starts_with("<svg"), "{plot}");
    }
}
