//! Maps at instants.

use super::*;

/// The maps are the samples of the evaluator: of the chosen member and of what is compared, and of no other.
#[test]
fn maps_at_instants_are_the_samples() {
    let (scenario, evaluator) = evaluator();
    let run = run(Some(scenario.clone()), 2);
    let beside = design("beside", "delta:50:12/3/1@900");
    let setup = evaluator.setup();
    let ephemeris = beside.ephemeris(setup.grid, setup.model).unwrap();
    let page = Page {
        compared: &[compared(beside, &scenario, &evaluator)],
        ..page(&run, Some(&evaluator))
    };
    let data = data(&written(&page));
    let samples = evaluator.samples(&ephemeris).unwrap();
    let pdop = samples.pdop.iter().flatten().map(|pdop| f64::from(*pdop));
    let maps = &data["baselines"][0]["cuts"]["instants"];
    assert_eq!(maps["pdop"]["hi"].as_f64(), pdop.clone().reduce(f64::max));
    assert_eq!(maps["pdop"]["lo"].as_f64(), pdop.reduce(f64::min));
    let most = samples.visible.iter().copied().max().map(f64::from);
    assert_eq!(maps["visible"]["hi"].as_f64(), most);
    let count = data["instants_s"].as_array().unwrap().len();
    assert_eq!(count, setup.grid.len());
    let has = |place: &str| data["cuts"][place]["instants"].is_object();
    assert!(has("1") && !has("0"), "member 1 is the chosen one");
}
