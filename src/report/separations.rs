//! How close the satellites of designs come to each other, as text, JSON and CSV.

use super::{Align, Table};
use crate::constellation::separation::{Approach, ShellSeparation, SpanTooLarge};
use crate::constellation::{Design, Shell, Slot, shell_letters};
use crate::orbit::osculating::{frozen_eccentricity, radius_shift_km};
use crate::run::columns::optional;
use crate::run::tables::text;
use ::csv::Writer;
use serde::Serialize;
use std::io;

/// The least separation within a shell, or between two.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SeparationResult {
    /// The letters of the shell, or of two, `A-B`; `None` for a design of one shell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shells: Option<String>,
    /// The least distance over all time, km.
    pub least_km: f64,
    /// The satellites; `None` between shells of other rates.
    pub satellites: Option<[String; 2]>,
    /// Geocentric latitude, north and south, at which they are closest, degrees; `None` on ellipses, too.
    pub latitude_deg: Option<f64>,
    /// When they are for the first time, seconds after the epoch; `None` on ellipses, too.
    pub first_s: Option<f64>,
    /// The closest approach in a span, between shells of other rates and if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub within_span: Option<ApproachResult>,
}

/// The closest approach within a span.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ApproachResult {
    /// Its length, h.
    pub duration_h: f64,
    /// Distance, km.
    pub distance_km: f64,
    /// The satellites.
    pub satellites: [String; 2],
    /// Seconds after the epoch.
    pub elapsed_s: f64,
}

/// The separations of a design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DesignSeparation {
    /// The design.
    pub notation: String,
    /// The least of all, km; `None` for one satellite.
    pub least_separation_km: Option<f64>,
    /// Of each shell, and of each two.
    pub separations: Vec<SeparationResult>,
    /// By how much the periodic terms of J2 shift the mean radius of each shell, km.
    pub radius_shift_km: Vec<f64>,
    /// How far the frozen eccentricity of J3 moves satellites of each shell up and down, km; along the track it is twice as
    /// much.
    pub frozen_km: Vec<f64>,
}

impl SeparationResult {
    /// The separations of a design over all time.
    #[must_use]
    pub fn of_design(design: &Design) -> Vec<Self> {
        let all = ShellSeparation::all_of(design).into_iter();
        all.map(|one| Self::of(design, &one)).collect()
    }

    fn of(design: &Design, one: &ShellSeparation) -> Self {
        let letters = one.shells.map(shell_letters);
        let shells = if one.shells[0] == one.shells[1] {
            letters[0].clone()
        } else {
            letters.join("-")
        };
        Self {
            shells: design.only_shell().is_none().then_some(shells),
            least_km: one.least_km,
            satellites: one.pair.map(|pair| named(pair.slots)),
            latitude_deg: one.pair.and_then(|pair| pair.latitude_deg),
            first_s: one.pair.and_then(|pair| pair.first_s),
            within_span: None,
        }
    }

    /// The satellites, or why there are none.
    #[must_use]
    pub fn between(&self) -> String {
        match &self.satellites {
            Some(both) => both.join(" and "),
            None => "difference in altitude".to_owned(),
        }
    }
}

impl DesignSeparation {
    /// The separations of a design over all time, and within a span if it is given, hours.
    ///
    /// # Errors
    /// If there are too many satellites for the span.
    pub fn of(design: &Design, duration_h: Option<f64>) -> Result<Self, SpanTooLarge> {
        let mut separations = Vec::new();
        for one in ShellSeparation::all_of(design) {
            let mut result = SeparationResult::of(design, &one);
            if let Some(duration_h) = duration_h
                && one.pair.is_none()
            {
                let found = Approach::between(design, one.shells, duration_h * 3600.0)?;
                result.within_span = found.map(|found| ApproachResult {
                    duration_h,
                    distance_km: found.distance_km,
                    satellites: named(found.slots),
                    elapsed_s: found.elapsed_s,
                });
            }
            separations.push(result);
        }
        let least = separations.iter().map(|one| one.least_km);
        let elements = design
            .shells()
            .iter()
            .map(|of: &Shell| of.elements(Slot::FIRST));
        let elements: Vec<_> = elements.collect();
        Ok(Self {
            notation: design.to_string(),
            least_separation_km: least.reduce(f64::min),
            separations,
            radius_shift_km: elements.iter().map(radius_shift_km).collect(),
            frozen_km: elements
                .iter()
                .map(|of| of.semi_major_axis_km * frozen_eccentricity(of))
                .collect(),
        })
    }
}

