mod constellations;
mod instants;

use super::*;
use crate::ephemeris::Ephemeris;
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::exchange::import::Fleet;
use crate::report::Baseline;
use crate::run::{Diagnostic, FrontMember, RunFiles, testing};
use crate::scenario::Scenario;
use crate::search::DesignProblem;

const SCENARIO: &str = include_str!("../../../data/scenarios/paper.toml");

fn evaluator() -> (Scenario, Evaluator) {
    let small = ["region.step-deg=20", "time.step-s=7200"];
    let scenario = Scenario::parse("paper", SCENARIO.as_bytes(), &small).unwrap();
    let setup = scenario
        .setup(&|_| Err(std::io::ErrorKind::NotFound.into()))
        .unwrap();
    (scenario, Evaluator::new(setup).unwrap())
}

fn member(n: usize, notation: &str) -> FrontMember {
    FrontMember {
        objectives: vec![
            ("j-pos".to_owned(), 1.0 + n as f64),
            ("j-cost".to_owned(), 30.0 - n as f64),
        ],
        chosen: n == 1,
        ..testing::member(n + 1, notation)
    }
}

fn run(scenario: Option<Scenario>, members: usize) -> Run {
    let mut run = Run {
        scenario,
        ..Run::default()
    };
    run.front = (0..members)
        .map(|n| member(n, &format!("delta:{}:12/3/1@900", 40.0 + n as f64 / 1000.0)))
        .collect();
    run
}

fn page<'a>(run: &'a Run, evaluator: Option<&'a Evaluator>) -> Page<'a> {
    Page {
        run,
        stamp: None,
        scenario_toml: Some("a = \"<b>\""),
        evaluator,
        compared: &[],
        fronts: &[],
        fixed: None,
        failures: None,
    }
}

fn compared(one: Constellation, scenario: &Scenario, evaluator: &Evaluator) -> Compared {
    let problem = DesignProblem::new(evaluator, scenario.design_space(), scenario.goals()).unwrap();
    let setup = evaluator.setup();
    let ephemeris = one.ephemeris(setup.grid, setup.model).unwrap();
    Compared::new(one, ephemeris, &problem, None).unwrap()
}

fn design(name: &str, notation: &str) -> Constellation {
    Constellation::of_design(notation.parse().unwrap()).named(name.to_owned())
}

/// Two satellites in a file of this name.
fn of_file(name: &str) -> Constellation {
    let table = "object,epoch_utc,semi_major_axis_km,eccentricity,inclination_deg,raan_deg,arg_perigee_deg,mean_anomaly_deg\n\
        A,2025-01-01T00:00:00Z,7300,0,50,0,0,0\n\
        B,2025-01-01T00:00:00Z,7300,0,50,0,0,180\n";
    let imported = Fleet::read(table.as_bytes(), None, Some("two.csv")).unwrap();
    Constellation::of_files(FileSatellites::of_file(name.to_owned(), imported))
}

