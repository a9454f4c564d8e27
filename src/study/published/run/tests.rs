mod paper;

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
        // Of notes, skies and statements; each statement is some lines.
        let most = 25 + 8 * study.statements.len() + 15 * study.skies.len();
        assert!(text.lines().count() < most, "{name}");
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
fn what_is_wrong_in_a_scenario_is_told_by_line_and_key() {
    let refused = |text: &str, overrides: &[&str]| run(text, overrides).unwrap_err().to_string();
    let text = one(
        "mean-visible",
        "at-least = 0\nscenario = { time = { stp-s = 60 } }\n",
    );
    let error = refused(&text, &[]);
    assert!(
        error.starts_with(
            "study.toml:13: scenario.time.stp-s: unknown key, did you mean `time.step-s`?"
        ),
        "{error}"
    );
    let error = refused(&one("mean-visible", "at-least = 0\n"), &["time.step-s=0"]);
    assert!(
        error.starts_with("--set time.step-s=0: time.step-s: found 0"),
        "{error}"
    );
    let error = refused(&one("mean-visible", "of = \"irdium\"\nat-least = 0\n"), &[]);
    assert!(error.starts_with("study.toml:8: "), "{error}");
    let missing = "constellations = { mine = { files = [\"none.tle\"] } }\n";
    let text = one("mean-visible", "of = \"mine\"\nat-least = 0\n")
        .replace("gnss =", &format!("{missing}gnss ="));
    let error = refused(&text, &[]);
    assert!(error.contains("none.tle"), "{error}");
}

/// An assumption that no number needs is checked as well: here the number is met without it.
#[test]
fn typos_in_assumptions_are_found() {
    for (assumed, told) in [
        (
            "visibility = { mask-dge = 10 }",
            "study.toml:15: scenario.visibility.mask-dge: unknown key, did you mean `visibility.mask-deg`?",
        ),
        (
            "visibility = { mask-deg = 95 }",
            "study.toml:15: scenario.visibility.mask-deg: ",
        ),
    ] {
        let rest = format!(
            "at-least = 0\n[[assumption]]\nname = \"another mask\"\nscenario = {{ {assumed} }}\n"
        );
        let error = run(&one("mean-visible", &rest), &[])
            .unwrap_err()
            .to_string();
        assert!(error.starts_with(told), "{error}");
    }
}

/// With one system of equal range errors, a standard deviation in metres is that error times the dilution, and so are its
/// quantiles. PDOP is f32 in the summary.
#[test]
fn quantiles_of_metres_windows_and_numbers_in_view() {
    let accurate = |text: String| {
        text.replace(
            "gnss =",
            "accuracy = { gps-m = 2, leo-m = 1 }\nmetrics = { window-min = 30 }\ngnss =",
        )
    };
    let value = |metric: &str| {
        let text = accurate(one(metric, "at-least = 0\n"));
        first(&text).statement.ours.unwrap()
    };
    for (metres, dilution) in [
        ("p99-sigma-3d-m", "p99-pdop"),
        ("p90-sigma-h-m", "p90-hdop"),
        ("max-sigma-v-m", "max-vdop"),
        ("mean-sigma-3d-m", "mean-pdop"),
        ("sigma-3d-m", "mean-pdop"),
    ] {
        let ratio = value(metres) / value(dilution);
        assert!((ratio - 2.0).abs() < 2e-6, "{metres}: {ratio}");
    }
    let [p10, p90, max] = ["p10", "p90", "max"].map(|of| value(&format!("{of}-information-pdop")));
    assert!(p10 < p90 && p90 <= max, "{p10} {p90} {max}");
    let [least, mean, most] =
        ["p0.1", "mean", "max"].map(|of| value(&format!("{of}-gnss-visible")));
    assert!(
        least < mean && mean < most && least.fract() == 0.0,
        "{least} {mean} {most}"
    );
    let error = run(&one("p99-sigma-3d-m", "at-least = 0\n"), &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "study.toml:8: p99-sigma-3d-m needs [accuracy] in the scenario"
    );
    let error = run(&one("p5-information-pdop", "at-least = 0\n"), &[]).unwrap_err();
    assert!(
        error
            .to_string()
            .ends_with("needs metrics.window-min in the scenario")
    );
}

#[test]
fn skies_are_read_from_the_study_or_a_file() {
    let about = |sky: &str| {
        format!(
            "[skies]\nwarsaw = {sky}\n[[statement]]\nname = \"n\"\nof = \"warsaw\"\nmetric = \"hdop\"\nat-least = 0\nsource = \"p\"\n"
        )
    };
    const TABLE: &str = "azimuth_deg,elevation_deg\\n0,5\\n120,5\\n240,5\\n0,90\\n";
    // 4/(3 cos² 5°), as for three satellites on the horizon but for their elevation.
    let hdop = (4.0_f64 / 3.0).sqrt() / 5_f64.to_radians().cos();
    let ours = first(&study(&about(&format!("\"{TABLE}\""))))
        .statement
        .ours
        .unwrap();
    assert!((ours / hdop - 1.0).abs() < 1e-13, "{ours}");
    let from_file =
        PublishedStudy::parse("study.toml", &study(&about("{ file = \"sky.csv\" }"))).unwrap();
    let read = |name: &str| match name {
        "sky.csv" => Ok(TABLE.replace("\\n", "\n").into_bytes()),
        _ => no_files(name),
    };
    let judged = from_file.run(&[], &read).unwrap();
    assert_eq!(judged.statements[0].statement.ours, Some(ours));
    let told = from_file.run(&[], &no_files).unwrap_err().to_string();
    assert_eq!(
        told,
        "study.toml:9: skies.warsaw: cannot read sky.csv: entity not found"
    );
    let wrong = about("\"azimuth_deg,elevation_deg\\n0,95\\n\"");
    let told = run(&study(&wrong), &[]).unwrap_err().to_string();
    assert!(
        told.starts_with("study.toml:9: skies.warsaw: table:2: elevation_deg: found \"95\""),
        "{told}"
    );
}

/// The elements of Walker's slots, worked out by hand: 24/3/1 has planes 120° apart, slots 45° apart and 15° between planes.
#[test]
fn validate_the_elements_of_slots() {
    let value = |metric: &str, satellite: &str| {
        let rest = format!(
            "of = \"delta:56:24/3/1@23222,raan=300,u=350\"\nsatellite = \"{satellite}\"\nat-least = 0\n"
        );
        run(&one(metric, &rest), &[])
    };
    let found = |metric: &str, satellite: &str| {
        value(metric, satellite).unwrap().statements[0]
            .statement
            .ours
            .unwrap()
    };
    for (satellite, raan, arg_latitude) in [
        ("NW-P01-S01", 300.0, 350.0),
        ("NW-P02-S03", 60.0, 95.0),
        ("NW-P03-S08", 180.0, 335.0),
    ] {
        assert!((found("raan-deg", satellite) - raan).abs() < 1e-9);
        assert!((found("arg-latitude-deg", satellite) - arg_latitude).abs() < 1e-9);
    }
    let told = value("raan-deg", "NW-P04-S01").unwrap_err().to_string();
    assert!(told.starts_with("study.toml:8: satellite: delta:56:24/3/1@23222,raan=300,u=350 has no \"NW-P04-S01\", but NW-P01-S01 to NW-P03-S08"), "{told}");
}
