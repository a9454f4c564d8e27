//! `manifest.json`: the files of an export, their conventions, and the loss of each.

use crate::earth::{FLATTENING, J2, MU_KM3_S2, RADIUS_KM};
use crate::formats::WriteError;
use crate::formats::metadata::{Metadata, frame_comment};
use crate::frames::Frame;
use crate::printable::json;
use crate::time::leap_seconds_note;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io::{self, Write};

/// Name of the manifest among the files of an export.
pub const FILE_NAME: &str = "manifest.json";

/// Directory of the additional GNSS files.
pub(crate) const GNSS_DIRECTORY: &str = "gnss/";

/// Folder of the commands that build the study in STK.
pub(crate) const STK_SCENARIO_DIRECTORY: &str = "stk-scenario/";

/// The content of an export.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The program that wrote the files.
    pub program: String,
    /// Its version.
    pub version: String,
    /// The file beside it that says which build and command made the files, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub provenance: Option<String>,
    /// The study.
    pub scenario: ExportedStudy,
    /// The design, in Walker's notation; none for satellites from files alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub design: Option<String>,
    /// Satellites of the constellation that are out of service throughout, and in no file.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub out_of_service: usize,
    /// Name of the constellation, unless it is a design.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub constellation: Option<String>,
    /// Where satellites come from that are not of the design, and by which theory their states are made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub converted: Option<String>,
    /// What of the identities in files no format here can hold, and what is written instead.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changed_identities: Vec<ChangedIdentity>,
    /// First instant, UTC.
    pub epoch: String,
    /// Spacing of the samples, s.
    pub step_s: f64,
    /// Number of samples.
    pub samples: usize,
    /// The conventions behind every number.
    pub conventions: Conventions,
    /// The files, in the order in which they were written.
    pub files: Vec<FileEntry>,
}

/// An identifier of a satellite that is not written as its file has it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChangedIdentity {
    /// Which identifier.
    pub identifier: Identifier,
    /// As its file has it.
    pub source: String,
    /// As it is written.
    pub written: String,
}

/// What identifies a satellite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Identifier {
    /// Its name.
    Name,
    /// Its catalogue number.
    CatalogueNumber,
    /// Its international designator.
    Designator,
}

/// The study that an export belongs to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExportedStudy {
    /// Name of the scenario.
    pub name: String,
    /// Hash of the resolved scenario.
    pub hash: String,
}

/// The pinned conventions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Conventions {
    /// Gravitational parameter, km³/s².
    pub mu_km3_s2: f64,
    /// Equatorial radius, km; altitudes are over it.
    pub radius_km: f64,
    /// Second zonal harmonic.
    pub j2: f64,
    /// Flattening of the ellipsoid.
    pub flattening: f64,
    /// The rotations between the frames.
    pub frames: Vec<String>,
    /// UT1 and polar motion.
    pub earth_rotation: String,
    /// How far the pseudo-Earth-fixed frame is from an ITRF at the epoch.
    #[serde(default)]
    pub distance_from_itrf: String,
    /// The time scale of instants, and the treatment of leap seconds.
    #[serde(default)]
    pub time: String,
}

impl Conventions {
    /// The conventions of an export whose satellites are from an ITRF as `distance_from_itrf` says.
    #[must_use]
    pub fn new(distance_from_itrf: String) -> Self {
        let frames = [Frame::Teme, Frame::EarthFixed, Frame::Eme2000, Frame::Gcrf];
        Self {
            mu_km3_s2: MU_KM3_S2,
            radius_km: RADIUS_KM,
            j2: J2,
            flattening: FLATTENING,
            frames: frames.map(|frame| frame_comment(frame).to_owned()).into(),
            earth_rotation:
                "GMST (IAU 1982), UT1 = UTC at the epoch and even in SI seconds from there, no \
                             polar motion"
                    .to_owned(),
            distance_from_itrf,
            time: format!(
                "elapsed seconds are SI seconds from the epoch; stamps have {}",
                leap_seconds_note()
            ),
        }
    }
}

