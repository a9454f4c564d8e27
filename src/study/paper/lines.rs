//! The statements of the paper, one by one.

use super::measured::Measurements;
use super::searches::{PROPOSED, SATELLITES, SINGLE};
use super::table::{PERCENTAGES, Printable, TABLE1};
use super::{
    Curve, Expected, FoundSet, MaskFit, PaperError, RowValue, Scheme, Statement, TableRow,
};
use crate::constellation::gnss::GnssSatellite;
use crate::earth::RADIUS_KM;
use crate::evaluate::Setup;
use crate::optimize::{dominates, fuzzy};
use crate::orbit::Propagator;
use crate::study::judge::{OtherAssumption, Provenance, judge};

/// The row that the paper's text compares with others.
pub(super) const REFERENCE: &str = "proposed-2";

/// Tolerance of N̄: half of its last printed digit, plus 0.01 for the effect of another epoch
/// (under 0.005) and sampling.
pub const VISIBLE_TOLERANCE: f64 = 0.015;

/// Relative tolerance of mean PDOP, percent: the sum of the effects of the epoch and of the GEO and
/// IGSO slots, which the paper does not state (1.1, 1.0 and 0.3 % for a polar row), and a little
/// more. The rounding of the table is far below this.
pub const PDOP_TOLERANCE_PERCENT: f64 = 3.0;

/// Tolerance of a percentage in the text, percentage points: two rounded N̄ of about 6 and 8, with
/// [`VISIBLE_TOLERANCE`] in each.
const PERCENTAGE_TOLERANCE: f64 = 0.5;

/// The same for a ratio of two mean PDOPs, each accurate to a few percent.
const PDOP_PERCENTAGE_TOLERANCE: f64 = 3.0;

/// "Consistently": in this fraction of all cases, percent.
const CONSISTENTLY_PERCENT: f64 = 95.0;

/// Difference from the mask that Table II implies, degrees: half the last digit of the row masks.
const MASK_TOLERANCE_DEG: f64 = 0.1;

/// Table I gives whole degrees and kilometres.
const TABLE1_TOLERANCE: f64 = 0.5;

/// The evidence for the verdicts.
pub(super) struct Evidence<'a> {
    pub(super) setup: &'a Setup,
    pub(super) table: &'a Measurements,
    pub(super) mask_fit: &'a MaskFit,
    pub(super) searches: &'a [FoundSet],
    /// Figure 3 as printed, and at the inclinations that fit.
    pub(super) curves: [&'a [Curve]; 2],
}

impl Measurements {
    fn index(&self, name: &str) -> Result<usize, PaperError> {
        let found = self.rows.iter().position(|row| row.name() == name);
        found.ok_or_else(|| PaperError::NoRow(name.to_owned()))
    }

    /// Judges a quantity derived from the values of all rows.
    fn judge(
        &self,
        texts: [&str; 3],
        provenance: Provenance,
        expected: Expected,
        of: impl Fn(&[RowValue]) -> Option<f64>,
    ) -> Statement {
        let fitting = OtherAssumption {
            assumption: &self.at_fitting.assumption,
            found: of(&self.at_fitting.values),
        };
        self.judge_fitted(texts, provenance, expected, fitting, of)
    }

    /// The same, with another description of the fitting inclinations, or without them.
    fn judge_fitted<'a>(
        &'a self,
        texts: [&str; 3],
        provenance: Provenance,
        expected: Expected,
        fitting: impl Into<Option<OtherAssumption<'a>>>,
        of: impl Fn(&[RowValue]) -> Option<f64>,
    ) -> Statement {
        let mut others: Vec<OtherAssumption<'_>> = fitting.into().into_iter().collect();
        others.extend(self.alternatives.iter().map(|measured| OtherAssumption {
            assumption: &measured.assumption,
            found: of(&measured.values),
        }));
        judge(
            texts,
            provenance,
            expected,
            of(&self.printed.values),
            &others,
        )
    }
}

impl Evidence<'_> {
    fn set(&self, name: &str) -> Option<&FoundSet> {
        self.searches.iter().find(|set| set.name == name)
    }
}

/// All lines, in the order of the paper.
pub(super) fn lines(evidence: &Evidence<'_>) -> Result<Vec<Statement>, PaperError> {
    let mut lines = table1(evidence);
    lines.extend(mask(evidence));
    for row in judged_rows(evidence.table) {
        lines.extend([row.mean_visible, row.mean_pdop]);
    }
    lines.extend(whole_table2(evidence.table));
    lines.extend(pareto(evidence));
    lines.extend(percentages(evidence)?);
    lines.extend(figure2(evidence));
    lines.extend(figure3(evidence));
    lines.extend(figure4(evidence));
    Ok(lines)
}

