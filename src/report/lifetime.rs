//! What years do to the shells of a design, as text, JSON and CSV.

mod csv;

pub use csv::lifetimes_csv;

use super::{Align, Table};
use crate::constellation::relative_nodes::RelativeNode;
use crate::constellation::{Design, Shell, Slot, shell_letters};
use crate::keyword::Keyword;
use crate::orbit::MeanElements;
use crate::orbit::atmosphere::{ALTITUDES_KM, SolarActivity};
use crate::orbit::drag::{
    DEORBIT_PERIGEE_KM, DragError, DragOrbit, DragSpacecraft, REENTRY_ALTITUDE_KM, hohmann_m_s,
    perigee_lowering_m_s,
};
use crate::orbit::injection::InjectionSpread;
use crate::orbit::j2::SecularRates;
use crate::units::{DAYS_PER_YEAR, SECONDS_PER_DAY, round_decimal};
use serde::Serialize;
use std::fmt::Write;

/// Years in which a satellite must be down after its mission: FCC 22-74 (2022), and the guidelines of the IADC and ISO 24113 before.
const RULES_YEARS: [f64; 2] = [5.0, 25.0];

/// Years over which rates are compared.
const COMPARED_YEARS: f64 = 5.0;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LifetimeOptions {
    /// The satellites.
    pub spacecraft: DragSpacecraft,
    /// Half the width of the box along the track, km.
    pub box_km: f64,
    /// One sigma of the semi-major axis at injection, km.
    pub sigma_a_km: f64,
    /// One sigma of the inclination at injection, degrees.
    pub sigma_i_deg: f64,
}

/// What years do to a design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DesignLifetime {
    /// The design.
    pub notation: String,
    /// Drag coefficient times area by mass, m²/kg.
    pub ballistic_m2_kg: f64,
    /// Half the width of the box along the track, km.
    pub box_km: f64,
    /// One sigma of the semi-major axis at injection, km.
    pub sigma_a_km: f64,
    /// One sigma of the inclination at injection, degrees.
    pub sigma_i_deg: f64,
    /// Each shell.
    pub shells: Vec<ShellLifetime>,
    /// Each two shells of a hybrid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub relative_nodes: Vec<RelativeNodeRates>,
}

/// What years do to a shell.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShellLifetime {
    /// The shell.
    pub notation: String,
    /// Rate of the node under secular J2, as designs have it, degrees a day.
    pub node_j2_deg_per_day: f64,
    /// The same with J2² and J4, degrees a day.
    pub node_zonal_deg_per_day: f64,
    /// By how much the node differs after five years, degrees.
    pub node_off_in_5_years_deg: f64,
    /// Rates of the argument of perigee; `None` on a circle, which has none.
    pub perigee: Option<PerigeeRates>,
    /// Shift of the mean semi-major axis that keeps the period of J2 with J2² and J4, m.
    pub semi_major_axis_shift_m: f64,
    /// At low, moderate and high solar activity; none on ellipses.
    pub drag: Vec<DragResult>,
    /// What lowering the perigee to 50 km takes, m/s; `None` on ellipses.
    pub deorbit_m_s: Option<f64>,
    /// What errors of injection do.
    pub injection: InjectionResult,
}

/// How fast the perigee of an ellipse turns.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PerigeeRates {
    /// Under secular J2, as designs have it, degrees a day.
    pub j2_deg_per_day: f64,
    /// With J2² and J4, degrees a day.
    pub zonal_deg_per_day: f64,
}

/// A shell in the atmosphere of a solar activity; what needs a density is `None` above 1500 km.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DragResult {
    /// The activity.
    pub activity: String,
    /// Mean density, kg/m³.
    pub density_kg_m3: Option<f64>,
    /// Altitude lost in a day without control, m.
    pub decay_m_per_day: Option<f64>,
    /// What making up for it takes in a year, m/s.
    pub make_up_m_s_per_year: Option<f64>,
    /// Between the manoeuvres that keep the box, days.
    pub keeping_interval_days: Option<f64>,
    /// Of each of them, m/s.
    pub keeping_m_s: Option<f64>,
    /// Until it is down without control, years.
    pub decay_years: Option<f64>,
    /// What it takes to be down within 5 and within 25 years.
    pub disposals: [DisposalResult; 2],
}

