//! Properties over random input.

use chrono::DateTime;
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::sample::{select, subsequence};

mod spaces;

use super::parse;
use crate::ground::{AreaPoints, Country, EqualAreaCells};
use crate::scenario::{
    Algorithm, AreaSource, Clocks, ConstellationParts, Constraint, Earth, Export, FurtherMetrics,
    GnssSetup, Grid, Keyword, LaunchCost, LeoClocks, MaskPoint, NamedConstellation, Objectives,
    Optimizer, Pattern, Preset, Propagation, Quantity, RangeErrors, Region, RegionTerrain,
    RegionWeightGrid, Relation, Reliability, SatelliteOutages, Scenario, SearchShells, SearchSpace,
    TimeSpan, Visibility, template,
};
use spaces::search;

fn word<T: Keyword + std::fmt::Debug>() -> impl Strategy<Value = T> {
    select(T::ALL)
}

fn some<T: Keyword + std::fmt::Debug>(least: usize) -> impl Strategy<Value = Vec<T>> {
    subsequence(T::ALL.to_vec(), least..=T::ALL.len()).prop_shuffle()
}

fn rising<T: Clone + PartialOrd + std::fmt::Debug>(
    value: impl Strategy<Value = T> + Clone,
) -> impl Strategy<Value = [T; 2]> {
    (value.clone(), value).prop_map(|(a, b)| if a <= b { [a, b] } else { [b, a] })
}

/// Range errors of all systems, so that every quantity can be computed.
fn all_range_errors() -> RangeErrors {
    let elevation = Some([0.5, 0.25]);
    RangeErrors {
        leo_m: Some(0.5),
        leo_elevation: elevation,
        beidou_3_m: Some(0.6),
        beidou_3_elevation: None,
        gps_m: Some(0.7),
        gps_elevation: elevation,
        galileo_m: Some(0.8),
        galileo_elevation: None,
        glonass_m: Some(0.9),
        glonass_elevation: elevation,
        qzss_m: Some(1.0),
        qzss_elevation: None,
        navic_m: Some(1.1),
        navic_elevation: elevation,
        files_m: Some(1.2),
        files_elevation: None,
    }
}

/// A path with the characters that need escaping.
fn file() -> impl Strategy<Value = String> {
    "[a-z\"\\\\'#= /é]{0,12}\\.csv"
}

fn instant() -> impl Strategy<Value = DateTime<chrono::Utc>> {
    // 1972-01-01 to 2100-12-31 in nanoseconds, and inside a leap second.
    let any = (63_072_000_000_000_000..4_133_894_400_000_000_000_i64)
        .prop_map(DateTime::from_timestamp_nanos);
    let leap = (1_000_000_000..2_000_000_000_u32)
        .prop_map(|ns| DateTime::from_timestamp(1_483_228_799, ns).unwrap());
    prop_oneof![9 => any, 1 => leap]
}

fn region() -> impl Strategy<Value = Region> {
    let grid = (
        rising(-90.0..=90.0),
        -360.0..=360.0,
        0.0..=360.0,
        [0.5..=360.0, 0.5..=360.0],
        word(),
    );
    let grid = grid.prop_map(|(latitude_deg, west, span, step_deg, weights)| {
        let east: f64 = west + span;
        // Adding rounds; keep what a file could hold.
        let east = if east - west > 360.0 { west } else { east };
        Region::Grid(Grid {
            latitude_deg,
            longitude_deg: [west, east],
            step_deg,
            weights,
        })
    });
    let grid = grid.boxed();
    let limits = grid.clone();
    let cells = (limits, 500.0..=20_000.0).prop_map(|(region, spacing_km)| match region {
        Region::Grid(grid) => Region::Cells(EqualAreaCells {
            latitude_deg: grid.latitude_deg,
            longitude_deg: grid.longitude_deg,
            spacing_km,
        }),
        other => other,
    });
    let countries: Vec<Country> = Country::all().collect();
    let source = prop_oneof![
        file().prop_map(|file| AreaSource::Polygon { file }),
        subsequence(countries, 1..4).prop_map(AreaSource::Countries),
    ];
    let points = prop_oneof![
        (0.1..=20_000.0).prop_map(|spacing_km| AreaPoints::Cells { spacing_km }),
        ([0.5..=360.0, 0.5..=360.0], word())
            .prop_map(|(step_deg, weights)| AreaPoints::Lattice { step_deg, weights }),
    ];
    let area = (source, points).prop_map(|(source, points)| Region::Area { source, points });
    prop_oneof![
        grid,
        cells,
        area,
        file().prop_map(|file| Region::Points { file })
    ]
}

fn visibility() -> impl Strategy<Value = Visibility> {
    let point = (0.0..360.0, 0.0..90.0);
    let table = vec(point, 0..5).prop_map(|mut points: Vec<(f64, f64)>| {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup_by_key(|point| point.0);
        // Once around the horizon, with one mask in the north.
        if let Some(first) = points.first_mut() {
            first.0 = 0.0;
            let north = first.1;
            points.push((360.0, north));
        }
        let point = |(azimuth_deg, mask_deg)| MaskPoint {
            azimuth_deg,
            mask_deg,
        };
        points.into_iter().map(point).collect()
    });
    (0.0..90.0, 0.0..90.0, table, word(), 1.01..1e6).prop_map(
        |(mask_deg, gnss_mask_deg, mask_table, weighting, pdop_cap)| Visibility {
            mask_deg,
            gnss_mask_deg,
            mask_table,
            weighting,
            pdop_cap,
        },
    )
}

