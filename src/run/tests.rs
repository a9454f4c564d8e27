use super::*;

const SCENARIO: &str = include_str!("../../data/scenarios/paper.toml");

/// `front.json` with one member that is not a design, one that lacks an objective and one that is
/// damaged.
fn front_json() -> Value {
    let named = |objectives: &[(&str, f64)]| {
        let owned = objectives
            .iter()
            .map(|(name, value)| ((*name).to_owned(), *value));
        owned.collect::<Vec<_>>()
    };
    let both = named(&[("j-cost", 20.0), ("j-pos", 1.7)]);
    let one = |index, objectives: &[(String, f64)]| FrontMember {
        objectives: objectives.to_vec(),
        chosen: index == 1,
        ..testing::member(index, "delta:45:225/15/1@1000")
    };
    let mut unnamed = one(2, &both);
    if let Some(design) = &mut unnamed.design {
        design.notation = "no design".to_owned();
    }
    let result = OptimizeResult {
        front: vec![
            one(1, &both),
            unnamed,
            one(3, &named(&[("j-pos", 1.9)])),
            one(4, &both),
        ],
        search: testing::summary(),
        history: Vec::new(),
        chosen_reference: None,
    };
    let mut value = serde_json::to_value(result).unwrap();
    value["front"][3]["index"] = "four".into();
    value
}

fn files() -> RunFiles {
    RunFiles {
        scenario: Ok(SCENARIO.as_bytes().to_vec()),
        front: Ok(front_json().to_string().into_bytes()),
        history: Ok(b"[]".to_vec()),
        validation: None,
    }
}

fn has_gap(run: &Run, text: &str) -> bool {
    run.gaps.iter().any(|gap| gap.contains(text))
}

#[test]
fn what_can_be_read_is_kept_and_the_rest_is_named() {
    let run = Run::read(&files());
    let notations: Vec<_> = run.front.iter().map(FrontMember::made_of).collect();
    assert_eq!(notations, ["delta:45:225/15/1@1000", "no design"]);
    assert!(run.front[0].only_design().is_some() && run.front[1].only_design().is_none());
    assert!(has_gap(&run, "1 of 4 designs of the front cannot be read"));
    assert!(has_gap(&run, "1 designs of the front lack an objective"));
    assert!(has_gap(&run, "made by version 0.0.0"));
    assert_eq!(run.search, Some(testing::summary()));
    assert_eq!(run.chosen(), Some(0));
}

#[test]
fn members_are_kept_when_the_rest_is_damaged() {
    let mut value = front_json();
    value["seed"] = "one".into();
    let run = Run::read(&RunFiles {
        front: Ok(value.to_string().into_bytes()),
        ..files()
    });
    assert!(run.front.len() == 2 && run.search.is_none());
    assert!(has_gap(&run, "front.json has no record of the search"));
}

/// Results round-trip to the byte.
#[test]
fn results_are_read_back_as_they_were_written() {
    let result = OptimizeResult {
        front: vec![testing::member(1, "delta:45:225/15/1@1000")],
        search: testing::summary(),
        history: Vec::new(),
        chosen_reference: None,
    };
    let text = serde_json::to_string_pretty(&result).unwrap();
    let read = OptimizeResult::read(text.as_bytes()).unwrap();
    assert_eq!(read, result);
    assert_eq!(serde_json::to_string_pretty(&read).unwrap(), text);
}

#[test]
fn objectives_stand_in_the_order_of_the_scenario() {
    let run = Run::read(&files());
    assert_eq!(run.objective_names(), ["j-pos", "j-cost"]);
    assert_eq!(run.front[0].objectives[0], ("j-pos".to_owned(), 1.7));
    assert_eq!(run.front[0].objective("j-cost"), Some(20.0));
}

#[test]
fn nothing_at_all_is_a_run_with_gaps() {
    let none = || Err("there is no such file".to_owned());
    let run = Run::read(&RunFiles {
        scenario: none(),
        front: none(),
        history: none(),
        validation: Some(b"{".to_vec()),
    });
    assert!(run.scenario.is_none() && run.front.is_empty());
    for text in [
        "scenario.toml is missing",
        "front.json is missing",
        "history.json is missing",
    ] {
        assert!(has_gap(&run, text), "{text}");
    }
    #[cfg(feature = "validate")]
    assert!(run.validation.is_none() && has_gap(&run, "the validation is damaged"));
    assert!(run.objective_names().is_empty() && run.chosen().is_none());
}

#[test]
fn any_cut_of_the_files_is_read_without_panic() {
    let whole = front_json().to_string();
    for end in 0..whole.len() {
        let cut = RunFiles {
            front: Ok(whole.as_bytes()[..end].to_vec()),
            ..files()
        };
        assert!(has_gap(&Run::read(&cut), "front.json is damaged"));
    }
}

#[test]
fn an_older_history_has_no_points() {
    let old = r#"[{"generation":1,"evaluations":30,"hypervolume":0.5,"ideal":[1.0,2.0],"front_size":3,"feasible":30}]"#;
    let run = Run::read(&RunFiles {
        history: Ok(old.as_bytes().to_vec()),
        ..files()
    });
    assert!(run.history[0].front.is_empty() && run.history[0].front_size == 3);
}