/// A circular altitude low enough to be down within some years.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DisposalResult {
    /// The years.
    pub years: f64,
    /// The highest such altitude, km.
    pub altitude_km: Option<f64>,
    /// What lowering to it takes, m/s; 0 if that is where the shell is.
    pub delta_v_m_s: Option<f64>,
}

/// What errors of injection do, one sigma.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InjectionResult {
    /// Spread of the argument of latitude, degrees a day.
    pub phase_deg_per_day: f64,
    /// Spread of the node, degrees a year.
    pub node_deg_per_year: f64,
    /// What correcting the semi-major axis takes, m/s.
    pub semi_major_axis_m_s: f64,
    /// What correcting the inclination takes, m/s.
    pub inclination_m_s: f64,
}

/// How fast the nodes of two shells turn against each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RelativeNodeRates {
    /// Their letters.
    pub shells: [String; 2],
    /// By secular J2, degrees a day.
    pub j2_deg_per_day: f64,
    /// With J2² and J4, degrees a day.
    pub zonal_deg_per_day: f64,
}

impl DesignLifetime {
    /// Of a design.
    ///
    /// # Errors
    /// If a shell is in the atmosphere.
    pub fn of(design: &Design, options: &LifetimeOptions) -> Result<Self, DragError> {
        let shells: Result<Vec<_>, _> = design
            .shells()
            .iter()
            .map(|shell| ShellLifetime::of(shell, options))
            .collect();
        let shells = shells?;
        let pairs = RelativeNode::all_of(design).into_iter();
        let relative_nodes = pairs.map(|pair| RelativeNodeRates::of(&shells, &pair));
        Ok(Self {
            notation: design.to_string(),
            ballistic_m2_kg: options.spacecraft.ballistic_m2_kg(),
            box_km: options.box_km,
            sigma_a_km: options.sigma_a_km,
            sigma_i_deg: options.sigma_i_deg,
            relative_nodes: relative_nodes.collect(),
            shells,
        })
    }
}

impl RelativeNodeRates {
    fn of(shells: &[ShellLifetime], pair: &RelativeNode) -> Self {
        let [one, other] = pair.shells.map(|n| shells[n].node_zonal_deg_per_day);
        Self {
            shells: pair.shells.map(shell_letters),
            j2_deg_per_day: pair.rate_deg_per_day,
            zonal_deg_per_day: other - one,
        }
    }
}

impl ShellLifetime {
    fn of(shell: &Shell, options: &LifetimeOptions) -> Result<Self, DragError> {
        let elements = shell.elements(Slot::FIRST);
        let [j2, zonal] = [SecularRates::j2(&elements), SecularRates::zonal(&elements)];
        let per_day = |rate_rad_s: f64| rate_rad_s.to_degrees() * SECONDS_PER_DAY;
        let [node_j2, node_zonal] = [j2, zonal].map(|rates| per_day(rates.raan_rad_s));
        let faster = zonal.arg_latitude_rad_s() - j2.arg_latitude_rad_s();
        let shift_km =
            faster / (1.5 * elements.kepler_mean_motion_rad_s()) * elements.semi_major_axis_km;
        Ok(Self {
            notation: Design::from(*shell).to_string(),
            node_j2_deg_per_day: node_j2,
            node_zonal_deg_per_day: node_zonal,
            node_off_in_5_years_deg: (node_zonal - node_j2) * COMPARED_YEARS * DAYS_PER_YEAR,
            perigee: (!is_circular(shell)).then(|| PerigeeRates {
                j2_deg_per_day: per_day(j2.arg_perigee_rad_s),
                zonal_deg_per_day: per_day(zonal.arg_perigee_rad_s),
            }),
            semi_major_axis_shift_m: shift_km * 1e3,
            drag: DragResult::of_shell(shell, &elements, options)?,
            deorbit_m_s: is_circular(shell)
                .then(|| perigee_lowering_m_s(shell.altitude_km(), DEORBIT_PERIGEE_KM)),
            injection: InjectionResult::of(&elements, options),
        })
    }
}

