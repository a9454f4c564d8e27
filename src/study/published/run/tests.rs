use super::*;
use crate::study::judge::Expected;
use crate::study::published::{builtin_studies, builtin_study};

fn no_files(_: &str) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

fn run(text: &str, overrides: &[&str]) -> Result<JudgedStudy, StudyRunError> {
    let study = PublishedStudy::parse("study.toml", text).unwrap();
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    study.run(&overrides, &no_files)
}

/// A study of two points, with the metric and the number to be filled in.
fn study(statements: &str) -> String {
    format!(
        "name = \"small\"\ntitle = \"t\"\nsource = \"s\"\n[scenario]\ntime = {{ duration-h = 2, step-s = 600 }}\n\
         region = {{ latitude-deg = [10, 40], longitude-deg = [100, 100], step-deg = 30 }}\n\
         gnss = {{ constellations = [\"gps\"] }}\n{statements}"
    )
}

fn one(metric: &str, rest: &str) -> String {
    study(&format!(
        "[[statement]]\nname = \"n\"\nmetric = \"{metric}\"\nsource = \"p\"\n{rest}"
    ))
}

fn first(text: &str) -> JudgedStatement {
    run(text, &[]).unwrap().statements[0].clone()
}

#[test]
fn every_built_in_study_is_read_and_named() {
    for name in builtin_studies() {
        let text = builtin_study(name).unwrap();
        let study = PublishedStudy::parse(name, text).unwrap();
        assert_eq!(study.name, name);
        assert!(
            text.lines().filter(|line| !line.trim().is_empty()).count() < 80,
            "{name}"
        );
    }
    let unknown = builtin_study("gps").unwrap_err().to_string();
    assert!(unknown.contains("gps-sps"), "{unknown}");
}

/// A quantile that no summary has is one of the same samples: between those beside it, and that of the summary at its
/// level.
#[test]
fn quantiles_of_any_level_are_of_the_same_samples() {
    let value = |metric: &str| {
        let rest = "at-least = 0\n";
        first(&one(metric, rest)).statement.ours.unwrap()
    };
    let [p50, p90, p95, max] = ["p50-hdop", "p90-hdop", "p95-hdop", "max-hdop"].map(value);
    assert!(
        p50 < p90 && p90 < p95 && p95 <= max,
        "{p50} {p90} {p95} {max}"
    );
    // Above the last but one of 26 samples there is only the largest, f32 in the summary.
    assert!((value("p99.9-hdop") - max).abs() < 1e-6 * max);
    assert!((value("p95.0001-hdop") - p95).abs() < 1e-6 * p95);
}

#[test]
fn validate_the_rates_of_an_orbit() {
    let text = "of = \"delta:98.208:1/1/0@704.963\"\nexpected = 0.985647\ntolerance = 6e-5\n";
    assert_eq!(
        first(&one("nodal-rate-deg-per-day", text))
            .statement
            .verdict,
        Verdict::Met
    );
    // 2 pi sqrt(a³/mu) by hand: a = 7378.137 km, 105.1187 min.
    let text = "of = \"delta:55:1/1/0@1000\"\nexpected = 105.1187\ntolerance = 1e-4\n";
    assert_eq!(
        first(&one("kepler-period-min", text)).statement.verdict,
        Verdict::Met
    );
    let two = "of = \"delta:55:1/1/0@1000+delta:55:1/1/0@900\"\nat-least = 0\n";
    let error = run(&one("kepler-period-min", two), &[])
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("kepler-period-min is of one shell"),
        "{error}"
    );
}

/// A number that is far off is not met, one that is within its tolerance under an assumption is met there, and one from
/// memory gates nothing.
#[test]
fn verdicts_are_those_of_the_numbers() {
    let found = first(&one("mean-gnss-visible", "at-least = 0\n"))
        .statement
        .ours
        .unwrap();
    let number = |shift: f64, rest: &str| {
        let text = format!("expected = {}\ntolerance = 0.01\n{rest}", found + shift);
        first(&one("mean-gnss-visible", &text))
    };
    assert_eq!(number(0.009, "").statement.verdict, Verdict::Met);
    let off = number(0.011, "");
    assert_eq!(off.statement.verdict, Verdict::NotMet);
    assert!(off.is_unexpected());
    assert!(!number(0.011, "disagreement = \"why\"\n").is_unexpected());
    let from_memory = number(5.0, "confirmed = false\n");
    assert_eq!(from_memory.statement.verdict, Verdict::Unconfirmed);
    assert_eq!(from_memory.statement.ours, Some(found));
    assert!(!from_memory.is_unexpected());
    assert_eq!(
        number(0.0, "fitted = true\n").statement.verdict,
        Verdict::Fitted
    );
    let lower = "scenario = { visibility = { gnss-mask-deg = 0 } }\n";
    let other = first(&one("mean-gnss-visible", &format!("at-least = 0\n{lower}")));
    let there = other.statement.ours.unwrap();
    assert!(there > found + 0.1);
    let assumed = format!(
        "expected = {there}\ntolerance = 0.01\n[[assumption]]\nname = \"down to the horizon\"\n{lower}"
    );
    let judged = first(&one("mean-gnss-visible", &assumed)).statement;
    assert_eq!(judged.verdict, Verdict::MetUnderAssumption);
    assert_eq!(judged.assumption.as_deref(), Some("down to the horizon"));
    assert_eq!((judged.ours, judged.ours_there), (Some(found), Some(there)));
    assert!(matches!(judged.expected, Expected::Value { .. }));
}

#[test]
fn what_is_wrong_in_a_scenario_is_told_by_its_key() {
    let text = one(
        "mean-visible",
        "at-least = 0\nscenario = { time = { stp-s = 60 } }\n",
    );
    let error = run(&text, &[]).unwrap_err().to_string();
    assert!(
        error.starts_with(
            "study small: scenario.time.stp-s: unknown key, did you mean `time.step-s`?"
        ),
        "{error}"
    );
    let error = run(&one("mean-visible", "at-least = 0\n"), &["time.step-s=0"]);
    let error = error.unwrap_err().to_string();
    assert!(
        error.starts_with("--set time.step-s=0: time.step-s: found 0"),
        "{error}"
    );
    let error = run(&one("mean-visible", "of = \"irdium\"\nat-least = 0\n"), &[]);
    let error = error.unwrap_err().to_string();
    assert!(
        error.starts_with("study small, statement \"n\": "),
        "{error}"
    );
}