fn written(page: &Page<'_>) -> String {
    let mut bytes = Vec::new();
    write(page, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// The numbers of a page.
fn data(html: &str) -> serde_json::Value {
    let start = html.find("id=\"data\">").unwrap() + "id=\"data\">".len();
    let end = start + html[start..].find("</script>").unwrap();
    serde_json::from_str(&html[start..end]).unwrap()
}

#[test]
fn the_page_carries_plotly_and_not_mathjax() {
    let (scenario, evaluator) = evaluator();
    let run = run(Some(scenario), 2);
    let html = written(&page(&run, Some(&evaluator)));
    assert!(
        html.contains("* plotly.js v") && !html.contains("MathJax={}") && !html.contains("tex-svg")
    );
    // Plotly takes 4.65 MB of it.
    assert!(
        (4_600_000..4_900_000).contains(&html.len()),
        "{} bytes",
        html.len()
    );
    assert_eq!(
        html.matches("<script").count() - html.matches("\"<script").count(),
        3 + html.matches("u003cscript").count()
    );
}

#[test]
fn the_same_run_has_the_same_bytes() {
    let (scenario, evaluator) = evaluator();
    let run = run(Some(scenario), 3);
    let page = page(&run, Some(&evaluator));
    assert!(written(&page) == written(&page));
}

#[test]
fn texts_of_files_cannot_leave_their_place() {
    let attack = "</script><img src=x onerror=alert(1)>";
    let mut run = run(None, 1);
    let mut attacker = member(1, "delta:40:12/3/1@900");
    if let Some(design) = &mut attacker.design {
        design.notation = attack.to_owned();
    }
    run.front.push(attacker);
    let mut search = testing::summary();
    search.algorithm = attack.to_owned();
    search.diagnostics.push(Diagnostic {
        code: "c".to_owned(),
        message: attack.to_owned(),
    });
    run.search = Some(search);
    run.gaps.push(attack.to_owned());
    let html = written(&page(&run, None));
    assert!(!html.contains("<img"));
    assert_eq!(data(&html)["front"]["notation"][1], attack);
}

#[test]
fn gaps_leave_the_rest() {
    let none = || Err("none".to_owned());
    let nothing = Run::read(&RunFiles {
        scenario: none(),
        front: none(),
        history: none(),
        validation: None,
    });
    let html = written(&page(&nothing, None));
    assert!(html.contains("What is missing") && html.contains("front.json is missing"));
    assert!(!html.contains("id=\"pareto\"") && html.contains("Conventions and provenance"));
    let without_scenario = run(None, 2);
    let html = written(&page(&without_scenario, None));
    assert!(html.contains("id=\"pareto\""));
    assert!(data(&html)["region"].is_null());
}

#[test]
fn a_large_front_has_cuts_of_some_and_says_so() {
    let (scenario, evaluator) = evaluator();
    let run = run(Some(scenario), 10_000);
    let page = page(&run, Some(&evaluator));
    let places = members_with_cuts(&page);
    assert_eq!(places.len(), MOST_CUTS + 1);
    assert!(places.contains(&0) && places.contains(&1) && places.contains(&9999));
    let summary = PageSummary::new(&page, &places);
    assert!(
        summary
            .gaps
            .iter()
            .any(|gap| gap.contains("101 of the 10000"))
    );
    assert_eq!(words::members(&run, MOST_ROWS).len(), MOST_ROWS + 1);
}

#[test]
fn every_member_of_the_papers_front_has_its_cuts() {
    let cuts = CUTS_BYTES / payload::cut_bytes(1440, 143, 225);
    assert!(cuts >= 30, "{cuts}");
}

#[test]
fn cuts_are_those_of_the_design() {
    let (scenario, evaluator) = evaluator();
    let run = run(Some(scenario.clone()), 2);
    let beside = design("beside", "delta:50:12/3/1@900");
    let design = beside.design.clone().unwrap();
    let page = Page {
        compared: &[compared(beside, &scenario, &evaluator)],
        ..page(&run, Some(&evaluator))
    };
    let data = data(&written(&page));
    let metrics = evaluator.evaluate(&design).unwrap();
    let cuts = &data["baselines"][0]["cuts"];
    let largest = cuts["maps"].as_array().unwrap();
    let largest = largest.iter().find(|pair| pair[0] == "max-pdop").unwrap();
    // A packed row keeps its range in full; the kernel behind the metrics and the plain path behind
    // the cuts agree on a maximum to 1e-5.
    let shown = largest[1]["hi"].as_f64().unwrap();
    assert!((shown / metrics.max_pdop.unwrap() - 1.0).abs() < 1e-5);
    assert_eq!(
        data["baselines"][0]["objectives"].as_array().unwrap().len(),
        2
    );
    let orbit = &cuts["orbits"][0];
    assert_eq!(
        (orbit["raan_deg"][1].as_f64(), orbit["per_plane"].as_u64()),
        (Some(120.0), Some(4))
    );
    assert!(data["cuts"]["0"].is_object() && data["cuts"]["1"].is_object());
}

/// The sky plot draws, and the text states, the skyline and the mask of each system.
#[test]
fn skyline_and_masks_are_shown() {
    let keys = [
        "region.step-deg=20",
        "time.step-s=7200",
        "visibility.mask-deg=7",
        "visibility.gnss-mask-deg=12",
        "visibility.mask-table=[[0, 5], [90, 40], [180, 5], [360, 5]]",
    ];
    let scenario = Scenario::parse("paper", SCENARIO.as_bytes(), &keys).unwrap();
    let setup = scenario
        .setup(&|_| Err(std::io::ErrorKind::NotFound.into()))
        .unwrap();
    let evaluator = Evaluator::new(setup).unwrap();
    let run = run(Some(scenario), 1);
    let html = written(&page(&run, Some(&evaluator)));
    let world = &data(&html)["world"];
    assert_eq!(world["mask_deg"], 7.0);
    assert_eq!(world["gnss_mask_deg"], 12.0);
    assert_eq!(world["skylines_deg"][0][1], serde_json::json!([90.0, 40.0]));
    assert_eq!(world["skyline_of"], serde_json::json!([]));
    for told in [
        "elevation masks 7\u{b0} (LEO) and 12\u{b0} (GNSS), with a skyline of up to 40\u{b0}",
        "LEO 7\u{b0}, GNSS 12\u{b0}; a skyline at every point",
        "5\u{b0} at 0\u{b0}, 40\u{b0} at 90\u{b0}, 5\u{b0} at 180\u{b0}",
    ] {
        assert!(html.contains(told), "{told}");
    }
}

/// Each site has its own skyline in the sky plot, and one without has none.
#[test]
fn skylines_of_sites_are_shown() {
    let pairs = |elevation_deg: f64| {
        let pair = |n: u32| format!("{}:{elevation_deg} ", 30 * n);
        (0..12).map(pair).collect::<String>()
    };
    let sites = format!(
        "name,latitude_deg,longitude_deg,skyline\nA,0,0,{0}\nB,0,10,{0}\nC,0,20,\nD,0,30,{1}\n",
        pairs(12.125),
        pairs(30.0)
    );
    let keys = ["region.points=sites.csv", "time.step-s=7200"];
    let scenario = Scenario::parse("paper", SCENARIO.as_bytes(), &keys).unwrap();
    let setup = scenario.setup(&|_| Ok(sites.clone().into())).unwrap();
    let evaluator = Evaluator::new(setup).unwrap();
    let html = written(&page(&run(Some(scenario), 1), Some(&evaluator)));
    let world = &data(&html)["world"];
    assert_eq!(world["skyline_of"], serde_json::json!([0, 0, null, 1]));
    assert_eq!(
        world["skylines_deg"][0][1],
        serde_json::json!([30.0, 12.13])
    );
    assert_eq!(
        world["skylines_deg"][1][12],
        serde_json::json!([360.0, 30.0])
    );
    assert!(html.contains("each site under the skyline that its list gives, if any"));
}

/// Rounded first to six digits (1.23445) and then to five, it would be 1.2345.
#[test]
fn numbers_are_rounded_once_and_the_same_everywhere() {
    let (scenario, _) = evaluator();
    let mut run = run(Some(scenario), 2);
    for member in &mut run.front {
        member.objectives[0].1 = 1.234_449_6;
        member.metrics.mean_pdop = Some(1.234_449_6);
        member.membership = 0.123_449_6;
    }
    let page = page(&run, None);
    let html = written(&page);
    let rows = words::members(&run, MOST_ROWS);
    let prose = PageSummary::new(&page, &[]).paragraphs.concat();
    let front = data(&html)["front"].clone();
    let tile = |name: &str| {
        let tiles = front["tiles"].as_array().unwrap();
        let found = tiles.iter().find(|tile| tile[0] == name).unwrap();
        found[1][1].as_str().unwrap().to_owned()
    };
    for text in [
        &tile("j-pos"),
        &tile("mean PDOP"),
        &rows[1].cells[0],
        &rows[1].cells[3],
    ] {
        assert_eq!(text, "1.2344");
    }
    assert!(
        prose.contains("j-pos 1.2344,") && prose.contains("mean PDOP is 1.2344,"),
        "{prose}"
    );
    assert!(prose.contains("front, 0.123."), "{prose}");
    assert_eq!(rows[1].cells.last().unwrap(), "0.123");
    assert_eq!(front["memberships_shown"][1], "0.123");
}

/// A quantity under a constraint is in the table, the strip and the prose.
#[test]
fn constraints_are_shown() {
    let keys = ["objectives.constraints=[\"max-pdop <= 2.5\", \"planes <= 14\"]"];
    let scenario = Scenario::parse("paper", SCENARIO.as_bytes(), &keys).unwrap();
    let mut run = run(Some(scenario), 2);
    for member in &mut run.front {
        member.constraints = vec![
            ("max-pdop".to_owned(), Some(2.25)),
            ("planes".to_owned(), Some(3.0)),
        ];
    }
    let page = page(&run, None);
    let html = written(&page);
    assert!(html.contains("<th class=\"number\">planes</th>"));
    assert!(html.contains("max-pdop &#60;= 2.5, planes &#60;= 14"));
    assert!(html.contains("Constrained quantities: max-pdop 2.2500, planes 3."));
    let tiles = data(&html)["front"]["tiles"].to_string();
    assert!(tiles.contains("[\"planes\",[\"3\",\"3\"]]"), "{tiles}");
}

/// The prose and a note name the design that dominates the pick.
#[test]
fn a_pick_that_is_dominated_is_said_to_be_so() {
    let (scenario, evaluator) = evaluator();
    let reference = design(Baseline::REFERENCE, "delta:50:225/15/1@1000");
    let reference = [compared(reference, &scenario, &evaluator)];
    let mut run = run(Some(scenario), 2);
    run.front[1].objectives = vec![("j-pos".to_owned(), 99.0), ("j-cost".to_owned(), 99.0)];
    let beside = Page {
        compared: &reference,
        ..page(&run, Some(&evaluator))
    };
    let html = written(&beside);
    assert!(html.contains("It is dominated by the reference design delta:50:225/15/1@1000."));
    assert!(html.contains("dominates the pick delta:40.001:12/3/1@900"));
    assert!(!written(&page(&run, Some(&evaluator))).contains("dominated by"));
}

/// The page of constellations without a search.
fn page_of<'a>(run: &'a Run, evaluator: &'a Evaluator, compared: &'a [Compared]) -> Page<'a> {
    let stamp = Box::leak(Box::new(ScenarioStamp {
        name: "paper".to_owned(),
        hash: "the-hash".to_owned(),
    }));
    Page {
        stamp: Some(stamp),
        compared,
        ..page(run, Some(evaluator))
    }
}

