//! A file of STK Connect commands that builds the scenario of a study in STK.
//!
//! Source: AGI/Ansys, *STK Connect Command Library*: "New", "SetAnalysisTimePeriod", "SetEpoch",
//! "SetState Classical" (metres, degrees; `J2Perturbation` and `TwoBody`), "SetState FromFile",
//! "SetConstraint", "Cov Grid" (`AreaOfInterest LatLonRegion`, `PointGranularity LatLon`,
//! `GridConstraint`), "Cov Asset", "Cov Access", "Cov FOMDefine"; *STK Help*, "Point Files (*.pnt)".
//!
//! A circular Walker shell is one `Walker` command on a seed satellite ("Walker (Satellites)"), which STK names its
//! satellites after. `Walker` has no lattice, no node step, true anomalies in place of mean ones, and at most 999
//! satellites: every other satellite has its own `SetState`, which keeps its name. The file contains only commands;
//! settings that commands cannot make are in [`by_hand`].

use super::{FORMAT_VERSION, MONTHS};
use crate::constellation::{Orientation, Pattern, Shell, Slot};
use crate::formats::maps::scene::wrapped;
use crate::ground::Site;
use crate::orbit::MeanElements;
use crate::time::{Epoch, TimeGrid};
use crate::units::{round_decimal, wrap_360};
use chrono::{Datelike, Timelike};
use std::io::{self, Write};

/// How a satellite is set in STK.
#[derive(Debug, Clone, PartialEq)]
pub enum Setting {
    /// Mean elements in TEME of the epoch under secular J2.
    J2(MeanElements),
    /// Elements in TEME of the epoch around a point mass.
    TwoBody(MeanElements),
    /// An ephemeris, by its path from the file of commands.
    File(String),
}

/// Satellites that are made together.
#[derive(Debug, Clone, PartialEq)]
pub enum ConnectItem {
    /// One satellite under its name.
    Satellite(String, Setting),
    /// A shell by one `Walker`.
    Walker(WalkerShell),
}

/// Most satellites of `Walker`.
const MOST_WALKER: usize = 999;

/// A shell that `Walker` makes from a seed, whose orbit is that of its first satellite.
#[derive(Debug, Clone, PartialEq)]
pub struct WalkerShell {
    /// Name of the seed, to which STK adds the numbers of plane and satellite, and of STK's constellation of the shell.
    pub name: String,
    /// The seed.
    pub seed: Setting,
    shell: Shell,
}

impl WalkerShell {
    /// The shell under a name and a setting of its elements, if `Walker` can express it.
    #[must_use]
    pub fn new(
        name: String,
        shell: &Shell,
        setting: impl Fn(MeanElements) -> Setting,
    ) -> Option<Self> {
        let is_walker = matches!(shell.pattern(), Pattern::Delta | Pattern::Star)
            && shell.eccentricity() == 0.0
            && shell.orientation() == Orientation::default()
            && shell.satellite_count() <= MOST_WALKER;
        is_walker.then(|| Self {
            name,
            seed: setting(shell.elements(Slot::FIRST)),
            shell: *shell,
        })
    }

    /// The command: phases step by 360° F/T from plane to plane in both types.
    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let kind = match self.shell.pattern() {
            Pattern::Star => "Star",
            Pattern::Delta | Pattern::Lattice => "Delta",
        };
        writeln!(
            out,
            "Walker */Satellite/{name} Type {kind} NumPlanes {} NumSatsPerPlane {} \
             InterPlanePhaseIncrement {} ColorByPlane No ConstellationName {name} SetUniqueNames Yes",
            self.shell.planes(),
            self.shell.satellites_per_plane(),
            self.shell.phasing(),
            name = self.name,
        )?;
        // The seed is a copy of the first satellite.
        writeln!(out, "Unload / */Satellite/{}", self.name)
    }
}

/// A scenario of commands.
pub struct ConnectScenario<'a> {
    /// The span.
    pub grid: TimeGrid,
    /// The satellites, those of the constellation first.
    pub items: &'a [ConnectItem],
    /// The ground points.
    pub sites: &'a [Site],
    /// Spacing of the points, degrees; none for a list of points.
    pub step_deg: Option<[f64; 2]>,
    /// Lowest elevation, degrees.
    pub mask_deg: f64,
}