fn named(slots: [Slot; 2]) -> [String; 2] {
    slots.map(|slot| slot.to_string())
}

/// The separations for a terminal.
#[must_use]
pub fn separations_text(designs: &[DesignSeparation]) -> String {
    let all = || designs.iter().flat_map(|of| &of.separations);
    let has_shells = all().any(|one| one.shells.is_some());
    let duration_h = all().find_map(|one| Some(one.within_span.as_ref()?.duration_h));
    let within = duration_h.map(|hours| format!("within {hours} h\n(km)"));
    let mut columns = vec![("design", Align::Left)];
    if has_shells {
        columns.push(("shells", Align::Left));
    }
    columns.extend([
        ("least\n(km)", Align::Right),
        ("between", Align::Left),
        ("at latitude\n(deg)", Align::Right),
        ("first at\n(s)", Align::Right),
    ]);
    if let Some(within) = &within {
        columns.extend([
            (within.as_str(), Align::Right),
            ("between", Align::Left),
            ("at\n(s)", Align::Right),
        ]);
    }
    let mut table = Table::new(&columns);
    for design in designs {
        for one in &design.separations {
            let number = |value: Option<f64>, digits: usize| {
                value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
            };
            let mut row = vec![design.notation.clone()];
            if has_shells {
                row.push(one.shells.clone().unwrap_or_default());
            }
            row.extend([format!("{:.2}", one.least_km), one.between()]);
            let latitude = one.latitude_deg.map(|deg| format!("±{deg:.2}"));
            row.push(latitude.unwrap_or_else(|| "-".to_owned()));
            row.push(number(one.first_s, 0));
            if let Some(span) = &one.within_span {
                row.push(format!("{:.3}", span.distance_km));
                row.push(span.satellites.join(" and "));
                row.push(format!("{:.1}", span.elapsed_s));
            }
            table.row(row);
        }
    }
    format!(
        "least separation under secular J2, over all time\n{}\n{}",
        table.to_text(),
        mean_elements_note(designs)
    )
}

/// What mean elements hide.
fn mean_elements_note(designs: &[DesignSeparation]) -> String {
    let range = |values: Vec<f64>, sign: bool| {
        let [low, high] =
            [f64::min, f64::max].map(|of| values.iter().copied().reduce(of).unwrap_or(0.0));
        let shown = |value: f64| {
            if sign {
                format!("{value:+.1}")
            } else {
                format!("{value:.1}")
            }
        };
        let [low, high] = [low, high].map(shown);
        if low == high {
            low
        } else {
            format!("{low} to {high}")
        }
    };
    let shift = designs.iter().flat_map(|of| &of.radius_shift_km).copied();
    let frozen = designs.iter().flat_map(|of| &of.frozen_km).copied();
    format!(
        "Mean elements hide kilometres: periodic terms of J2 shift the mean radius of these shells by {} km, and the frozen\n\
         eccentricity of J3 moves satellites by {} km up and down and twice that along the track. Less than that is not safe.\n",
        range(shift.collect(), true),
        range(frozen.collect(), false)
    )
}

/// The separations, a row for each shell and for each two.
///
/// # Errors
/// Never for a table in memory.
pub fn separations_csv(designs: &[DesignSeparation]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record([
        "notation",
        "shells",
        "least_km",
        "satellite",
        "other_satellite",
        "latitude_deg",
        "first_s",
        "within_span_km",
        "within_span_satellite",
        "within_span_other_satellite",
        "within_span_s",
    ])?;
    for design in designs {
        for one in &design.separations {
            let span = one.within_span.as_ref();
            let [a, b] = one.satellites.clone().unwrap_or_default();
            let [c, d] = span.map_or_else(Default::default, |of| of.satellites.clone());
            writer.write_record([
                design.notation.clone(),
                one.shells.clone().unwrap_or_default(),
                one.least_km.to_string(),
                a,
                b,
                optional(one.latitude_deg),
                optional(one.first_s),
                optional(span.map(|of| of.distance_km)),
                c,
                d,
                optional(span.map(|of| of.elapsed_s)),
            ])?;
        }
    }
    text(writer)
}
