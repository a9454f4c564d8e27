//! `--set` arguments over a file.

use super::parse;
use crate::ground::{AreaPoints, Country};
use crate::scenario::{AreaSource, Clocks, Fault, Place, PointWeights, Quantity, Region, builtin};

fn one_problem(text: &str, overrides: &[&str]) -> String {
    let problems = parse(text, overrides).unwrap_err();
    assert_eq!(problems.as_slice().len(), 1, "{problems}");
    problems.to_string()
}

#[test]
fn an_argument_wins_over_the_file_and_a_later_one_over_an_earlier() {
    let text = "[time]\nstep-s = 30\nduration-h = 2";
    let scenario = parse(text, &["time.step-s=20", "name=a", "time.step-s=10"]).unwrap();
    assert_eq!(
        (scenario.time.step_s, scenario.time.duration_h),
        (10.0, 2.0)
    );
    assert_eq!(scenario.name, "a");
}

#[test]
fn an_argument_is_toml_or_else_a_bare_text() {
    let arguments = [
        "reference-design=star:90:4/2/1@925",
        "time.epoch=2030-01-01T00:00:00Z",
        " region.weights = cos-latitude ",
        "region.latitude-deg=[-10, 10]",
        "gnss.clocks='shared'",
        "gnss.constellations=[]",
        "objectives.constraints=[\"max-pdop <= 2.5\"]",
    ];
    let scenario = parse("", &arguments).unwrap();
    assert_eq!(scenario.reference_design, "star:90:4/2/1@925");
    assert_eq!(scenario.time.epoch.timestamp(), 1_893_456_000);
    let Region::Grid(grid) = scenario.region else {
        panic!("no points were given");
    };
    assert_eq!(
        (grid.weights, grid.latitude_deg),
        (PointWeights::CosLatitude, [-10.0, 10.0])
    );
    assert_eq!(scenario.gnss.clocks, Clocks::Shared);
    assert_eq!(scenario.gnss.constellations, []);
    assert_eq!(
        scenario.objectives.constraints[0].to_string(),
        "max-pdop <= 2.5"
    );
}

#[test]
fn a_wrong_file_value_that_is_overridden_is_no_problem() {
    assert_eq!(
        parse("[time]\nstep-s = 0", &["time.step-s=5"])
            .unwrap()
            .time
            .step_s,
        5.0
    );
}

#[test]
fn problems_name_the_argument() {
    assert_eq!(
        one_problem("", &["visibility.mask-deg=90"]),
        "--set visibility.mask-deg=90: visibility.mask-deg: found 90, \
         expected a number >= 0 and < 90, in deg"
    );
    assert_eq!(
        one_problem("", &["region.weigths=equal"]),
        "--set region.weigths=equal: region.weigths: unknown key, did you mean \
         `region.weights`? (choices: latitude-deg, longitude-deg, step-deg, weights, spacing-km, polygon, country, points, weight-grid, terrain, antenna-height-m)"
    );
    let nearest = one_problem("", &["optimiser.seed=4"]);
    assert!(
        nearest.contains("did you mean `optimizer.seed`?"),
        "{nearest}"
    );
    let nearest = one_problem("", &["seed=4"]);
    assert!(
        nearest.contains("did you mean `optimizer.seed`?"),
        "{nearest}"
    );
    let deeper = one_problem("", &["time.step-s.x=4"]);
    assert!(deeper.contains("did you mean `time.step-s`?"), "{deeper}");
    let section = one_problem("", &["time=4"]);
    assert!(
        section.contains("[time] is a section; set one of its keys: epoch, "),
        "{section}"
    );
    let plain = one_problem("", &["time.step-s"]);
    assert_eq!(
        plain,
        "--set time.step-s: time.step-s: expected key.path=value"
    );
    let list = one_problem("", &["objectives.minimize=[j-pos]"]);
    assert!(
        list.contains("not TOML: ") && list.contains("words in a list are quoted"),
        "{list}"
    );
}

#[test]
fn a_problem_between_file_and_argument_is_at_the_argument() {
    let text = "[search]\nplanes = [10, 1000]";
    let problems = parse(text, &["search.satellites-per-plane=500"]).unwrap_err();
    let [problem] = problems.as_slice() else {
        panic!("{problems}");
    };
    assert!(
        matches!(problem.place, Place::Argument { index: 0, .. }),
        "{problem}"
    );
    assert!(
        matches!(problem.fault, Fault::TooMany { most: 100_000, .. }),
        "{problem}"
    );
}