/// Table I against the GNSS that is propagated: counts by name, radii and inclinations by state.
fn table1(evidence: &Evidence<'_>) -> Vec<Statement> {
    let epoch = evidence.setup.grid.epoch();
    let satellites: Vec<GnssSatellite> = (evidence.setup.gnss.iter())
        .flat_map(|system| system.satellites(epoch))
        .collect();
    let mut lines = Vec::new();
    for (kind, count, inclination_deg, altitude_km) in TABLE1 {
        let members: Vec<&GnssSatellite> = satellites
            .iter()
            .filter(|s| s.name.starts_with(kind))
            .collect();
        let first = members.first().and_then(|s| s.orbit.state_at(0.0).ok());
        let plane_deg = first.map(|state| {
            let normal = state.position_km.km().cross(&state.velocity_km_s);
            (normal.z / normal.norm())
                .clamp(-1.0, 1.0)
                .acos()
                .to_degrees()
        });
        let height_km = first.map(|state| state.position_km.norm() - RADIUS_KM);
        for (what, unit, value, ours) in [
            ("satellites", "", count as f64, Some(members.len() as f64)),
            ("inclination", "deg", inclination_deg, plane_deg),
            ("altitude", "km", altitude_km, height_km),
        ] {
            let tolerance = TABLE1_TOLERANCE;
            let expected = Expected::Value { value, tolerance };
            let statement = format!("{kind} {what}");
            let texts = ["Table I", statement.as_str(), unit];
            lines.push(judge(texts, Provenance::Input, expected, ours, &[]));
        }
    }
    lines
}

/// The mask of the scenario compared with the one that Table II implies.
fn mask(evidence: &Evidence<'_>) -> Option<Statement> {
    let expected = Expected::Value {
        value: evidence.mask_fit.median_deg?,
        tolerance: MASK_TOLERANCE_DEG,
    };
    let ours = Some(evidence.setup.mask.degrees());
    let texts = ["Table II", "mask implied by its visibility", "deg"];
    Some(judge(texts, Provenance::Fitted, expected, ours, &[]))
}

/// What a row prints: N̄ and mean PDOP.
fn printed(row: &TableRow) -> [Expected; 2] {
    let visible = Expected::Value {
        value: row.mean_visible,
        tolerance: VISIBLE_TOLERANCE,
    };
    let pdop = Expected::Value {
        value: row.mean_pdop,
        tolerance: row.mean_pdop * PDOP_TOLERANCE_PERCENT / 100.0,
    };
    [visible, pdop]
}

/// A row of Table II and the verdicts on its two numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedRow {
    /// The row.
    pub row: TableRow,
    /// N̄: the mask of the built-in scenario was found from this column, and so were the
    /// inclinations that fit.
    pub mean_visible: Statement,
    /// Mean PDOP, which nothing was fitted to.
    pub mean_pdop: Statement,
}

/// Every row of Table II, judged.
pub(super) fn judged_rows(table: &Measurements) -> Vec<JudgedRow> {
    let judged = |(n, (row, fitted)): (usize, (&TableRow, &Option<f64>))| {
        let name = row.name();
        let fitting = fitted.map(|inclination_deg| format!("inclination {inclination_deg}°"));
        let judge = |what: &str, provenance, expected, of: fn(&RowValue) -> Option<f64>| {
            let statement = format!("{name} {what}");
            let texts = ["Table II", statement.as_str(), ""];
            let fitting = fitting.as_deref().map(|assumption| OtherAssumption {
                assumption,
                found: of(&table.at_fitting.values[n]),
            });
            table.judge_fitted(
                texts,
                provenance,
                expected,
                fitting,
                |values| of(&values[n]),
            )
        };
        let [visible, pdop] = printed(row);
        JudgedRow {
            row: row.clone(),
            mean_visible: judge("mean visible", Provenance::Fitted, visible, |value| {
                Some(value.mean_visible)
            }),
            mean_pdop: judge("mean PDOP", Provenance::Computed, pdop, |value| {
                value.mean_pdop
            }),
        }
    };
    let rows = table.rows.iter().zip(&table.fitted);
    rows.enumerate().map(judged).collect()
}