/// What Connect's commands do not say, and has to be set or known in STK.
#[must_use]
pub fn by_hand(one_mask: bool, files: bool, items: &[ConnectItem]) -> Vec<String> {
    let mut told = vec![
        "not tested in STK, for lack of a licence: the commands follow its documentation and \
         published scripts"
            .to_owned(),
        "by hand: load points.pnt as the custom point locations of CoverageDefinition/Region; Connect \
         can only create its own grid over the region"
            .to_owned(),
        "by hand: in FigureOfMerit/PDOP choose PDOP, Over Determined, and the step of the study; the \
         command can only select the average of a dilution of precision"
            .to_owned(),
        "by hand: STK propagates J2Perturbation about the pole of J2000 by default; select the true pole \
         of the epoch (Propagator, Special Options); the difference is 2 to 6 km in a day"
            .to_owned(),
        "STK takes the Earth's constants from its own central body file; the design's are listed under \
         conventions"
            .to_owned(),
        "STK solves one clock for all systems: compare with gnss.clocks = \"shared\". It has no \
         cap on PDOP"
            .to_owned(),
    ];
    for item in items {
        if let ConnectItem::Walker(WalkerShell { name, shell, .. }) = item {
            told.push(format!(
                "{shell} is one Walker command: STK names its satellites {name} and the numbers of plane and place, \
                 and groups them in the constellation {name}"
            ));
        }
    }
    if items
        .iter()
        .any(|item| matches!(item, ConnectItem::Satellite(..)))
    {
        told.push(
            "satellites with a SetState of their own keep their names: STK's Walker has no lattice, ellipse, raan, u or \
             node-step, and at most 999 satellites"
                .to_owned(),
        );
    }
    if !one_mask {
        told.push(
            "the mask is that of the design for all satellites: visibility.gnss-mask-deg and \
             skylines cannot be expressed in a coverage grid; set constraints by asset"
                .to_owned(),
        );
    }
    if files {
        told.push(
            "SetState FromFile names files relative to the folder of the commands; STK wants full \
             paths"
                .to_owned(),
        );
    }
    told
}