fn is_circular(shell: &Shell) -> bool {
    shell.eccentricity() == 0.0
}

impl DragResult {
    /// At each activity; none on an ellipse, whose perigee must be above the atmosphere all the same.
    fn of_shell(
        shell: &Shell,
        elements: &MeanElements,
        options: &LifetimeOptions,
    ) -> Result<Vec<Self>, DragError> {
        let perigee_km = shell.altitude_km() - elements.semi_major_axis_km * elements.eccentricity;
        let orbit = |activity: SolarActivity| {
            let craft = options.spacecraft;
            DragOrbit::new(perigee_km, elements.inclination_rad, craft, activity)
        };
        if !is_circular(shell) {
            return orbit(SolarActivity::Low).map(|_| Vec::new());
        }
        let of = |activity: &SolarActivity| {
            let orbit = orbit(*activity)?;
            Ok(Self::of(
                &orbit,
                shell.altitude_km(),
                *activity,
                options.box_km,
            ))
        };
        SolarActivity::ALL.iter().map(of).collect()
    }

    fn of(orbit: &DragOrbit, altitude_km: f64, activity: SolarActivity, box_km: f64) -> Self {
        let keeping = orbit.slot_keeping(box_km);
        let disposal = |years| {
            let to_km = orbit.altitude_of_decay_within_km(years);
            DisposalResult {
                years,
                altitude_km: to_km,
                delta_v_m_s: to_km.map(|to_km| hohmann_m_s(altitude_km, to_km)),
            }
        };
        Self {
            activity: activity.to_string(),
            density_kg_m3: orbit.density_kg_m3(),
            decay_m_per_day: orbit.decay_m_s().map(|rate| rate * SECONDS_PER_DAY),
            make_up_m_s_per_year: orbit.make_up_m_s_per_year(),
            keeping_interval_days: keeping.map(|of| of.interval_days),
            keeping_m_s: keeping.map(|of| of.delta_v_m_s),
            decay_years: orbit.years_down_to(REENTRY_ALTITUDE_KM),
            disposals: RULES_YEARS.map(disposal),
        }
    }
}

impl InjectionResult {
    fn of(elements: &MeanElements, options: &LifetimeOptions) -> Self {
        let sigma_i_rad = options.sigma_i_deg.to_radians();
        let spread = InjectionSpread::of(elements, options.sigma_a_km, sigma_i_rad);
        let per_day = |rate_rad_s: f64| rate_rad_s.to_degrees() * SECONDS_PER_DAY;
        Self {
            phase_deg_per_day: per_day(spread.arg_latitude_rad_s),
            node_deg_per_year: per_day(spread.raan_rad_s) * DAYS_PER_YEAR,
            semi_major_axis_m_s: spread.semi_major_axis_m_s,
            inclination_m_s: spread.inclination_m_s,
        }
    }
}

/// The results for a terminal.
#[must_use]
pub fn lifetimes_text(designs: &[DesignLifetime]) -> String {
    let mut text = String::new();
    for (n, design) in designs.iter().enumerate() {
        for (m, shell) in design.shells.iter().enumerate() {
            if n + m > 0 {
                text.push('\n');
            }
            shell_text(&mut text, design, shell);
        }
        for pair in &design.relative_nodes {
            let _ = writeln!(
                text,
                "\nnode of {} against that of {}: {:+.4} deg/day by J2, {:+.4} with J2² and J4",
                pair.shells[1], pair.shells[0], pair.j2_deg_per_day, pair.zonal_deg_per_day
            );
        }
    }
    text
}