/// Whether one assumption reproduces an entire column: one that suits a row may fail another.
fn whole_table2(table: &Measurements) -> [Statement; 2] {
    let share = |values: &[RowValue], which: usize| {
        let rows = table.rows.iter().zip(values);
        percent(rows.map(|(row, value)| {
            let found = [Some(value.mean_visible), value.mean_pdop][which];
            found.is_some_and(|found| printed(row)[which].holds(found))
        }))
    };
    let line = |statement, provenance, which| {
        let texts = ["Table II", statement, "%"];
        table.judge(texts, provenance, Expected::AtLeast(100.0), |values| {
            share(values, which)
        })
    };
    [
        line(
            "rows whose mean visible is reproduced, all under one assumption",
            Provenance::Fitted,
            0,
        ),
        line(
            "rows whose mean PDOP is reproduced, all under one assumption",
            Provenance::Computed,
            1,
        ),
    ]
}

/// Table II is headed "Pareto-optimal solutions".
fn pareto(evidence: &Evidence<'_>) -> Option<Statement> {
    let front: Vec<[f64; 2]> = (evidence.set(PROPOSED)?.members.iter())
        .filter_map(|member| Some([member.metrics.j_pos?, member.metrics.j_cost?]))
        .collect();
    let own = |row: &TableRow| row.scheme == Scheme::Proposed;
    let share = |values: &[RowValue]| {
        let points = evidence
            .table
            .rows
            .iter()
            .zip(values)
            .filter(|(row, _)| own(row));
        let points = points.filter_map(|(_, value)| Some([value.j_pos?, value.j_cost?]));
        percent(points.map(|point| !front.iter().any(|member| dominates(member, &point))))
    };
    // The front belongs to the scenario, so its members can be compared only there.
    let ours = share(&evidence.table.printed.values);
    let there = share(&evidence.table.at_fitting.values);
    let texts = [
        "Table II",
        "proposed rows that no design found here dominates",
        "%",
    ];
    let others = [OtherAssumption {
        assumption: &evidence.table.at_fitting.assumption,
        found: there,
    }];
    Some(judge(
        texts,
        Provenance::Computed,
        Expected::AtLeast(CONSISTENTLY_PERCENT),
        ours,
        &others,
    ))
}

fn percentages(evidence: &Evidence<'_>) -> Result<Vec<Statement>, PaperError> {
    let mut lines = Vec::new();
    for stated in PERCENTAGES {
        let table = evidence.table;
        let (row, with) = (table.index(stated.row)?, table.index(stated.with)?);
        // A ratio of two N̄ follows from what the mask and the inclinations were fitted to.
        let (tolerance, provenance) = match stated.of {
            Printable::MeanVisible => (PERCENTAGE_TOLERANCE, Provenance::Fitted),
            Printable::MeanPdop => (PDOP_PERCENTAGE_TOLERANCE, Provenance::Computed),
        };
        let value = |value: &RowValue| match stated.of {
            Printable::MeanVisible => Some(value.mean_visible),
            Printable::MeanPdop => value.mean_pdop,
        };
        let change = |values: &[RowValue]| {
            let ratio = value(&values[row])? / value(&values[with])?;
            Some(100.0 * (ratio - 1.0))
        };
        let expected = Expected::Value {
            value: stated.percent,
            tolerance,
        };
        let texts = ["abstract, IV-B", stated.name, "%"];
        lines.push(table.judge(texts, provenance, expected, change));
    }
    Ok(lines)
}

fn figure2(evidence: &Evidence<'_>) -> Vec<Statement> {
    let own = |n: usize| evidence.table.rows[n].scheme == Scheme::Proposed;
    let points = |values: &[RowValue]| -> Option<Vec<[f64; 2]>> {
        (values.iter())
            .map(|value| Some([value.j_pos?, value.j_cost?]))
            .collect()
    };
    let dominated = |values: &[RowValue]| {
        let points = points(values)?;
        let beaten =
            |n: usize| (0..points.len()).any(|m| own(m) && dominates(&points[m], &points[n]));
        percent((0..points.len()).filter(|&n| !own(n)).map(beaten))
    };
    let lead = |values: &[RowValue]| {
        let memberships = fuzzy(&points(values)?).ok()?.minimum;
        let highest = |of_own: bool| {
            let chosen = memberships
                .iter()
                .enumerate()
                .filter(|(n, _)| own(*n) == of_own);
            chosen
                .map(|(_, membership)| *membership)
                .max_by(f64::total_cmp)
        };
        Some(highest(true)? - highest(false)?)
    };
    vec![
        evidence.table.judge(
            [
                "Fig. 2(a)",
                "baseline rows that a proposed row dominates",
                "%",
            ],
            Provenance::Computed,
            Expected::AtLeast(CONSISTENTLY_PERCENT),
            dominated,
        ),
        evidence.table.judge(
            [
                "Fig. 2(b)",
                "lead of the proposed rows in fuzzy membership",
                "",
            ],
            Provenance::Computed,
            Expected::MoreThan(0.0),
            lead,
        ),
    ]
}

