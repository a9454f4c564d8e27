//! The arguments of `navwalker export`.

use super::{ChosenArgs, StudyArgs};
use crate::constellation::gnss::Preset;
use crate::exchange::export::Product;
use crate::formats::ccsds::{CcsdsVersion, oem, omm, opm};
use crate::formats::metadata::ElementChoice;
use crate::formats::sp3::Sp3Version;
use crate::formats::text::timestamp::TimeSystem;
use crate::formats::trajectory::{frame_of_name, time_system_of_name};
use crate::frames::Frame;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    #[command(flatten)]
    pub(crate) chosen: ChosenArgs,

    /// Leave these satellites out: satellites (NW-P01-S03), planes (NW-P03) or shells (NW-A); the same as adding them to
    /// `outages.satellites` of the scenario. The others are called as if all were there.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub(crate) without: Vec<String>,

    /// Products to write, separated by commas; listed below.
    #[arg(
        long = "as",
        value_name = "PRODUCTS",
        value_delimiter = ',',
        required = true
    )]
    pub(crate) products: Vec<Product>,

    /// Output directory, empty or new.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,

    /// Replace a directory that is not empty.
    #[arg(long)]
    pub(crate) force: bool,

    /// Frame of OEM, OPM and STK states: EME2000, GCRF, ITRF, or TEME [default: EME2000].
    #[arg(long, value_name = "FRAME", value_parser = frame_of_name)]
    pub(crate) frame: Option<Frame>,

    /// Time system of OEM and OPM: UTC, TAI, GPS, TT or BDT (BeiDou time).
    #[arg(long, value_name = "SYSTEM", default_value = "UTC", value_parser = time_system_of_name)]
    pub(crate) time_system: TimeSystem,

    /// Syntax of OMM files: kvn, xml, json or csv.
    #[arg(long, value_name = "SYNTAX", default_value = "kvn")]
    pub(crate) omm_syntax: omm::OmmSyntax,

    /// Syntax of OEM files: kvn or xml.
    #[arg(long, value_name = "SYNTAX", default_value = "kvn")]
    pub(crate) oem_syntax: oem::OemSyntax,

    /// Syntax of OPM files: kvn or xml.
    #[arg(long, value_name = "SYNTAX", default_value = "kvn")]
    pub(crate) opm_syntax: opm::OpmSyntax,

    /// Combine the OEMs of all satellites in one XML file; needs `--oem-syntax xml`.
    #[arg(long)]
    pub(crate) oem_combined: bool,

    /// How element sets are derived: kozai (from the J2 mean elements), fit (SGP4 fitted to the
    /// trajectory by least squares), or kepler (Keplerian mean motion, a common mistake, for comparison). Element
    /// sets of files are written as they are; states and almanacs of files need fit.
    #[arg(long, value_name = "THEORY", default_value = "kozai")]
    pub(crate) tle_theory: ElementChoice,

    /// Version of CCSDS messages: 2.0 or 3.0.
    #[arg(long, value_name = "VERSION", default_value = "2.0")]
    pub(crate) ccsds_version: CcsdsVersion,

    /// Version of SP3: c or d.
    #[arg(long, value_name = "VERSION", default_value = "d")]
    pub(crate) sp3_version: Sp3Version,

    /// Read every product back, evaluate the scenario with it, and print the difference from the
    /// constellation; exit status 1 if it is more than the file's digits and theory explain.
    #[arg(long)]
    pub(crate) check: bool,

    /// Creation date of CCSDS messages, such as 2025-01-01T00:00:00Z; the same as
    /// `--set export.creation-date=...` [default: the epoch of the study].
    #[arg(long, value_name = "UTC")]
    pub(crate) creation_date: Option<String>,

    /// Also write SP3 files of these nominal constellations, one file each, under gnss/:
    /// beidou-3 (ids C01 ...), gps (G01 ...), galileo (E01 ...), glonass (R01 ...), qzss (J01 ...), navic (I01 ...).
    #[arg(long, value_name = "SYSTEMS", value_delimiter = ',')]
    pub(crate) gnss: Vec<Preset>,

    /// Letter of satellite identifiers in SP3.
    #[arg(long, value_name = "LETTER", default_value = "L")]
    pub(crate) sp3_letter: char,
}
