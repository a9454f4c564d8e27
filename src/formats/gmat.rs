//! GMAT: a script that propagates the satellites of a design under J2 alone, and its gravity field.
//!
//! Source: *GMAT User Guide* R2022a and later: "Spacecraft Orbit State", "ForceModel"
//! (`PotentialFile`, `Degree`, `Order`), "Propagator", "ReportFile", "Report", "For". There is one
//! assignment per line. A potential file is looked for next to the script, and a report that begins with `./`
//! is written there.
//!
//! GMAT integrates, so it starts from osculating states: the mean elements with their first-order
//! short-period terms, in `EarthMJ2000Eq`. Its trajectory differs from secular J2 by those
//! terms and by an in-track drift of second order in J2, 1 to 3 km a day.

use crate::earth::{J2, MU_KM3_S2, RADIUS_KM};
use crate::frames::{Eme2000, State, from_teme};
use crate::orbit::j2::SecularOrbit;
use crate::orbit::osculating::OsculatingOrbit;
use crate::orbit::{MeanElements, Model};
use crate::time::{Epoch, TimeGrid};
use chrono::{Datelike, Timelike};
use std::io::{self, Write};

/// Release of GMAT that the script was run in.
pub const FORMAT_VERSION: &str = "R2026a";

/// Name of the potential file that the script loads.
pub const FIELD_NAME: &str = "navwalker-j2.cof";

/// Name of the report that the script writes.
pub const REPORT_NAME: &str = "gmat-report.txt";

/// Digits of states: a micrometre.
const DIGITS: usize = 9;

/// What an object of a script is called: letters, digits and underscores, a letter first.
#[must_use]
pub fn script_name(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let text: String = name.chars().map(plain).collect();
    match text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        true => text,
        false => format!("S{text}"),
    }
}

/// An instant as GMAT writes it in UTC, to a millisecond; none if that would round it.
#[must_use]
pub fn calendar(epoch: Epoch) -> Option<String> {
    let utc = epoch.utc();
    // chrono writes second 60 as second 59 with 1e9 nanoseconds or more.
    let milliseconds = utc.nanosecond() % 1_000_000_000 / 1_000_000;
    utc.nanosecond().is_multiple_of(1_000_000).then(|| {
        let month = crate::formats::stk::MONTHS[utc.month0() as usize];
        format!(
            "{:02} {month} {} {}.{milliseconds:03}",
            utc.day(),
            utc.year(),
            utc.format("%H:%M:%S")
        )
    })
}

/// Writes the potential: mu, R and J2 of the design in the COF format that GMAT reads (fixed columns: see
/// its JGM2.cof), normalised: C̄₂₀ = -J2/√5.
///
/// # Errors
/// If writing fails.
pub fn write_field(out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "COMMENT   1")?;
    writeln!(out, "CCCCC  J2 alone, with the constants of the design")?;
    writeln!(
        out,
        "POTFIELD  2  0  1 {} {} {}",
        exponent(MU_KM3_S2 * 1e9, 14),
        exponent(RADIUS_KM * 1e3, 14),
        exponent(1.0, 14)
    )?;
    writeln!(out, "RECOEF    2  0   {}", exponent(-J2 / 5_f64.sqrt(), 14))?;
    writeln!(out, "END")
}

/// A number with a two-digit exponent and a sign: `3.98600441800000e+14`.
fn exponent(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$e}");
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    let power: i32 = power.parse().unwrap_or_default();
    let sign = if power < 0 { '-' } else { '+' };
    format!("{mantissa}e{sign}{:02}", power.abs())
}

/// The starting state of mean elements at the epoch: osculating under J2.
#[must_use]
pub fn start(elements: &MeanElements, model: Model, epoch: Epoch) -> State<Eme2000> {
    let teme = match model {
        Model::TwoBody => SecularOrbit::two_body(elements).state(0.0),
        Model::J2 | Model::J2Osculating | Model::Sgp4 => OsculatingOrbit::new(elements).state(0.0),
    };
    from_teme(teme, Eme2000, epoch, 0.0)
}

/// A spacecraft of a script.
#[derive(Debug, Clone, PartialEq)]
pub struct Spacecraft {
    /// Its name, as [`script_name`] gives it.
    pub name: String,
    /// Its osculating state at the epoch.
    pub state: State<Eme2000>,
    /// The colour of its orbit, if it is not GMAT's own choice.
    pub colour: Option<[u8; 3]>,
}

/// Writes the script; `start_text` is the epoch as [`calendar`] gives it.
///
/// # Errors
/// If writing fails.
pub fn write_script(
    out: &mut impl Write,
    comments: &[String],
    satellites: &[Spacecraft],
    model: Model,
    grid: TimeGrid,
    start_text: &str,
) -> io::Result<()> {
    for comment in comments {
        writeln!(out, "% {comment}")?;
    }
    for satellite in satellites {
        spacecraft(out, satellite, start_text)?;
    }
    write_propagation(out, model)?;
    writeln!(out, "\nCreate ReportFile Report1")?;
    writeln!(out, "Report1.Filename = './{REPORT_NAME}'")?;
    writeln!(out, "Report1.Precision = 16")?;
    writeln!(out, "Report1.WriteHeaders = true")?;
    writeln!(out, "\nCreate Variable Sample Elapsed")?;
    writeln!(out, "\nBeginMissionSequence")?;
    let step_s = grid.step_s();
    writeln!(out, "Elapsed = 0")?;
    report(out, satellites)?;
    if grid.len() > 1 {
        writeln!(out, "For Sample = 1:1:{}", grid.len() - 1)?;
        let all: Vec<&str> = satellites.iter().map(|one| one.name.as_str()).collect();
        if let Some(first) = all.first() {
            writeln!(
                out,
                "Propagate J2Prop({}) {{{first}.ElapsedSecs = {step_s}}}",
                all.join(", ")
            )?;
        }
        writeln!(out, "Elapsed = Sample * {step_s}")?;
        report(out, satellites)?;
        writeln!(out, "EndFor")?;
    }
    Ok(())
}