/// A table, the plane, maps, curves and a globe; nothing of a search.
#[test]
fn constellations_need_no_search() {
    let (scenario, evaluator) = evaluator();
    let shown = [
        design("Proposed", "delta:55:182/13/1@925"),
        design("Polar", "star:90:182/13/1@925"),
    ];
    let shown = shown.map(|one| compared(one, &scenario, &evaluator));
    let run = run(Some(scenario), 0);
    let html = written(&page_of(&run, &evaluator, &shown));
    for id in ["pareto", "map-mean-pdop", "tail", "globe", "compared"] {
        assert!(html.contains(&format!("id=\"{id}\"")), "{id}");
    }
    for of_search in [
        "membership",
        "convergence",
        "parallel",
        "search",
        "members",
        "close-up",
    ] {
        assert!(
            !html.contains(&format!("id=\"{of_search}\"")),
            "{of_search}"
        );
    }
    assert!(!html.contains("The search found") && html.contains("the-hash"));
    assert!(html.contains("Proposed dominates Polar."));
    let data = data(&html);
    let [proposed, polar] = [0, 1].map(|n| data["baselines"][n].clone());
    assert_eq!(proposed["name"], "Proposed");
    assert_eq!(polar["notation"], "star:90:182/13/1@925");
    assert_eq!(
        proposed["cuts"]["orbits"][0]["notation"],
        "delta:55:182/13/1@925"
    );
    assert_ne!(proposed["cuts"]["maps"], polar["cuts"]["maps"]);
    // The tiles are those of the members, in their order.
    let labels = data["front"]["tiles"].as_array().unwrap();
    assert_eq!(labels.len(), proposed["tiles"].as_array().unwrap().len());
    let at = labels.iter().position(|tile| tile[0] == "mean visible");
    let visible = shown[0].baseline.metrics.mean_visible;
    assert_eq!(proposed["tiles"][at.unwrap()], format!("{visible:.4}"));
}