/// A file of an export.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileEntry {
    /// Path relative to the manifest, with `/`.
    pub path: String,
    /// Name of the format on the command line.
    pub format: String,
    /// Version of the format's standard.
    pub version: String,
    /// Number of satellites in it.
    pub objects: usize,
    /// Frame of its numbers.
    pub frame: String,
    /// Time system of its time tags.
    pub time_system: String,
    /// The theory behind its numbers.
    pub theory: String,
    /// The loss of the format relative to the model.
    pub loss: Loss,
    /// Settings the reading program needs to get the same numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assumptions: Vec<String>,
    /// SHA-256 of its bytes, in lower-case hexadecimal digits.
    pub sha256: String,
}

/// The loss of a format relative to the model of the study; null if not measured.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Loss {
    /// By rounding to the digits of the file, largest distance, km.
    pub quantisation_max_km: Option<f64>,
    /// The same, root mean square of the worst satellite, km.
    pub quantisation_rms_km: Option<f64>,
    /// SGP4 from the element sets relative to the propagated model, largest distance, km.
    pub theory_max_km: Option<f64>,
    /// The same, root mean square of the worst satellite, km.
    pub theory_rms_km: Option<f64>,
    /// By interpolation halfway between samples, largest distance, km.
    pub interpolation_max_km: Option<f64>,
    /// A further remark, in a sentence.
    pub note: Option<String>,
}

impl FileEntry {
    /// Whether the file holds satellites of the constellation, not a GNSS or what is around them in STK.
    #[must_use]
    pub fn is_of_design(&self) -> bool {
        let beside = [GNSS_DIRECTORY, STK_SCENARIO_DIRECTORY];
        !beside.iter().any(|folder| self.path.starts_with(folder))
    }

    /// The entry of a file that `metadata` describes.
    #[must_use]
    pub fn new(
        path: &str,
        format: &str,
        version: &str,
        objects: usize,
        metadata: &Metadata,
        loss: Loss,
        sha256: String,
    ) -> Self {
        Self {
            path: path.to_owned(),
            format: format.to_owned(),
            version: version.to_owned(),
            objects,
            frame: metadata.frame.to_string(),
            time_system: metadata.time_system.to_string(),
            theory: metadata.theory.to_string(),
            loss,
            assumptions: Vec::new(),
            sha256,
        }
    }

    /// The same entry with the settings that a reader needs.
    #[must_use]
    pub fn assuming(self, assumptions: Vec<String>) -> Self {
        Self {
            assumptions,
            ..self
        }
    }
}

impl Manifest {
    /// Writes the manifest as JSON with a final line end.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, out: &mut impl Write) -> Result<(), WriteError> {
        let json = json(self).map_err(io::Error::from)?;
        writeln!(out, "{json}")?;
        Ok(())
    }

    /// Reads a manifest.
    ///
    /// # Errors
    /// If the text is not a manifest; the error names line and column.
    pub fn read(input: impl io::Read) -> Result<Self, serde_json::Error> {
        serde_json::from_reader(input)
    }
}

/// Passes bytes on and computes their SHA-256.
pub struct HashingWriter<W> {
    inner: W,
    hash: Sha256,
}

impl<W: Write> HashingWriter<W> {
    /// Passes bytes on to `inner`.
    pub fn new(inner: W) -> Self {
        Self {
            inner,
            hash: Sha256::new(),
        }
    }

    /// Flushes, and returns the hash of all bytes in lower-case hexadecimal digits.
    ///
    /// # Errors
    /// If the destination cannot be flushed.
    pub fn finish(mut self) -> io::Result<String> {
        self.inner.flush()?;
        let digest = self.hash.finalize();
        Ok(digest.iter().map(|byte| format!("{byte:02x}")).collect())
    }
}

impl<W: Write> Write for HashingWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = self.inner.write(bytes)?;
        self.hash.update(&bytes[..taken]);
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// Whether there is nothing to say of a number.
#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde passes a reference"
)]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FIPS 180-4 example: the digest of "abc"; a destination that takes two bytes at a time
    /// makes no difference.
    #[test]
    fn validate_sha256_of_what_was_taken() {
        struct Slow(Vec<u8>);
        impl Write for Slow {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                let taken = bytes.len().min(2);
                self.0.extend_from_slice(&bytes[..taken]);
                Ok(taken)
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let mut out = HashingWriter::new(Slow(Vec::new()));
        out.write_all(b"abc").unwrap();
        assert_eq!(
            out.finish().unwrap(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }
}
