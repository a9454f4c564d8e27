//! `navwalker scenario`.

use crate::cli::args::{OutputFormat, ScenarioAction, ScenarioArgs};
use crate::cli::study::Study;
use crate::cli::{Status, output};
use crate::report::{Align, Table};
use crate::scenario::{Region, Scenario, builtin, builtin_names, json_schema, template};
use anyhow::Result;

pub(crate) fn run(args: &ScenarioArgs) -> Result<Status> {
    match &args.action {
        ScenarioAction::List { format } => list(*format)?,
        ScenarioAction::Show { study } => {
            output::result(&Study::load(study, &[])?.scenario.to_toml())?;
        }
        ScenarioAction::New => output::result(&template())?,
        ScenarioAction::Schema => {
            output::result(&crate::printable::json(&json_schema())?)?;
        }
    }
    Ok(Status::Done)
}

fn list(format: OutputFormat) -> Result<()> {
    let mut rows = Vec::new();
    for name in builtin_names() {
        let scenario = Scenario::parse::<&str>(name, builtin(name)?.as_bytes(), &[])?;
        let region = match &scenario.region {
            Region::Grid(grid) => {
                let [south, north] = grid.latitude_deg;
                let [west, east] = grid.longitude_deg;
                format!("{south} to {north} N, {west} to {east} E")
            }
            Region::Cells(cells) => {
                let [south, north] = cells.latitude_deg;
                let [west, east] = cells.longitude_deg;
                let limits = format!("{south} to {north} N, {west} to {east} E");
                format!("{limits}, cells of {} km", cells.spacing_km)
            }
            Region::Area { .. } | Region::Points { .. } => scenario.region.told(),
        };
        let surface = scenario.earth.surface.to_string();
        rows.push([
            name.to_owned(),
            surface,
            scenario.visibility.mask_deg.to_string(),
            region,
        ]);
    }
    match format {
        OutputFormat::Text => {
            let mut table = Table::new(&[
                ("name", Align::Left),
                ("surface", Align::Left),
                ("mask (deg)", Align::Right),
                ("region (deg)", Align::Left),
            ]);
            rows.into_iter().for_each(|row| table.row(row));
            output::result(&table.to_text())?;
            output::hint(
                "\nnavwalker scenario show NAME prints one with every key; scenario new starts your own",
            );
            Ok(())
        }
        OutputFormat::Json => {
            let names: Vec<_> = rows.iter().map(|row| &row[0]).collect();
            output::result(&crate::printable::json(&names)?)
        }
        OutputFormat::Csv => {
            let mut writer = csv::Writer::from_writer(Vec::new());
            writer.write_record(["name", "surface", "mask_deg", "region"])?;
            rows.iter().try_for_each(|row| writer.write_record(row))?;
            output::result(&String::from_utf8(writer.into_inner()?)?)
        }
    }
}
