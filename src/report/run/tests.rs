use super::*;

const SCENARIO: &str = include_str!("../../../data/scenarios/paper.toml");

const FRONT: &str = r#"{
  "front": [
    {"index": 1, "design": {"notation": "delta:45:225/15/1@1000"}, "metrics": {"mean_pdop": 1.1, "max_pdop": null},
     "objectives": {"j-cost": 20.0, "j-pos": 1.7}, "membership": 0.4, "membership_sum": 0.5, "chosen": true},
    {"index": 2, "design": {"notation": "no design"}, "objectives": {"j-cost": 19.0, "j-pos": 1.8}},
    {"index": 3, "design": {"notation": "delta:45:225/15/1@900"}, "objectives": {"j-pos": 1.9}},
    {"index": "four"}
  ],
  "evaluations": 900, "hypervolume": {"value": 0.6, "reference": [2.0, 22.0]}, "seed": 7,
  "generations": [30, 30], "version": "0.0.0", "diagnostics": [{"code": "c", "message": "m"}, {}]
}"#;

fn files() -> RunFiles {
    RunFiles {
        scenario: Ok(SCENARIO.as_bytes().to_vec()),
        front: Ok(FRONT.as_bytes().to_vec()),
        history: Ok(b"[]".to_vec()),
        validation: None,
    }
}

fn has_gap(run: &StoredRun, text: &str) -> bool {
    run.gaps.iter().any(|gap| gap.contains(text))
}

#[test]
fn what_can_be_read_is_kept_and_the_rest_is_named() {
    let run = StoredRun::read(&files());
    let notations: Vec<_> = run
        .front
        .members
        .iter()
        .map(|m| m.notation.as_str())
        .collect();
    assert_eq!(notations, ["delta:45:225/15/1@1000", "no design"]);
    assert!(run.front.members[0].design.is_some() && run.front.members[1].design.is_none());
    assert!(has_gap(&run, "1 of 4 front members cannot be read"));
    assert!(has_gap(&run, "1 front members lack an objective"));
    assert!(has_gap(&run, "made by version 0.0.0"));
    assert_eq!(run.front.diagnostics, [("c".to_owned(), "m".to_owned())]);
    assert_eq!(
        (run.front.seed, run.front.generations),
        (Some(7), Some([30, 30]))
    );
    assert_eq!(run.chosen(), Some(0));
    assert_eq!(run.front.members[0].metrics.mean_pdop, Some(1.1));
}

#[test]
fn objectives_stand_in_the_order_of_the_scenario() {
    let run = StoredRun::read(&files());
    assert_eq!(run.objective_names(), ["j-pos", "j-cost"]);
    assert_eq!(
        run.front.members[0].objectives[0],
        ("j-pos".to_owned(), 1.7)
    );
    assert_eq!(run.front.members[0].objective("j-cost"), Some(20.0));
}

#[test]
fn nothing_at_all_is_a_run_with_gaps() {
    let none = || Err("there is no such file".to_owned());
    let run = StoredRun::read(&RunFiles {
        scenario: none(),
        front: none(),
        history: none(),
        validation: Some(b"{".to_vec()),
    });
    assert!(run.scenario.is_none() && run.front.members.is_empty() && run.validation.is_none());
    for text in [
        "scenario.toml is missing",
        "front.json is missing",
        "history.json is missing",
    ] {
        assert!(has_gap(&run, text), "{text}");
    }
    assert!(has_gap(&run, "the validation is damaged"));
    assert!(run.objective_names().is_empty() && run.chosen().is_none());
}

#[test]
fn any_cut_of_the_files_is_read_without_panic() {
    for end in 0..FRONT.len() {
        let cut = RunFiles {
            front: Ok(FRONT.as_bytes()[..end].to_vec()),
            ..files()
        };
        assert!(has_gap(&StoredRun::read(&cut), "front.json is damaged"));
    }
}

#[test]
fn an_older_history_has_no_points() {
    let old = r#"[{"generation":1,"evaluations":30,"hypervolume":0.5,"ideal":[1.0,2.0],"front_size":3,"feasible":30}]"#;
    let run = StoredRun::read(&RunFiles {
        history: Ok(old.as_bytes().to_vec()),
        ..files()
    });
    assert!(run.history[0].front.is_empty() && run.history[0].front_size == 3);
}