/// One row each, the best of a column in bold, and the GNSS alone last.
#[test]
fn the_table_marks_the_best_of_each_column() {
    let (scenario, evaluator) = evaluator();
    let shown = [
        design("few", "delta:55:36/6/1@925"),
        design("many", "delta:55:182/13/1@925"),
    ];
    let shown = shown.map(|one| compared(one, &scenario, &evaluator));
    let run = run(Some(scenario), 0);
    let table = Comparison::new(&page_of(&run, &evaluator, &shown)).unwrap();
    let column = |name: &str| table.columns.iter().position(|c| c == name).unwrap();
    let is_best = |row: usize, name: &str| table.rows[row].cells[column(name)].is_best;
    for name in [
        "mean visible",
        "mean PDOP",
        "CVaR of PDOP (worst 5 %)",
        "maximum PDOP",
        "J_pos",
    ] {
        assert!(is_best(1, name) && !is_best(0, name), "{name}");
    }
    // Fewer satellites are no merit unless they are an objective.
    assert!(!is_best(0, "satellites") && !is_best(1, "satellites"));
    let names: Vec<&str> = table.rows.iter().map(|row| row.name.as_str()).collect();
    assert_eq!(names, ["few", "many", "GNSS alone"]);
    let alone = &table.rows[2];
    assert_eq!(alone.cells[column("mean visible")].text, "0.0000");
    let nothing = Ephemeris::new(evaluator.setup().grid, Vec::new());
    let pdop = evaluator
        .evaluate_ephemeris(&nothing)
        .unwrap()
        .mean_pdop
        .unwrap();
    assert_eq!(alone.cells[column("mean PDOP")].text, format!("{pdop:.4}"));
    assert!(alone.cells.iter().all(|cell| !cell.is_best));
}