fn gnss() -> impl Strategy<Value = GnssSetup> {
    (some::<Preset>(0), vec(file(), 0..3), word(), word()).prop_map(
        |(constellations, mut files, clocks, leo_clocks)| {
            files.dedup();
            files.truncate(2);
            GnssSetup {
                constellations,
                files,
                clocks,
                leo_clocks: match clocks {
                    Clocks::PerSystem => leo_clocks,
                    Clocks::Shared => LeoClocks::Shared,
                },
            }
        },
    )
}

fn texts(least: usize) -> impl Strategy<Value = Vec<String>> {
    vec(file(), least..3).prop_map(|mut texts| {
        texts.dedup();
        texts
    })
}

fn constellations() -> impl Strategy<Value = Vec<NamedConstellation>> {
    let design = select(vec![
        "delta:55:182/13/1@925",
        "delta:53:160/10/1@1000.5+star:90:40/5/1@1100,raan=10,u=0.5",
        "lattice:63.4:182/13/5@950,e=0.01,w=270",
    ]);
    let design = design.prop_map(|notation| notation.parse().unwrap());
    let files = (texts(1), option::of(word()), texts(0), texts(0));
    let parts = (design, 0..3_u8, files).prop_map(|(design, kind, files)| {
        let (files, input_format, only, exclude) = files;
        if kind == 0 {
            return ConstellationParts::of_design(design);
        }
        ConstellationParts {
            design: (kind == 1).then_some(design),
            files,
            input_format,
            only,
            exclude,
        }
    });
    let named = ("[A-Za-z0-9_-]{1,8}", parts);
    let named = named.prop_map(|(name, parts)| NamedConstellation { name, parts });
    vec(named, 0..4).prop_map(|mut all| {
        let mut names = Vec::new();
        all.retain(|one| {
            let is_new = !names.contains(&one.name);
            names.push(one.name.clone());
            is_new
        });
        all
    })
}

fn objectives() -> impl Strategy<Value = Objectives> {
    let constraint = (word::<Quantity>(), word::<Relation>(), -1e9..1e9).prop_map(
        |(quantity, relation, bound): (Quantity, Relation, f64)| Constraint {
            quantity,
            relation,
            bound: match quantity.is_fraction() {
                true => bound.abs() / 1e9,
                false => bound,
            },
        },
    );
    let scalars = (0.0..1e300, 0.001..0.999, 0.1..50.0, launch_cost());
    let lists = (
        some::<Quantity>(1),
        vec(constraint, 0..4),
        any::<bool>(),
        -1e3..1e3,
    );
    (scalars, lists).prop_map(|(scalars, lists)| {
        let (cvar_weight, cvar_level, availability_pdop, launch_cost) = scalars;
        let (minimize, mut constraints, given, coordinate) = lists;
        // One bound of each quantity: two may contradict each other.
        let mut bounded = Vec::new();
        constraints.retain(|one| {
            let is_new = !bounded.contains(&one.quantity);
            bounded.push(one.quantity);
            is_new
        });
        let usual: Option<Vec<f64>> = minimize
            .iter()
            .map(|quantity| quantity.default_reference())
            .collect();
        let reference = vec![coordinate; minimize.len()];
        Objectives {
            hypervolume_reference: if given { Some(reference) } else { usual },
            minimize,
            cvar_weight,
            cvar_level,
            constraints,
            availability_pdop,
            launch_cost,
        }
    })
}

fn launch_cost() -> impl Strategy<Value = LaunchCost> {
    let costs = (0.0..1e12, 0.0..1e12, 0.0..1e12);
    costs.prop_map(|(per_satellite, per_plane, per_1000_km)| LaunchCost {
        per_satellite,
        per_plane,
        per_1000_km,
    })
}

fn optimizer() -> impl Strategy<Value = Optimizer> {
    // Exhaustive searches have a bound of their own on the search space.
    let algorithm = select(vec![Algorithm::Nsga2, Algorithm::Mopso, Algorithm::Random]);
    let numbers = (
        4..=10_000_u32,
        1..=1_000_000_u32,
        0.0..=1.0,
        0.0..=1.0,
        any::<u64>(),
    );
    let indices = (0.0..1e3, 0.0..1e3);
    (algorithm, numbers, indices).prop_map(|(algorithm, numbers, indices)| {
        let (crossover_index, mutation_index) = indices;
        let (population, generations, crossover_probability, mutation_probability, seed) = numbers;
        Optimizer {
            algorithm,
            population,
            generations,
            crossover_probability,
            mutation_probability,
            crossover_index,
            mutation_index,
            seed,
        }
    })
}