fn spacecraft(out: &mut impl Write, satellite: &Spacecraft, start: &str) -> io::Result<()> {
    let Spacecraft {
        name,
        state,
        colour,
    } = satellite;
    writeln!(out, "\nCreate Spacecraft {name}")?;
    writeln!(out, "{name}.DateFormat = UTCGregorian")?;
    writeln!(out, "{name}.Epoch = '{start}'")?;
    writeln!(out, "{name}.CoordinateSystem = EarthMJ2000Eq")?;
    writeln!(out, "{name}.DisplayStateType = Cartesian")?;
    let (r, v) = (state.position_km.km(), state.velocity_km_s);
    let values = [
        ("X", r.x),
        ("Y", r.y),
        ("Z", r.z),
        ("VX", v.x),
        ("VY", v.y),
        ("VZ", v.z),
    ];
    for (key, value) in values {
        // Three digits more for the velocity: its error grows with the day.
        let digits = if key.len() > 1 { DIGITS + 3 } else { DIGITS };
        writeln!(out, "{name}.{key} = {value:.digits$}")?;
    }
    if let Some([red, green, blue]) = colour {
        writeln!(out, "{name}.OrbitColor = [{red} {green} {blue}]")?;
    }
    Ok(())
}

fn write_propagation(out: &mut impl Write, model: Model) -> io::Result<()> {
    let degree = if model == Model::TwoBody { 0 } else { 2 };
    writeln!(out, "\nCreate ForceModel Forces")?;
    for (key, value) in [
        ("CentralBody", "Earth"),
        ("PrimaryBodies", "{Earth}"),
        ("Drag", "None"),
        ("SRP", "Off"),
        ("RelativisticCorrection", "Off"),
        ("ErrorControl", "RSSStep"),
    ] {
        writeln!(out, "Forces.{key} = {value}")?;
    }
    writeln!(out, "Forces.GravityField.Earth.Degree = {degree}")?;
    writeln!(out, "Forces.GravityField.Earth.Order = 0")?;
    writeln!(
        out,
        "Forces.GravityField.Earth.PotentialFile = '{FIELD_NAME}'"
    )?;
    writeln!(out, "\nCreate Propagator J2Prop")?;
    for (key, value) in [
        ("FM", "Forces"),
        ("Type", "PrinceDormand78"),
        ("InitialStepSize", "60"),
        ("Accuracy", "1e-12"),
        ("MinStep", "0.001"),
        ("MaxStep", "300"),
    ] {
        writeln!(out, "J2Prop.{key} = {value}")?;
    }
    Ok(())
}

fn report(out: &mut impl Write, satellites: &[Spacecraft]) -> io::Result<()> {
    write!(out, "Report Report1 Elapsed")?;
    for Spacecraft { name, .. } in satellites {
        for axis in ["X", "Y", "Z"] {
            write!(out, " {name}.EarthMJ2000Eq.{axis}")?;
        }
    }
    writeln!(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Design;

    /// The columns of the lines are those of GMAT's own files: the coefficient begins at column
    /// 18 with its sign.
    #[test]
    fn the_field_has_the_constants_of_the_design() {
        let mut bytes = Vec::new();
        write_field(&mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let gravity =
            "POTFIELD  2  0  1 3.98600441800000e+14 6.37813700000000e+06 1.00000000000000e+00";
        assert_eq!(lines[2], gravity);
        let coefficient: f64 = lines[3][17..].parse().unwrap();
        assert!((-coefficient * 5_f64.sqrt() / J2 - 1.0).abs() < 1e-13);
    }

    #[test]
    fn epochs_are_not_rounded() {
        let at = |text: &str| calendar(Epoch::from_utc(text.parse().unwrap()));
        assert_eq!(
            at("2025-03-09T01:02:03.25Z").unwrap(),
            "09 Mar 2025 01:02:03.250"
        );
        assert_eq!(at("2025-03-09T01:02:03.0001Z"), None);
    }

    #[test]
    fn the_script_propagates_all_satellites() {
        let design: Design = "delta:55:4/2/1@925".parse().unwrap();
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let spacecraft = |one: crate::constellation::Satellite| Spacecraft {
            name: script_name(&format!("NW-{}", one.slot)),
            state: start(&one.elements, Model::J2, epoch),
            colour: (one.slot.plane == 1).then_some([255, 128, 0]),
        };
        let satellites: Vec<_> = design.satellites().into_iter().map(spacecraft).collect();
        let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
        let mut bytes = Vec::new();
        let start = "01 Jan 2025 00:00:00.000";
        let comments = ["study".to_owned()];
        write_script(&mut bytes, &comments, &satellites, Model::J2, grid, start).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text.matches("Create Spacecraft").count(), 4);
        assert_eq!(text.matches(".OrbitColor = [255 128 0]\n").count(), 2);
        assert!(text.contains("\nNW_P02_S01.OrbitColor"));
        assert!(text.contains("For Sample = 1:1:9"));
        let fleet =
            "J2Prop(NW_P01_S01, NW_P01_S02, NW_P02_S01, NW_P02_S02) {NW_P01_S01.ElapsedSecs = 60}";
        assert!(text.contains(fleet));
        // An assignment a line: GMAT takes no second one.
        assert!(text.lines().all(|line| line.matches(" = ").count() <= 1));
    }
}
