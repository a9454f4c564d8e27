use super::*;
use crate::constellation::Pattern;
use crate::evaluate::{Evaluator, Setup};
use crate::optimize::Problem;
use crate::run::typed_columns::{ColumnValues, TypedColumns};
use crate::scenario::Scenario;
use crate::search::DesignProblem;

const SMALL: &str = "\
    time.step-s = 3600\n\
    region.step-deg = 25\n\
    search.planes = [3, 5]\n\
    search.satellites-per-plane = [3, 4]\n\
    search.inclination-deg = [40, 60]\n\
    search.inclination-step-deg = 10\n\
    search.altitude-deg = [800, 1000]\n";

/// One sample.
const ONE: SampleShape = SampleShape {
    points: 1,
    instants: 1,
};

fn scenario() -> Scenario {
    let text = SMALL.replace("altitude-deg", "altitude-km");
    Scenario::parse("small.toml", text.as_bytes(), &[] as &[String]).unwrap()
}

fn setup(scenario: &Scenario) -> Setup {
    scenario
        .setup(&|_| Err(std::io::ErrorKind::NotFound.into()))
        .unwrap()
}

fn stamp(scenario: &Scenario) -> ScenarioStamp {
    ScenarioStamp {
        name: scenario.name.clone(),
        hash: scenario.hash(&[]),
    }
}

fn never() -> bool {
    false
}

/// The results of all chunks of a plan, as files.
fn results(
    problem: &DesignProblem<'_>,
    designs: &SweepDesigns<'_>,
    plan: &SweepPlan,
) -> Vec<(SweepChunk, Vec<u8>)> {
    let evaluator = SweepEvaluator::new(problem);
    let one = |number| {
        let chunk = SweepChunk::new(plan, designs.at(plan.points_of(number)).unwrap());
        let table = evaluator.evaluate(&chunk, &never).unwrap();
        let bytes = write_chunk(plan.format, &chunk.name, table).unwrap();
        (chunk, bytes)
    };
    (0..plan.chunks()).map(one).collect()
}

/// The merged table of these results.
fn merged(plan: &SweepPlan, results: Vec<(SweepChunk, Vec<u8>)>) -> Vec<u8> {
    let mut writer = None;
    for (chunk, bytes) in results {
        let table = read_chunk(plan.format, &chunk.name, bytes).unwrap();
        let begun = writer
            .get_or_insert_with(|| TableWriter::new(plan.format, Vec::new(), &table, &[]).unwrap());
        assert!(begun.add(table).unwrap());
    }
    writer.unwrap().finish().unwrap()
}

/// Every design of the grid has the metrics that it has alone, and the table is the same whatever its chunks.
#[test]
fn the_table_is_that_of_the_designs_whatever_the_chunks() {
    let scenario = scenario();
    let evaluator = Evaluator::new(setup(&scenario)).unwrap();
    let problem =
        DesignProblem::new(&evaluator, scenario.design_space(), scenario.goals()).unwrap();
    let designs = SweepDesigns::of_space(&problem);
    for format in [TableFormat::Parquet, TableFormat::Csv] {
        let plan =
            |chunk| SweepPlan::new(stamp(&scenario), &designs, format, (Some(chunk), ONE)).unwrap();
        let tables: Vec<Vec<u8>> = [1, 7, 1000]
            .map(|chunk| merged(&plan(chunk), results(&problem, &designs, &plan(chunk))))
            .into();
        assert!(tables.iter().all(|table| *table == tables[0]), "{format}");
    }
    let plan =
        SweepPlan::new(stamp(&scenario), &designs, TableFormat::Csv, (Some(9), ONE)).unwrap();
    let all = results(&problem, &designs, &plan);
    let mut rows = 0;
    for (chunk, bytes) in all {
        let table = read_chunk(plan.format, &chunk.name, bytes).unwrap();
        let notations = table.texts("notation").unwrap();
        let Some(ColumnValues::Real(means)) = table.get("mean_pdop") else {
            panic!("no numbers");
        };
        for (notation, mean) in notations.iter().zip(means) {
            let design = notation.as_deref().unwrap().parse().unwrap();
            let alone = evaluator.evaluate(&design).unwrap();
            assert_eq!(*mean, alone.mean_pdop);
        }
        rows += table.rows();
    }
    // 3 numbers of planes x 2 of satellites x 3 inclinations x 5 altitudes, and a phasing of 1 for all.
    assert_eq!(rows, 90);
    assert_eq!(plan.points, 90);
}

/// A list is evaluated as it is, whatever the search space, with its names.
#[test]
fn a_list_keeps_its_order_and_names() {
    let scenario = scenario();
    let evaluator = Evaluator::new(setup(&scenario)).unwrap();
    let problem =
        DesignProblem::new(&evaluator, scenario.design_space(), scenario.goals()).unwrap();
    let swept = |notation: &str, name: Option<&str>| SweptDesign {
        notation: notation.to_owned(),
        name: name.map(str::to_owned),
    };
    let list = vec![
        swept("star:90:40/5/1@1100", Some("polar, \"high\"")),
        swept("delta:53:12/3/1@1000+star:90:40/5/1@1100", None),
    ];
    let text = designs_csv(&list).unwrap();
    assert_eq!(read_designs(text.as_bytes()).unwrap(), list);
    let designs = SweepDesigns::List(list);
    let plan = SweepPlan::new(
        stamp(&scenario),
        &designs,
        TableFormat::Parquet,
        (None, ONE),
    )
    .unwrap();
    let [(chunk, bytes)] = results(&problem, &designs, &plan).try_into().unwrap();
    let table = read_chunk(plan.format, &chunk.name, bytes).unwrap();
    assert_eq!(
        table.texts("name").unwrap()[0].as_deref(),
        Some("polar, \"high\"")
    );
    assert_eq!(table.texts("name").unwrap()[1], None);
    assert_eq!(
        table.get("satellites"),
        Some(&ColumnValues::Integer(vec![Some(40), Some(52)]))
    );
    // The shells of a hybrid differ, so that it has no pattern of its own.
    let patterns = table.texts("pattern").unwrap();
    assert_eq!(patterns, [Some(Pattern::Star.keyword().to_owned()), None]);
}

