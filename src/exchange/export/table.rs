//! The table of the products: one row has everything the program knows about a product.

use super::Files;
use super::products::ProductFiles;
use super::size::ProductSize;
use super::source::ExportSource;
use crate::exchange::manifest::FileEntry;
use crate::exchange::read_back::{Grouping, ReadBack, ReadBackTheory, gates};
use crate::formats::WriteError;
use crate::formats::maps::scene::Scene;
use crate::keyword::{Keyword, keywords};

/// The properties of a product other than its keyword.
pub struct ProductRow {
    /// Its lines in the help.
    pub help: &'static [&'static str],
    /// Whether its frame can be chosen.
    pub has_frame: bool,
    /// How it is read back, or why it cannot be.
    pub read_back: Result<ReadBack, &'static str>,
    /// What its files hold.
    pub(super) size: ProductSize,
    write: ProductWriter,
}

impl ProductRow {
    /// Whether the product shows the scenario, or shows more with it.
    #[must_use]
    pub fn uses_scenario(&self) -> bool {
        !matches!(self.write, ProductWriter::Design(_))
    }

    /// Whether the product cannot be written without the scenario.
    #[must_use]
    pub fn needs_scenario(&self) -> bool {
        matches!(self.write, ProductWriter::Scenario(_))
    }
}