impl ConnectScenario<'_> {
    /// Writes the commands, one a line.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let epoch = self.grid.epoch();
        let span_s = self.grid.step_s() * self.grid.len() as f64;
        let start = date(epoch);
        let end = date(epoch.plus_seconds(span_s));
        writeln!(out, "New / Scenario navwalker")?;
        writeln!(out, "SetAnalysisTimePeriod * \"{start}\" \"{end}\"")?;
        writeln!(out, "SetEpoch * \"{start}\"")?;
        for item in self.items {
            let (name, setting) = match item {
                ConnectItem::Satellite(name, setting) => (name, setting),
                ConnectItem::Walker(walker) => (&walker.name, &walker.seed),
            };
            writeln!(out, "New / */Satellite {name}")?;
            self.set_state(out, name, setting, &start)?;
            if let ConnectItem::Walker(walker) = item {
                walker.write(out)?;
            }
        }
        self.coverage(out)
    }

    fn set_state(
        &self,
        out: &mut impl Write,
        name: &str,
        setting: &Setting,
        start: &str,
    ) -> io::Result<()> {
        let (propagator, elements) = match setting {
            Setting::J2(elements) => ("J2Perturbation", elements),
            Setting::TwoBody(elements) => ("TwoBody", elements),
            Setting::File(path) => {
                return writeln!(out, "SetState */Satellite/{name} FromFile \"{path}\"");
            }
        };
        let degrees = |radians: f64| round_decimal(wrap_360(radians.to_degrees()), 12);
        let step_s = self.grid.step_s();
        writeln!(
            out,
            "SetState */Satellite/{name} Classical {propagator} UseScenarioInterval {step_s} \
             TEMEOfEpoch \"{start}\" {} {} {} {} {} {} \"{start}\"",
            round_decimal(elements.semi_major_axis_km * 1000.0, 6),
            elements.eccentricity,
            degrees(elements.inclination_rad),
            degrees(elements.arg_perigee_rad),
            degrees(elements.raan_rad),
            degrees(elements.mean_anomaly_rad),
        )
    }

    fn coverage(&self, out: &mut impl Write) -> io::Result<()> {
        const REGION: &str = "*/CoverageDefinition/Region";
        writeln!(out, "New / */Facility MaskPoint")?;
        let mask = self.mask_deg;
        writeln!(
            out,
            "SetConstraint */Facility/MaskPoint ElevationAngle Min {mask}"
        )?;
        writeln!(out, "New / */CoverageDefinition Region")?;
        let [[south, west], [north, east]] = self.bounds();
        writeln!(
            out,
            "Cov {REGION} Grid AreaOfInterest LatLonRegion {south} {west} {north} {east}"
        )?;
        if let Some([step, _]) = self.step_deg {
            writeln!(out, "Cov {REGION} Grid PointGranularity LatLon {step}")?;
        }
        writeln!(
            out,
            "Cov {REGION} Grid GridConstraint Facility UsePointAltitudeType Facility/MaskPoint"
        )?;
        for item in self.items {
            let object = match item {
                ConnectItem::Satellite(name, _) => format!("Satellite/{name}"),
                ConnectItem::Walker(walker) => format!("Constellation/{}", walker.name),
            };
            writeln!(out, "Cov {REGION} Asset */{object} Assign")?;
        }
        writeln!(out, "Cov {REGION} Access Compute")?;
        writeln!(out, "New / {REGION}/FigureOfMerit PDOP")?;
        writeln!(
            out,
            "Cov {REGION}/FigureOfMerit/PDOP FOMDefine Definition DilutionOfPrecision Compute Average"
        )
    }

    /// South-west and north-east corner, latitude first: half a step around the points, so that cells of a
    /// step are centred on them.
    fn bounds(&self) -> [[f64; 2]; 2] {
        let half = self.step_deg.unwrap_or([1.0, 1.0]).map(|step| step / 2.0);
        let over = |place: &dyn Fn(&Site) -> f64, pick: fn(f64, f64) -> f64| {
            self.sites.iter().map(place).reduce(pick).unwrap_or(0.0)
        };
        let latitude = |site: &Site| site.latitude_deg;
        let longitude = |site: &Site| site.longitude_deg;
        let west = over(&longitude, f64::min) - half[1];
        let east = over(&longitude, f64::max) + half[1];
        // Within -360 to 360, and at most a turn apart.
        let shift = if east > 360.0 { -360.0 } else { 0.0 };
        [
            [
                (over(&latitude, f64::min) - half[0]).max(-90.0),
                west + shift,
            ],
            [
                (over(&latitude, f64::max) + half[0]).min(90.0),
                (east + shift).min(west + shift + 360.0),
            ],
        ]
    }

    /// Writes the ground points as a point file: latitude and longitude in degrees.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write_points(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "stk.v.{FORMAT_VERSION}\nBegin PointList")?;
        for site in self.sites {
            writeln!(out, "{} {}", site.latitude_deg, wrapped(site.longitude_deg))?;
        }
        writeln!(out, "End PointList")
    }
}