fn figure3(evidence: &Evidence<'_>) -> Vec<Statement> {
    let consistently = Expected::AtLeast(CONSISTENTLY_PERCENT);
    let line = |texts, of: fn(&[Curve]) -> Option<f64>| {
        let others = [OtherAssumption {
            assumption: &evidence.table.at_fitting.assumption,
            found: of(evidence.curves[1]),
        }];
        let found = of(evidence.curves[0]);
        judge(texts, Provenance::Computed, consistently, found, &others)
    };
    vec![
        line(
            [
                "Fig. 3(a)",
                "quantiles at which the proposed design has the most visible satellites",
                "%",
            ],
            most_visible,
        ),
        line(
            [
                "Fig. 3(b)",
                "instants at which it has the lowest maximum PDOP",
                "%",
            ],
            lowest_max,
        ),
    ]
}

/// Percentage of the quantiles of E_g(N_visible) at which the first curve is above all others.
fn most_visible(curves: &[Curve]) -> Option<f64> {
    let sorted: Vec<Vec<f64>> = curves.iter().map(Curve::sorted_visible).collect();
    let (own, others) = sorted.split_first()?;
    percent((own.iter().enumerate()).map(|(k, x)| others.iter().all(|other| other[k] < *x)))
}

/// Percentage of the instants at which the maximum PDOP of the first curve is below all others.
fn lowest_max(curves: &[Curve]) -> Option<f64> {
    let (own, others) = curves.split_first()?;
    let below = |k: usize, x: f64| {
        let mut rivals = others.iter().map(|other| other.epochs[k].max_pdop);
        rivals.all(|rival| rival.is_none_or(|rival| x < rival))
    };
    let instants = own.epochs.iter().enumerate();
    percent(instants.map(|(k, epoch)| epoch.max_pdop.is_some_and(|x| below(k, x))))
}

/// The three strategies, as changes from the proposed one, percent.
fn figure4(evidence: &Evidence<'_>) -> Vec<Statement> {
    let pick = |name: &str| Some(evidence.set(name)?.pick()?.clone());
    let (proposed, single, fewest) = (pick(PROPOSED), pick(SINGLE), pick(SATELLITES));
    let table = evidence.table;
    let Ok(reference) = table.index(REFERENCE) else {
        return Vec::new();
    };
    let printed = table.printed.values[reference];
    let row_size = table.rows[reference].design.satellite_count() as f64;
    let change = |to: Option<f64>, from: Option<f64>| Some(100.0 * (to? / from? - 1.0));
    let ours = |of: fn(&super::FoundMember) -> Option<f64>, other: &Option<super::FoundMember>| {
        (other.as_ref().and_then(of), proposed.as_ref().and_then(of))
    };
    let line =
        |statement, (other, own): (Option<f64>, Option<f64>), row: Option<f64>, sign: f64| {
            let expected = Expected::MoreThan(0.0);
            let signed = |change: Option<f64>| change.map(|percent| sign * percent);
            let others = [OtherAssumption {
                assumption: "the paper's own pick, row 2 of Table II, as the proposed design",
                found: signed(change(other, row)),
            }];
            judge(
                ["Fig. 4", statement, "%"],
                Provenance::Computed,
                expected,
                signed(change(other, own)),
                &others,
            )
        };
    let visible = |m: &super::FoundMember| Some(m.metrics.mean_visible);
    let pdop = |m: &super::FoundMember| m.metrics.mean_pdop;
    let size = |m: &super::FoundMember| Some(m.design.satellite_count() as f64);
    vec![
        line(
            "max-pdop alone has more visible satellites, by",
            ours(visible, &single),
            Some(printed.mean_visible),
            1.0,
        ),
        line(
            "max-pdop alone has lower mean PDOP, by",
            ours(pdop, &single),
            printed.mean_pdop,
            -1.0,
        ),
        line(
            "max-pdop alone needs more satellites, by",
            ours(size, &single),
            Some(row_size),
            1.0,
        ),
        line(
            "satellites and max-pdop needs fewer satellites, by",
            ours(size, &fewest),
            Some(row_size),
            -1.0,
        ),
        line(
            "satellites and max-pdop has higher mean PDOP, by",
            ours(pdop, &fewest),
            printed.mean_pdop,
            1.0,
        ),
    ]
}

/// The percentage of cases that are true; `None` if there are none.
fn percent(cases: impl Iterator<Item = bool>) -> Option<f64> {
    let (hold, all) = cases.fold((0_u32, 0_u32), |(hold, all), case| {
        (hold + u32::from(case), all + 1)
    });
    (all > 0).then(|| 100.0 * f64::from(hold) / f64::from(all))
}