fn shell_text(text: &mut String, design: &DesignLifetime, shell: &ShellLifetime) {
    let _ = writeln!(
        text,
        "{}\n\nrate of the node {:+.5} deg/day by J2, {:+.5} with J2² and J4: a difference of {:+.2} deg in 5 years",
        shell.notation,
        round_decimal(shell.node_j2_deg_per_day, 5),
        round_decimal(shell.node_zonal_deg_per_day, 5),
        round_decimal(shell.node_off_in_5_years_deg, 2)
    );
    if let Some(perigee) = shell.perigee {
        let _ = writeln!(
            text,
            "rate of the argument of perigee {:+.5} deg/day by J2, {:+.5} with J2² and J4",
            round_decimal(perigee.j2_deg_per_day, 5),
            round_decimal(perigee.zonal_deg_per_day, 5)
        );
    }
    let _ = writeln!(
        text,
        "the same nodal period with J2² and J4: mean semi-major axis {:+.1} m\n",
        shell.semi_major_axis_shift_m
    );
    if shell.drag.is_empty() {
        text.push_str("drag and decay are computed for circular orbits only\n");
    } else {
        let craft = design.ballistic_m2_kg;
        let _ = writeln!(text, "drag, for C_D A/m = {craft:.4} m²/kg");
        text.push_str(&drag_table(design, &shell.drag).to_text());
        if shell.drag.iter().any(|of| of.density_kg_m3.is_none()) {
            let top_km = ALTITUDES_KM[1];
            let _ = writeln!(
                text,
                "-: above {top_km} km the density is not tabulated, and drag does not matter"
            );
        }
    }
    if let Some(deorbit) = shell.deorbit_m_s {
        let _ = writeln!(
            text,
            "lowering the perigee to {DEORBIT_PERIGEE_KM:.0} km takes {deorbit:.1} m/s"
        );
    }
    let injection = &shell.injection;
    let _ = writeln!(
        text,
        "\nerrors of injection of {} km and {} deg (one sigma): phase {:.4} deg/day, node {:.3} deg/year; \
         correcting them takes {:.3} and {:.3} m/s",
        design.sigma_a_km,
        design.sigma_i_deg,
        injection.phase_deg_per_day,
        injection.node_deg_per_year,
        injection.semi_major_axis_m_s,
        injection.inclination_m_s
    );
}

fn drag_table(design: &DesignLifetime, drag: &[DragResult]) -> Table {
    let mut columns = vec![("solar activity", Align::Left)];
    columns.extend(drag.iter().map(|of| (of.activity.as_str(), Align::Right)));
    let mut table = Table::new(&columns);
    let mut row = |name: String, of: &dyn Fn(&DragResult) -> String| {
        table.row(std::iter::once(name).chain(drag.iter().map(of)));
    };
    row("mean density (kg/m³)".into(), &|of| {
        of.density_kg_m3.map_or_else(none, |x| format!("{x:.2e}"))
    });
    row("altitude lost without control (m/day)".into(), &|of| {
        fixed(of.decay_m_per_day, 2)
    });
    row("drag make-up (m/s a year)".into(), &|of| {
        fixed(of.make_up_m_s_per_year, 3)
    });
    row(
        format!(
            "manoeuvres for ±{} km along the track (days between)",
            design.box_km
        ),
        &|of| fixed(of.keeping_interval_days, 1),
    );
    row("each of (mm/s)".into(), &|of| {
        fixed(of.keeping_m_s.map(|x| x * 1e3), 1)
    });
    row(
        "decay without control (years)".into(),
        &|of| match of.decay_years {
            Some(years) if years > 1e4 => "> 10000".to_owned(),
            Some(years) if years >= 100.0 => format!("{years:.0}"),
            years => fixed(years, 1),
        },
    );
    for (n, years) in RULES_YEARS.iter().enumerate() {
        row(format!("down within {years} years from (km)"), &|of| {
            fixed(of.disposals[n].altitude_km, 0)
        });
        row("lowering to there takes (m/s)".into(), &|of| {
            fixed(of.disposals[n].delta_v_m_s, 1)
        });
    }
    table
}

fn none() -> String {
    "-".to_owned()
}

fn fixed(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(none, |value| format!("{value:.digits$}"))
}