/// Satellites of a file have positions in the page that are those of the ephemeris.
#[test]
fn satellites_from_files_are_drawn_from_samples() {
    let (scenario, evaluator) = evaluator();
    let shown = [compared(of_file("two.csv"), &scenario, &evaluator)];
    let run = run(Some(scenario), 0);
    let html = written(&page_of(&run, &evaluator, &shown));
    let cuts = &data(&html)["baselines"][0]["cuts"];
    assert!(cuts["orbits"].as_array().unwrap().is_empty());
    let tracks = &cuts["tracks"];
    // A day without its last step of two hours.
    assert_eq!(
        (tracks["step_s"].as_f64(), tracks["instants"].as_u64()),
        (Some(300.0), Some(265))
    );
    let highest = (0..265)
        .flat_map(|n| {
            let ephemeris = &shown[0].ephemeris;
            let of = move |one| ephemeris.state(one, 300.0 * f64::from(n)).unwrap();
            ephemeris.satellites().iter().map(of)
        })
        .flat_map(|state| state.position_km.km().iter().copied().collect::<Vec<f64>>())
        .fold(0.0, f64::max);
    // A packed row keeps its range in full.
    assert_eq!(tracks["positions_km"]["hi"].as_f64(), Some(highest));
    // One constellation has no plane and no best.
    assert!(!html.contains("id=\"pareto\"") && !html.contains("class=\"number best\""));
}

/// Names of files are texts of others.
#[test]
fn hostile_names_stay_texts() {
    let (scenario, evaluator) = evaluator();
    let attack = "</script><img src=x onerror=alert(1)>\u{202e}.tle";
    let shown = [of_file(attack), design("other", "delta:55:36/6/1@925")];
    let shown = shown.map(|one| compared(one, &scenario, &evaluator));
    let run = run(Some(scenario), 0);
    let html = written(&page_of(&run, &evaluator, &shown));
    assert!(!html.contains("<img") && !html.contains('\u{202e}'));
    let name = data(&html)["baselines"][0]["name"].clone();
    assert_eq!(name, "</script><img src=x onerror=alert(1)>\\u{202e}.tle");
}