fn small_table() -> TypedColumns {
    TypedColumns::of_csv("notation,mean_pdop,planes\na,1.5,3\nb,,4\n").unwrap()
}

/// A file that is cut short at any byte, or has any byte changed, is not taken for the result.
#[test]
fn damaged_results_are_refused() {
    for format in [TableFormat::Parquet, TableFormat::Csv] {
        let bytes = write_chunk(format, "a chunk", small_table()).unwrap();
        assert_eq!(
            read_chunk(format, "a chunk", bytes.clone()),
            Ok(small_table())
        );
        assert_eq!(
            read_chunk(format, "another", bytes.clone()),
            Err(ChunkError::Other)
        );
        for length in 0..bytes.len() {
            let cut = read_chunk(format, "a chunk", bytes[..length].to_vec());
            assert!(cut.is_err(), "{format} of {length} bytes");
        }
        for place in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[place] ^= 1;
            let read = read_chunk(format, "a chunk", changed);
            assert!(read.is_err(), "{format} at {place}");
        }
    }
}

/// The name covers the version, the scenario and every design; what is changed on its way is noticed.
#[test]
fn a_chunk_is_named_by_all_that_it_depends_on() {
    let design = |notation: &str| SweptDesign {
        notation: notation.to_owned(),
        name: None,
    };
    let list = vec![design("delta:55:4/2/1@925"), design("delta:55:6/2/1@925")];
    let scenario = scenario();
    let plan = SweepPlan::new(
        stamp(&scenario),
        &SweepDesigns::List(list.clone()),
        TableFormat::Csv,
        (Some(2), ONE),
    )
    .unwrap();
    let chunk = SweepChunk::new(&plan, list.clone());
    assert!(chunk.is_intact());
    let mut version = plan.clone();
    version.version += "x";
    let mut hash = plan.clone();
    hash.scenario.hash += "x";
    let others = [
        SweepChunk::new(&version, list.clone()),
        SweepChunk::new(&hash, list.clone()),
        SweepChunk::new(&plan, list[..1].to_vec()),
        SweepChunk::new(&plan, list.iter().rev().cloned().collect()),
    ];
    assert!(others.iter().all(|other| other.name != chunk.name));
    let mut changed = chunk.clone();
    changed.designs[0].notation = "delta:55:4/2/0@925".to_owned();
    assert!(!changed.is_intact());
    assert_eq!(
        version.difference(&plan),
        Some(format!(
            "the version is {VERSION}x there and {VERSION} here"
        ))
    );
    assert_eq!(plan.difference(&plan), None);
}

/// The default size makes chunks of 1 to 10 s by the times measured, on a quiet machine but for the third: the paper's design in 4 ms,
/// the globe in 90 ms, and the paper's by ten minutes in 1.6 ms on a machine that others used too.
#[test]
fn chunks_take_seconds() {
    for (points, instants, measured_s) in
        [(143, 1440, 4.2e-3), (2522, 1440, 90e-3), (143, 144, 1.6e-3)]
    {
        let samples = SampleShape { points, instants };
        let time_s = chunk_size(samples, 182.0) as f64 * measured_s;
        assert!((1.0..10.0).contains(&time_s), "{time_s}");
    }
    let huge = SampleShape {
        points: usize::MAX,
        instants: 1,
    };
    assert_eq!((chunk_size(ONE, 1.0), chunk_size(huge, 1e4)), (29_996, 1));
}

/// No design of the space is met twice, although its grid has points that stand for others.
#[test]
fn points_of_one_design_are_swept_once() {
    let text = SMALL.replace(
        "search.altitude-deg = [800, 1000]",
        "search.phasing = [0, 4]",
    );
    let scenario = Scenario::parse("small.toml", text.as_bytes(), &[] as &[String]).unwrap();
    let evaluator = Evaluator::new(setup(&scenario)).unwrap();
    let problem =
        DesignProblem::new(&evaluator, scenario.design_space(), scenario.goals()).unwrap();
    let designs = SweepDesigns::of_space(&problem);
    let points = designs.points().unwrap();
    let mut all: Vec<String> = designs
        .at(0..points)
        .unwrap()
        .into_iter()
        .map(|one| one.notation)
        .collect();
    let found = all.len();
    assert!((found as u64) < points);
    all.sort();
    all.dedup();
    assert_eq!(all.len(), found);
    assert_eq!(designs.vectors(0..points).unwrap().len(), found);
    assert_eq!(
        problem.space().variables().len(),
        designs.vectors(0..1).unwrap()[0].len()
    );
}
