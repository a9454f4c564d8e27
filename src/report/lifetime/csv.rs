//! What years do to designs, as CSV.

use super::{DesignLifetime, DragResult};
use crate::run::columns::optional;
use crate::run::tables::text;
use ::csv::Writer;
use std::io;

/// The results, a row for each shell and solar activity.
///
/// # Errors
/// Never for a table in memory.
pub fn lifetimes_csv(designs: &[DesignLifetime]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record([
        "notation",
        "node_j2_deg_per_day",
        "node_zonal_deg_per_day",
        "node_off_in_5_years_deg",
        "perigee_j2_deg_per_day",
        "perigee_zonal_deg_per_day",
        "semi_major_axis_shift_m",
        "deorbit_m_s",
        "phase_deg_per_day",
        "node_deg_per_year",
        "semi_major_axis_m_s",
        "inclination_m_s",
        "activity",
        "density_kg_m3",
        "decay_m_per_day",
        "make_up_m_s_per_year",
        "keeping_interval_days",
        "keeping_m_s",
        "decay_years",
        "disposal_5_years_km",
        "disposal_5_years_m_s",
        "disposal_25_years_km",
        "disposal_25_years_m_s",
    ])?;
    for shell in designs.iter().flat_map(|design| &design.shells) {
        let injection = &shell.injection;
        let mut row = vec![shell.notation.clone()];
        row.extend(
            [
                shell.node_j2_deg_per_day,
                shell.node_zonal_deg_per_day,
                shell.node_off_in_5_years_deg,
            ]
            .map(|value| value.to_string()),
        );
        let perigee = shell.perigee;
        row.extend([
            optional(perigee.map(|of| of.j2_deg_per_day)),
            optional(perigee.map(|of| of.zonal_deg_per_day)),
            shell.semi_major_axis_shift_m.to_string(),
            optional(shell.deorbit_m_s),
        ]);
        row.extend(
            [
                injection.phase_deg_per_day,
                injection.node_deg_per_year,
                injection.semi_major_axis_m_s,
                injection.inclination_m_s,
            ]
            .map(|value| value.to_string()),
        );
        for cells in drag_cells(&shell.drag) {
            writer.write_record(row.iter().chain(&cells))?;
        }
    }
    text(writer)
}

/// The cells of each activity, or of none.
fn drag_cells(drag: &[DragResult]) -> Vec<Vec<String>> {
    if drag.is_empty() {
        return vec![vec![String::new(); 11]];
    }
    let of = |of: &DragResult| {
        let numbers = [
            of.density_kg_m3,
            of.decay_m_per_day,
            of.make_up_m_s_per_year,
            of.keeping_interval_days,
            of.keeping_m_s,
            of.decay_years,
            of.disposals[0].altitude_km,
            of.disposals[0].delta_v_m_s,
            of.disposals[1].altitude_km,
            of.disposals[1].delta_v_m_s,
        ];
        std::iter::once(of.activity.clone())
            .chain(numbers.map(optional))
            .collect()
    };
    drag.iter().map(of).collect()
}
