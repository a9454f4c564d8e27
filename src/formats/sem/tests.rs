use super::*;
use crate::formats::text::finding::{Finding, Severity};

const TWO: &str = "\
2  CURRENT.ALM
 299 258048

1
63
0
 5.0E-03  5.0E-03 -2.5E-09
 5.1535E+03  1.0E-01  2.0E-01
 3.0E-01  0.0E+00  0.0E+00
0
11

2
61
0
 1.0E-02 -2.0E-03 -2.6E-09
 5.1536E+03 -7.5E-01 -2.0E-01
-4.0E-01  1.0E-05  0.0E+00
63
11
";

fn findings(text: &str) -> Vec<Finding> {
    let mut findings = FindingList::of_linter(20);
    parse(text.as_bytes(), &mut findings).unwrap();
    findings.into_vec()
}

/// Semicircles are 180°, and the inclination is counted from 54° (0.30 semicircles).
#[test]
fn validate_units_of_the_definition() {
    assert_eq!(findings(TWO), []);
    let almanacs = read(TWO.as_bytes()).unwrap();
    let [first, second] = almanacs[..] else {
        panic!("{almanacs:?}")
    };
    assert_eq!((first.prn, first.week, first.toa_s), (1, 299, 258_048.0));
    assert!((first.inclination_rad.to_degrees() - 54.9).abs() < 1e-12);
    assert!((first.raan_rate_rad_s - -7.853_981_633_974e-9).abs() < 1e-20);
    assert!((first.raan_at_week_rad.to_degrees() - 18.0).abs() < 1e-12);
    assert!((first.arg_perigee_rad.to_degrees() - 36.0).abs() < 1e-12);
    assert!((first.mean_anomaly_rad.to_degrees() - 54.0).abs() < 1e-12);
    assert_eq!((first.sqrt_a, first.eccentricity), (5_153.5, 0.005));
    assert!(first.is_healthy() && !second.is_healthy());
}

/// A record taken out by hand, or a file cut between two records: read, but not without a word.
#[test]
fn records_that_are_not_there_are_told() {
    let three = TWO.replacen("2  C", "3  C", 1);
    let mut reader = FindingList::of_reader();
    let almanacs = parse(three.as_bytes(), &mut reader).unwrap();
    assert_eq!(almanacs, read(TWO.as_bytes()).unwrap());
    let told = reader.left_out().to_string();
    assert_eq!(
        told,
        "left out: 2 (unhealthy satellite: PRN-02; announced record that is not there: 3)"
    );
    let found = findings(&three);
    let [finding] = found.as_slice() else {
        panic!("{found:?}")
    };
    assert_eq!(
        (finding.line, finding.rule, finding.severity),
        (20, "sem-count", Severity::Warning)
    );
    let none = TWO.split_inclusive('\n').take(2).collect::<String>();
    assert_eq!(findings(&none)[0].severity, Severity::Error);
}

#[test]
fn broken_rules_are_named_with_their_place() {
    for (from, to, expected) in [
        ("2  C", "x  C", (1, 1, "sem-first-line")),
        ("2  C", "0  C", (2, 2, "sem-count")),
        ("2  C", "1  C", (13, 1, "sem-count")),
        ("63\n11\n", "63\n", (19, 1, "sem-truncated")),
        (
            " 5.0E-03  5.0E-03",
            " 5.0x-03  5.0E-03",
            (7, 2, "sem-number"),
        ),
        (
            " 5.0E-03  5.0E-03",
            " 1.0E+00  5.0E-03",
            (4, 1, "almanac-range"),
        ),
        (" 5.1535E+03", " 5.1535E+00", (4, 1, "implausible-state")),
        ("\n2\n61", "\n1\n61", (13, 1, "almanac-repeated")),
        ("258048", "958048", (4, 1, "almanac-range")),
    ] {
        let text = TWO.replacen(from, to, 1);
        assert_ne!(text, TWO, "{from}");
        assert!(read(text.as_bytes()).is_err(), "{from}");
        let found = findings(&text);
        let places: Vec<_> = found.iter().map(|f| (f.line, f.column, f.rule)).collect();
        assert!(places.contains(&expected), "{from:?}: {places:?}");
    }
}