fn scenario() -> impl Strategy<Value = Scenario> {
    let texts = (
        "[A-Za-z0-9][A-Za-z0-9._-]{0,20}",
        "[a-z:/@\"\\\\é0-9]{1,20}",
        "[!-~]{1,20}",
        ("[A-Za-z][A-Za-z0-9-]{0,7}", 1..=339_999_u32),
    );
    let time =
        (instant(), 0.1..8.0, 60.0..170.0).prop_map(|(epoch, duration_h, step_s)| TimeSpan {
            epoch,
            duration_h,
            step_s,
        });
    let setting = (
        word(),
        word(),
        (region(), proptest::option::of((file(), 0.0..=1000.0))),
        visibility(),
        gnss(),
        constellations(),
    );
    let purpose = (objectives(), search(), optimizer(), instant());
    (texts, time, setting, purpose).prop_map(|(texts, time, setting, purpose)| {
        let (name, reference_design, originator, identities) = texts;
        let (name_prefix, first_catalog_number) = identities;
        let (surface, model, (region, terrain), mut visibility, mut gnss, constellations) = setting;
        if terrain.is_some() {
            visibility.mask_table.clear();
        }
        let (terrain, antenna_height_m) = terrain.unzip();
        let (objectives, search, optimizer, creation_date) = purpose;
        let bounded = objectives.constraints.iter().map(|one| one.quantity);
        let mut goals = objectives.minimize.iter().copied().chain(bounded);
        // A gain is over a GNSS.
        if goals.any(|one| one.gain_in().is_some()) && gnss.files.is_empty() {
            gnss.constellations.retain(|one| *one != Preset::Beidou3);
            gnss.constellations.push(Preset::Beidou3);
        }
        Scenario {
            name,
            reference_design,
            constellations,
            time,
            earth: Earth { surface },
            propagation: Propagation { model },
            region,
            weighting: RegionWeightGrid { weight_grid: None },
            terrain: RegionTerrain {
                terrain,
                antenna_height_m,
            },
            visibility,
            gnss,
            outages: SatelliteOutages {
                satellites: vec!["NW-P01-S02".to_owned(), "gps:A3".to_owned()],
                file: vec!["outages.csv".to_owned()],
            },
            reliability: Reliability {
                availability: None,
                mtbf_h: Some(1000.0),
                mttr_h: Some(0.0),
                // The objectives may have expected-availability, which is without.
                spares_per_plane: None,
            },
            accuracy: all_range_errors(),
            metrics: FurtherMetrics {
                // Longer than the longest step, and within the span.
                window_min: Some(time.duration_h * 30.0),
            },
            objectives,
            search,
            optimizer,
            export: Export {
                originator,
                creation_date,
                name_prefix,
                first_catalog_number,
            },
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn canonical_text_parses_back_to_the_same_scenario(scenario in scenario()) {
        let text = scenario.to_toml();
        let back = parse(&text, &[]).map_err(|problems| TestCaseError::fail(problems.to_string()))?;
        prop_assert_eq!(&back, &scenario);
        prop_assert_eq!(back.to_toml(), text);
        prop_assert_eq!(back.hash(&[]), scenario.hash(&[]));
    }

    #[test]
    fn arbitrary_bytes_are_a_scenario_or_problems(bytes in vec(any::<u8>(), 0..200)) {
        check(&bytes, &[]);
    }

    #[test]
    fn arbitrary_arguments_are_a_scenario_or_problems(argument in ".*", value in ".*") {
        check(b"", &[&argument, &format!("region.points={value}"), &format!("time.epoch={value}")]);
    }

    #[test]
    fn arbitrary_values_are_a_scenario_or_problems(
        at in any::<prop::sample::Index>(),
        value in prop_oneof![
            "[-+0-9.eExXinf_]{1,12}", "\\[[-0-9., \\[\\]\"]{0,20}\\]", "\"[^\"\\\\\n]{0,12}\"",
        ],
    ) {
        let template = template();
        let mut lines: Vec<String> = template.lines().map(str::to_owned).collect();
        let keys: Vec<usize> = (0..lines.len()).filter(|line| lines[*line].contains(" = ")).collect();
        let line = &mut lines[keys[at.index(keys.len())]];
        let name = line.split(" = ").next().unwrap_or_default().trim_start_matches("# ");
        *line = format!("{name} = {value}");
        check(lines.join("\n").as_bytes(), &[]);
    }

    #[test]
    fn damaged_files_are_a_scenario_or_problems(
        at in any::<prop::sample::Index>(),
        length in 0..40_usize,
        patch in vec(any::<u8>(), 0..8),
    ) {
        let mut bytes = template().into_bytes();
        let from = at.index(bytes.len());
        let to = (from + length).min(bytes.len());
        bytes.splice(from..to, patch);
        check(&bytes, &[]);
    }
}

/// Bytes give a scenario that its own text gives again, or problems that can be shown.
fn check(bytes: &[u8], overrides: &[&str]) {
    match Scenario::parse("random.toml", bytes, overrides) {
        Ok(scenario) => assert_eq!(parse(&scenario.to_toml(), &[]).unwrap(), scenario),
        Err(problems) => {
            assert!(!problems.as_slice().is_empty());
            assert!(!problems.to_string().is_empty());
        }
    }
}
