//! The searches that the paper compares: three strategies for its own pattern, and the Pareto
//! sets of its baselines.

use super::{PaperError, PaperStudy};
use crate::constellation::{Design, Pattern};
use crate::evaluate::{Evaluator, Metrics};
use crate::optimize::{Individual, Method, MopsoConfig, Nsga2Config, Strategy, best, fuzzy};
use crate::search::{DesignProblem, Goals, LaunchCost, Quantity, ShellSpace};
use serde::Serialize;

/// Inclinations of the Iridium-like rows of Table II, degrees.
const IRIDIUM_LIKE_DEG: [f64; 2] = [83.2, 86.4];

/// A design of a set, with its metrics.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundMember {
    /// The design.
    pub design: Design,
    /// Its metrics.
    pub metrics: Metrics,
}

impl Serialize for FoundMember {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct ShownMember<'a> {
            design: String,
            satellites: usize,
            metrics: &'a Metrics,
        }
        ShownMember {
            design: self.design.to_string(),
            satellites: self.design.satellite_count(),
            metrics: &self.metrics,
        }
        .serialize(serializer)
    }
}

/// The non-dominated set of one search.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FoundSet {
    /// Name of the search.
    pub name: &'static str,
    /// The design space, the objectives and the algorithm, in words.
    pub what: String,
    /// Designs evaluated.
    pub evaluations: u64,
    /// The set, by the first objective.
    pub members: Vec<FoundMember>,
    /// Index of the fuzzy pick in `members`.
    pub chosen: Option<usize>,
}

impl FoundSet {
    /// The fuzzy pick.
    #[must_use]
    pub fn pick(&self) -> Option<&FoundMember> {
        self.members.get(self.chosen?)
    }
}

/// One search to run.
struct Plan {
    name: &'static str,
    space: ShellSpace,
    objectives: Vec<Quantity>,
    swarm: bool,
}

/// Names of the sets of the paper's three strategies.
pub(super) const PROPOSED: &str = "proposed";
pub(super) const SINGLE: &str = "max-pdop alone";
pub(super) const SATELLITES: &str = "satellites and max-pdop";

/// Names of the sets of the baselines.
pub(super) const BASELINES: [&str; 3] = ["polar", "iridium-like", "optimized-lfc"];

fn plans(own: ShellSpace) -> Vec<Plan> {
    let both = vec![Quantity::JPos, Quantity::JCost];
    let star = |inclination_deg| ShellSpace {
        pattern: vec![Pattern::Star],
        inclination_deg,
        ..own.clone()
    };
    let lattice = ShellSpace {
        pattern: vec![Pattern::Lattice],
        // Its rows of Table II are at 78.2° and 83.9°, outside the bounds of the paper's own designs.
        inclination_deg: [own.inclination_deg[0], own.inclination_deg[1].max(90.0)],
        phasing: [0, own.planes[1].saturating_sub(1)],
        ..own.clone()
    };
    let plan = |name, space, objectives, swarm| Plan {
        name,
        space,
        objectives,
        swarm,
    };
    vec![
        plan(PROPOSED, own.clone(), both.clone(), false),
        plan(SINGLE, own.clone(), vec![Quantity::MaxPdop], false),
        plan(
            SATELLITES,
            own.clone(),
            vec![Quantity::Satellites, Quantity::MaxPdop],
            false,
        ),
        plan(BASELINES[0], star([90.0, 90.0]), both.clone(), false),
        plan(BASELINES[1], star(IRIDIUM_LIKE_DEG), both.clone(), false),
        plan(BASELINES[2], lattice, both, true),
    ]
}

/// Runs all of them.
pub(super) fn all(evaluator: &Evaluator, study: &PaperStudy) -> Result<Vec<FoundSet>, PaperError> {
    let plans = plans(study.designs.clone());
    plans
        .into_iter()
        .map(|plan| run(evaluator, study, plan))
        .collect()
}

fn run(evaluator: &Evaluator, study: &PaperStudy, plan: Plan) -> Result<FoundSet, PaperError> {
    let goals = Goals {
        objectives: plan.objectives,
        constraints: Vec::new(),
        // No plan minimises it.
        launch_cost: LaunchCost {
            per_satellite: 1.0,
            per_plane: 0.0,
            per_1000_km: 0.0,
        },
        fixed: None,
        fixed_from_files: 0,
    };
    let what = described(&plan.space, &goals.objectives, plan.swarm);
    let problem = DesignProblem::new(evaluator, plan.space.into(), goals)?;
    let mut search = method(&study.nsga2, plan.swarm).start(&problem, study.seed)?;
    while !search.is_done() {
        search.step(&problem)?;
    }
    let front = search.front();
    let points: Vec<&[f64]> = front.iter().map(|a| a.objectives.as_slice()).collect();
    let chosen = match points.is_empty() {
        true => None,
        false => best(&fuzzy(&points)?.minimum),
    };
    let member = |one: &Individual| {
        let (design, metrics) = problem.evaluated(&one.genome)?;
        let design = design?;
        Some(FoundMember { design, metrics })
    };
    Ok(FoundSet {
        name: plan.name,
        what,
        evaluations: search.progress().evaluations,
        members: front.iter().filter_map(member).collect(),
        chosen,
    })
}

fn method(nsga2: &Nsga2Config, swarm: bool) -> Method {
    if swarm {
        Method::Mopso(MopsoConfig {
            particles: nsga2.population,
            iterations: nsga2.generations,
            archive: nsga2.population,
            hypervolume_reference: None,
        })
    } else {
        Method::Nsga2(Nsga2Config {
            hypervolume_reference: None,
            ..nsga2.clone()
        })
    }
}

fn described(space: &ShellSpace, objectives: &[Quantity], swarm: bool) -> String {
    let names: Vec<String> = objectives.iter().map(ToString::to_string).collect();
    let [low, high] = space.inclination_deg;
    format!(
        "{} {low}° to {high}°, {} by {}",
        space.pattern[0],
        names.join(" and "),
        if swarm { "MOPSO" } else { "NSGA-II" }
    )
}
