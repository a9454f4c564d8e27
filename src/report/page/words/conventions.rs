//! The conventions behind the numbers of the page.

use crate::earth;
use crate::keyword::Keyword;
use crate::report::page::Page;
use crate::run::VERSION;
use crate::scenario::{LeoClocks, ObservationWeights, Region, Scenario};
use crate::time::leap_seconds_note;

/// The conventions behind the numbers.
pub(in crate::report::page) fn conventions(page: &Page<'_>) -> Vec<(&'static str, String)> {
    let run = page.run;
    let mut rows = vec![
        (
            "Constants",
            format!(
                "\u{3bc} = {} km\u{b3}/s\u{b2}, R = {} km, J2 = {:e} (EGM96), f = 1/298.257223563",
                earth::MU_KM3_S2,
                earth::RADIUS_KM,
                earth::J2
            ),
        ),
        (
            "Frames",
            "mean elements and propagation in TEME; Earth-fixed by GMST (IAU 1982), UT1 = UTC at the \
             epoch, no polar motion"
                .to_owned(),
        ),
        (
            "Time",
            format!(
                "SI seconds from the epoch; the Earth rotates evenly through leap seconds; {}",
                leap_seconds_note()
            ),
        ),
        (
            "PDOP",
            match run.scenario.as_ref().map(|s| s.visibility.weighting) {
                None | Some(ObservationWeights::Unit) => "unit-weight least squares".to_owned(),
                Some(weighting) => format!("least squares with weights {weighting}"),
            } + "; unsolved samples are excluded",
        ),
        (
            "Quantiles and CVaR",
            "order statistics; CVaR is the mean of the worst 1 - \u{3b1} of the samples, with fractional weight \
             on the quantile (Rockafellar and Uryasev)"
                .to_owned(),
        ),
    ];
    if let Some(scenario) = &run.scenario {
        rows.extend(of_scenario(scenario));
        rows.extend(phase(scenario).map(|text| ("GNSS phase", text)));
        rows.extend(metres(scenario).map(|text| ("Metres", text)));
        rows.extend(window(scenario).map(|text| ("PDOP of a window", text)));
    }
    let of_search = run.search.as_ref().map(|search| &search.scenario);
    if let Some(stamp) = of_search.or(page.stamp) {
        rows.push(("Scenario hash", stamp.hash.clone()));
    }
    rows.push(match (&run.search, page.stamp) {
        (None, Some(_)) => ("Version", format!("this page by navwalker {VERSION}")),
        (search, _) => {
            let by = search.as_ref().map_or("unknown", |search| &search.version);
            let text = format!("run by navwalker {by}; this page by navwalker {VERSION}");
            ("Versions", text)
        }
    });
    rows.push((
        "Credits",
        "figures by plotly.js (MIT licence), through the plotly crate; coastlines from Natural Earth \
         (public domain)"
            .to_owned(),
    ));
    rows
}

fn of_scenario(scenario: &Scenario) -> Vec<(&'static str, String)> {
    let objectives = &scenario.objectives;
    vec![
        ("Surface", scenario.earth.surface.to_string()),
        ("LEO propagation", scenario.propagation.model.to_string()),
        ("Receiver clocks", clocks(scenario)),
        ("Masks", masks(scenario)),
        (
            "Unsolved",
            format!(
                "no solution, or PDOP above {}",
                scenario.visibility.pdop_cap
            ),
        ),
        ("Constraints", constraints(scenario)),
        (
            "Objectives",
            format!(
                "{}; CVaR weight \u{3bb} = {}, CVaR level \u{3b1} = {}; available if PDOP is at most {}",
                run_names(scenario),
                objectives.cvar_weight,
                objectives.cvar_level,
                objectives.availability_pdop
            ),
        ),
    ]
}

fn clocks(scenario: &Scenario) -> String {
    let clocks = scenario.gnss.clocks.to_string();
    match scenario.gnss.leo_clocks {
        LeoClocks::Shared => clocks,
        LeoClocks::PerPart => {
            format!("{clocks}; one for each shell of LEO satellites, and one for those from files")
        }
    }
}

/// What a nominal constellation leaves open.
fn phase(scenario: &Scenario) -> Option<String> {
    (!scenario.gnss.constellations.is_empty()).then(|| {
        "built-in constellations begin at one arbitrary phase (\u{3a9} = M = 0 of the first satellite at the epoch, or the slots of \
         their documents); navwalker evaluate --gnss-phases N gives the spread over others"
            .to_owned()
    })
}

/// The assumptions behind the accuracy in metres.
fn metres(scenario: &Scenario) -> Option<String> {
    let errors = scenario.accuracy.in_use(&scenario.gnss);
    let texts = errors.iter().map(|(system, error)| {
        let part = match (error.constant, error.by_elevation) {
            (1.0, 0.0) => String::new(),
            (a, b) => format!(" with a = {a}, b = {b}"),
        };
        format!("{system} {} m{part}", error.sigma_m)
    });
    let texts: Vec<String> = texts.collect();
    (!texts.is_empty()).then(|| {
        format!(
            "range errors of 1 sigma: {}, times \u{221a}(a\u{b2} + b\u{b2}/sin\u{b2} E) at elevation E. They are assumed to be zero-mean, \
             Gaussian and uncorrelated between satellites, without an error of the atmosphere or of the receiver that several have in \
             common, which would not average out. A 95 % error is exceeded by 5 % of the errors at all points and instants",
            texts.join(", ")
        )
    })
}

/// What the PDOP of a window leaves out.
fn window(scenario: &Scenario) -> Option<String> {
    let window_min = scenario.metrics.window_min?;
    Some(format!(
        "all observations in {window_min} min with one position and clocks at each instant: a proxy for fast convergence, without \
         ambiguities, atmosphere or motion of the receiver"
    ))
}

/// The lowest elevations at which satellites are visible, by system and azimuth.
fn masks(scenario: &Scenario) -> String {
    let visibility = &scenario.visibility;
    let (leo, gnss) = (visibility.mask_deg, visibility.gnss_mask_deg);
    let mut text = format!("LEO {leo}\u{b0}, GNSS {gnss}\u{b0}");
    let table = &visibility.mask_table;
    if !table.is_empty() {
        let points: Vec<String> = table
            .iter()
            .map(|point| format!("{}\u{b0} at {}\u{b0}", point.mask_deg, point.azimuth_deg))
            .collect();
        text += &format!(
            "; a skyline at every point, which applies where it is higher: elevation by azimuth \
             (clockwise from north), linear between {}",
            points.join(", ")
        );
    }
    if matches!(scenario.region, Region::Points { .. }) {
        text += "; each site under the skyline that its list gives, if any";
    }
    if let Some(antenna_m) = scenario.terrain.antenna_height_m {
        text += &format!(
            "; every point without a skyline of its own under that of a terrain, with the curvature of the Earth and \
             without refraction; points without a height {antenna_m} m over it"
        );
    }
    text
}

fn constraints(scenario: &Scenario) -> String {
    let texts = scenario.objectives.constraints.iter();
    let texts: Vec<String> = texts.map(ToString::to_string).collect();
    if texts.is_empty() {
        return "none".to_owned();
    }
    texts.join(", ")
}

fn run_names(scenario: &Scenario) -> String {
    let names: Vec<&str> = scenario
        .objectives
        .minimize
        .iter()
        .map(|q| q.keyword())
        .collect();
    names.join(", ")
}