#[test]
fn points_replace_the_grid_of_the_file_and_the_reverse() {
    let paper = builtin("paper").unwrap();
    let points = parse(paper, &["region.points=stations.csv"]).unwrap();
    assert_eq!(
        points.region,
        Region::Points {
            file: "stations.csv".to_owned()
        }
    );
    let text = "[region]\npoints = \"stations.csv\"";
    let grid = parse(text, &["region.step-deg=10"]).unwrap();
    assert!(matches!(grid.region, Region::Grid(grid) if grid.step_deg == [10.0, 10.0]));
    let inline = parse(paper, &["region={ points = 'stations.csv' }"]).unwrap();
    assert_eq!(inline.region, points.region);
    let both = one_problem("", &["region.points=a.csv", "region.step-deg=10"]);
    assert!(
        both.contains("region.step-deg: excluded by `region.points`"),
        "{both}"
    );
}

/// A region of one kind replaces what a file says of another; what both have stays.
#[test]
fn kinds_of_regions_replace_each_other() {
    let paper = builtin("paper").unwrap();
    let region = |text: &str, overrides: &[&str]| parse(text, overrides).unwrap().region;
    let china = vec![Country::find("China").unwrap()];
    let lattice = AreaPoints::Lattice {
        step_deg: [2.0, 2.0],
        weights: PointWeights::Equal,
    };
    assert_eq!(
        region(paper, &["region.country=china", "region.step-deg=2"]),
        Region::Area {
            source: AreaSource::Countries(china.clone()),
            points: lattice
        }
    );
    assert_eq!(
        region(
            paper,
            &["region.polygon=a.geojson", "region.spacing-km=100"]
        ),
        Region::Area {
            source: AreaSource::Polygon {
                file: "a.geojson".to_owned()
            },
            points: AreaPoints::Cells { spacing_km: 100.0 }
        }
    );
    let Region::Cells(cells) = region(paper, &["region.spacing-km=100"]) else {
        panic!("the limits of the file stay");
    };
    assert_eq!(cells.latitude_deg, [3.0, 54.0]);
    let text = "[region]\ncountry = [\"Japan\"]\nspacing-km = 50";
    assert!(matches!(
        region(text, &["region.longitude-deg=[0,9]"]),
        Region::Cells(_)
    ));
    assert!(matches!(
        region(text, &["region.points=a.csv"]),
        Region::Points { .. }
    ));
    assert!(matches!(
        region(text, &["region.step-deg=1"]),
        Region::Area {
            points: AreaPoints::Lattice { .. },
            ..
        }
    ));
    for (text, message) in [
        (
            "country = \"China\"\npolygon = \"a\"",
            "region.polygon: excluded by `region.country`",
        ),
        (
            "country = \"China\"\nlatitude-deg = [0, 1]",
            "region.latitude-deg: excluded by `region.country`",
        ),
        (
            "weights = \"equal\"\nspacing-km = 500",
            "region.weights: excluded by `region.spacing-km`",
        ),
        (
            "points = \"a\"\nspacing-km = 500",
            "region.spacing-km: excluded by `region.points`",
        ),
    ] {
        let problem = one_problem(&format!("[region]\n{text}"), &[]);
        assert!(problem.contains(message), "{problem}");
    }
    let empty = one_problem("[region]\ncountry = []", &[]);
    assert!(
        empty.contains("found [], expected the name of a country, or a list of one or more"),
        "{empty}"
    );
}

#[test]
fn objectives_replace_the_reference_point_of_the_file() {
    let paper = builtin("paper").unwrap();
    let minimize = "objectives.minimize=[\"j-pos\", \"satellites\"]";
    let objectives = parse(paper, &[minimize]).unwrap().objectives;
    assert_eq!(objectives.minimize, [Quantity::JPos, Quantity::Satellites]);
    assert_eq!(objectives.hypervolume_reference, None);
    let reference = "objectives.hypervolume-reference=[2, 300]";
    for arguments in [[minimize, reference], [reference, minimize]] {
        let objectives = parse(paper, &arguments).unwrap().objectives;
        assert_eq!(objectives.hypervolume_reference, Some(vec![2.0, 300.0]));
    }
}

#[test]
fn the_gnss_mask_follows_the_mask() {
    let masks = |text: &str, overrides: &[&str]| {
        let visibility = parse(text, overrides).unwrap().visibility;
        (visibility.mask_deg, visibility.gnss_mask_deg)
    };
    let paper = builtin("paper").unwrap();
    assert_eq!(masks(paper, &["visibility.mask-deg=12"]), (12.0, 12.0));
    assert_eq!(masks(paper, &["visibility.gnss-mask-deg=12"]), (7.0, 12.0));
}