/// `1 Jan 2025 00:00:00.000000`.
fn date(epoch: Epoch) -> String {
    let utc = epoch.utc();
    format!(
        "{} {} {} {}.{:06}",
        utc.day(),
        MONTHS[utc.month0() as usize],
        utc.year(),
        utc.format("%H:%M:%S"),
        utc.nanosecond() % 1_000_000_000 / 1_000
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Design;
    use crate::earth::Surface;
    use crate::ground::{Grid, PointWeights};

    fn commands(design: &str, grid: Grid) -> (String, String) {
        let design: Design = design.parse().unwrap();
        let set = |one: crate::constellation::Satellite| {
            ConnectItem::Satellite(format!("NW-{}", one.slot), Setting::J2(one.elements))
        };
        let mut items: Vec<_> = design.satellites().into_iter().map(set).collect();
        if let Some(shell) = design.only_shell()
            && let Some(walker) = WalkerShell::new("NW".to_owned(), shell, Setting::J2)
        {
            items = vec![ConnectItem::Walker(walker)];
        }
        let geo = Setting::File("gnss/GEO-1.e".to_owned());
        items.push(ConnectItem::Satellite("GEO-1".to_owned(), geo));
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let scenario = ConnectScenario {
            grid: TimeGrid::new(epoch, 86_400.0, 60.0).unwrap(),
            items: &items,
            sites: &grid.sites(Surface::Wgs84).unwrap(),
            step_deg: Some(grid.step_deg),
            mask_deg: 7.0,
        };
        let (mut commands, mut points) = (Vec::new(), Vec::new());
        scenario.write(&mut commands).unwrap();
        scenario.write_points(&mut points).unwrap();
        (
            String::from_utf8(commands).unwrap(),
            String::from_utf8(points).unwrap(),
        )
    }

    fn region(longitude_deg: [f64; 2]) -> Grid {
        Grid {
            latitude_deg: [3.0, 54.0],
            longitude_deg,
            step_deg: [5.0, 5.0],
            weights: PointWeights::Equal,
        }
    }

    /// A pattern, its numbers, and then the seed goes; the satellites are an asset of the coverage together.
    #[test]
    fn a_circular_walker_shell_is_one_command() {
        for (design, kind) in [
            ("delta:55:6/3/2@925", "Delta"),
            ("star:90:6/3/2@925", "Star"),
        ] {
            let (text, _) = commands(design, region([73.0, 136.0]));
            let expected = format!(
                "Walker */Satellite/NW Type {kind} NumPlanes 3 NumSatsPerPlane 2 InterPlanePhaseIncrement 2 \
                 ColorByPlane No ConstellationName NW SetUniqueNames Yes\nUnload / */Satellite/NW\n"
            );
            assert!(text.contains(&expected), "{text}");
            assert_eq!(text.matches("Classical").count(), 1);
            assert!(
                text.contains("Cov */CoverageDefinition/Region Asset */Constellation/NW Assign\n")
            );
        }
    }

    #[test]
    fn what_walker_cannot_express_is_set_one_by_one() {
        for design in [
            "lattice:55:4/2/1@925",
            "delta:55:4/2/1@925,e=0.01",
            "delta:55:4/2/1@925,raan=10",
            "delta:55:4/2/1@925,u=10",
            "star:90:4/2/1@925,node-step=31.6",
            "delta:55:1000/10/1@925",
        ] {
            let (text, _) = commands(design, region([73.0, 136.0]));
            let satellites = design.parse::<Design>().unwrap().satellite_count();
            assert_eq!(text.matches("Classical").count(), satellites, "{design}");
            assert!(!text.contains("Walker"), "{design}");
        }
    }

    /// The elements are in metres and degrees, perigee before node, as "SetState Classical" has
    /// them; a star pattern has its nodes over half a turn. With a node of its own a shell is no `Walker`.
    #[test]
    fn commands_hold_the_design() {
        for (design, node) in [
            ("delta:55:4/2/1@925,raan=5", 185.0),
            ("star:55:4/2/1@925,raan=5", 95.0),
        ] {
            let (text, _) = commands(design, region([73.0, 136.0]));
            let set: Vec<&str> = text.lines().filter(|l| l.contains("Classical")).collect();
            assert_eq!(set.len(), 4);
            let expected = format!(
                "SetState */Satellite/NW-P02-S01 Classical J2Perturbation UseScenarioInterval 60 \
                 TEMEOfEpoch \"1 Jan 2025 00:00:00.000000\" 7303137 0 55 0 {node} 90 \
                 \"1 Jan 2025 00:00:00.000000\""
            );
            assert_eq!(set[2], expected);
            assert!(text.contains("SetState */Satellite/GEO-1 FromFile \"gnss/GEO-1.e\""));
            assert_eq!(text.matches(" Assign\n").count(), 5);
            assert!(text.contains("\"2 Jan 2025 00:00:00.000000\""));
        }
    }

    #[test]
    fn the_region_is_half_a_step_around_the_points() {
        let (text, points) = commands("delta:55:4/2/1@925", region([73.0, 136.0]));
        assert!(text.contains("LatLonRegion 0.5 70.5 55.5 135.5\n"));
        assert_eq!(points.lines().count(), 143 + 3);
        assert!(points.contains("\n3 73\n") && points.contains("\n53 133\n"));
        let (text, points) = commands("delta:55:4/2/1@925", region([350.0, 10.0]));
        assert!(
            text.contains("LatLonRegion 0.5 -12.5 55.5 12.5\n"),
            "{text}"
        );
        assert!(points.contains("\n3 -10\n"));
    }
}