/// The function that writes the files of a product, by its input.
enum ProductWriter {
    /// The design only.
    Design(fn(&ExportSource<'_>, &Files<'_>) -> ProductFiles),
    /// The design, and its scenario if there is one.
    Either(fn(&ExportSource<'_>, &Files<'_>, Option<&Scene<'_>>) -> ProductFiles),
    /// The design in its scenario.
    Scenario(fn(&ExportSource<'_>, &Files<'_>, &Scene<'_>) -> ProductFiles),
}

/// Declares the products: keyword and row of each, in the order of the help.
macro_rules! products {
    ($($(#[$doc:meta])* $product:ident = $word:literal { $($row:tt)+ })+) => {
        keywords! {
            /// The products of an export.
            Product { $($(#[$doc])* $product = $word,)+ }
        }

        impl Product {
            /// The properties of the product.
            #[must_use]
            pub fn row(self) -> &'static ProductRow {
                match self {
                    $(Self::$product => {
                        static ROW: ProductRow = ProductRow { $($row)+ };
                        &ROW
                    })+
                }
            }
        }
    };
}

products! {
    /// Two-line element sets with names, one file.
    Tle = "tle" {
        help: &["two-line element sets with names (SGP4), one file"],
        has_frame: false,
        read_back: Ok(ReadBack {
            files: Grouping::Together,
            theory: ReadBackTheory::Sgp4OfTle,
            digits_km: gates::tle_km,
        }),
        size: ProductSize { each: false, satellite: 168, state: 0, day: 0 },
        write: ProductWriter::Design(|source, files| source.tle(files)),
    }
    /// CCSDS Orbit Mean-Elements Messages in the chosen notation.
    Omm = "omm" {
        help: &["CCSDS Orbit Mean-Elements Messages (SGP4): kvn, xml, json or csv"],
        has_frame: false,
        read_back: Ok(ReadBack {
            files: Grouping::Together,
            theory: ReadBackTheory::Sgp4,
            digits_km: gates::omm_km,
        }),
        size: ProductSize { each: true, satellite: 980, state: 0, day: 0 },
        write: ProductWriter::Design(|source, files| source.omm(files)),
    }
    /// CCSDS Orbit Ephemeris Messages, one file for each satellite or one for all.
    Oem = "oem" {
        help: &["CCSDS Orbit Ephemeris Messages: kvn or xml"],
        has_frame: true,
        read_back: Ok(ReadBack {
            files: Grouping::Together,
            theory: ReadBackTheory::Study,
            digits_km: gates::states_km,
        }),
        size: ProductSize { each: true, satellite: 1_290, state: 117, day: 0 },
        write: ProductWriter::Design(|source, files| source.oem(files)),
    }
    /// CCSDS Orbit Parameter Messages, one file for each satellite: the state at the epoch.
    Opm = "opm" {
        help: &[
            "CCSDS Orbit Parameter Messages: state, osculating and mean elements at the epoch",
        ],
        has_frame: true,
        read_back: Ok(ReadBack {
            files: Grouping::Together,
            theory: ReadBackTheory::Study,
            digits_km: gates::opm_km,
        }),
        size: ProductSize { each: true, satellite: 1_390, state: 0, day: 0 },
        write: ProductWriter::Design(|source, files| source.opm(files)),
    }
    /// SP3 in GPS time, files of up to 99 satellites (85 in SP3-c), and of GNSS by choice.
    Sp3 = "sp3" {
        help: &["SP3-c or -d, positions and velocities in GPS time, Earth-fixed"],
        has_frame: false,
        read_back: Ok(ReadBack {
            files: Grouping::Together,
            theory: ReadBackTheory::Study,
            digits_km: gates::sp3_km,
        }),
        size: ProductSize { each: false, satellite: 330, state: 122, day: 0 },
        write: ProductWriter::Design(|source, files| source.sp3(files)),
    }
    /// STK ephemerides, one file for each satellite, and the Connect commands of the scenario if given.
    Stk = "stk" {
        help: &[
            "STK ephemerides (.e), one file for each satellite, and in stk-scenario the Connect",
            "commands that build the study: period, satellites, GNSS, region, mask, PDOP",
        ],
        has_frame: true,
        read_back: Ok(ReadBack {
            files: Grouping::Together,
            theory: ReadBackTheory::Study,
            digits_km: gates::states_km,
        }),
        size: ProductSize { each: true, satellite: 500, state: 100, day: 0 },
        write: ProductWriter::Either(|source, files, scene| source.stk_with(files, scene)),
    }
    /// GMAT: a script that propagates the design under J2 alone.
    Gmat = "gmat" {
        help: &["GMAT script of the satellites under J2 alone, with its gravity field file"],
        has_frame: false,
        read_back: Err("a script has no states until GMAT runs it"),
        size: ProductSize { each: false, satellite: 560, state: 0, day: 0 },
        write: ProductWriter::Design(|source, files| source.gmat(files)),
    }
    /// CZML: satellites, orbits and region for CesiumJS.
    Czml = "czml" {
        help: &["CZML for CesiumJS: satellites, orbits, GNSS, and the region coloured by mean PDOP"],
        has_frame: false,
        read_back: Ok(ReadBack {
            files: Grouping::Together,
            theory: ReadBackTheory::Study,
            digits_km: gates::czml_km,
        }),
        size: ProductSize { each: false, satellite: 330, state: 0, day: 11_900 },
        write: ProductWriter::Scenario(|source, files, scene| source.czml(files, scene)),
    }
    /// GeoJSON: region with metrics, ground tracks, footprints.
    Geojson = "geojson" {
        help: &["GeoJSON for a GIS: region with metrics, ground tracks, footprints (RFC 7946)"],
        has_frame: false,
        read_back: Err("a map of the ground has no orbits"),
        size: ProductSize { each: false, satellite: 100, state: 0, day: 4_900 },
        write: ProductWriter::Scenario(|source, files, scene| source.geojson(files, scene)),
    }
    /// KML: the same for Google Earth.
    Kml = "kml" {
        help: &["KML for Google Earth: the same in one document"],
        has_frame: false,
        read_back: Err("a map of the ground has no orbits"),
        size: ProductSize { each: false, satellite: 100, state: 0, day: 4_900 },
        write: ProductWriter::Scenario(|source, files, scene| source.kml(files, scene)),
    }
    /// YUMA almanacs of the nominal GNSS.
    Yuma = "yuma" {
        help: &["YUMA almanacs of the nominal GNSS; a LEO constellation has none"],
        has_frame: false,
        read_back: Err("the almanacs are of the GNSS, not of the design"),
        size: ProductSize { each: false, satellite: 0, state: 0, day: 0 },
        write: ProductWriter::Scenario(|source, files, scene| source.yuma(files, scene)),
    }
    /// Tables of mean elements and of states.
    Csv = "csv" {
        help: &["tables of mean elements and of states, TEME and Earth-fixed"],
        has_frame: false,
        read_back: Ok(ReadBack {
            files: Grouping::Each,
            theory: ReadBackTheory::Study,
            digits_km: gates::states_km,
        }),
        size: ProductSize { each: false, satellite: 330, state: 226, day: 0 },
        write: ProductWriter::Design(|source, files| source.csv(files)),
    }
    /// Tables of the metrics by ground point and by instant.
    Metrics = "metrics" {
        help: &["tables of the metrics by ground point and by instant"],
        has_frame: false,
        read_back: Err("the tables have metrics, not satellites"),
        size: ProductSize { each: false, satellite: 0, state: 0, day: 0 },
        write: ProductWriter::Scenario(|source, files, scene| source.metrics(files, scene)),
    }
    /// SGP4 states from the element sets as written, to compare another SGP4 with.
    TleStates = "tle-states" {
        help: &["table of SGP4 states from the TLEs as written, to compare another SGP4"],
        has_frame: false,
        // SGP4 states have the theory and the digits of the element sets.
        read_back: Ok(ReadBack {
            files: Grouping::Together,
            theory: ReadBackTheory::Sgp4OfTle,
            digits_km: gates::tle_km,
        }),
        size: ProductSize { each: false, satellite: 330, state: 226, day: 0 },
        write: ProductWriter::Design(|source, files| source.tle_states(files)),
    }
}

impl Product {
    /// How a file of an export is read back, if it has satellites of the design.
    #[must_use]
    pub fn read_back_of(file: &FileEntry) -> Option<ReadBack> {
        let product = Self::from_keyword(&file.format).ok()?;
        product.row().read_back.ok().filter(|_| file.is_of_design())
    }

    /// Writes the files of the product.
    pub(super) fn write(
        self,
        source: &ExportSource<'_>,
        files: &Files<'_>,
        scene: Option<&Scene<'_>>,
    ) -> ProductFiles {
        match self.row().write {
            ProductWriter::Design(write) => write(source, files),
            ProductWriter::Either(write) => write(source, files, scene),
            ProductWriter::Scenario(write) => {
                let scene = scene.ok_or_else(|| WriteError::NoScene(self.keyword()))?;
                write(source, files, scene)
            }
        }
    }
}
