//! The messages of the CCSDS Navigation Data Messages family, in KVN, XML, JSON and CSV.

mod frame;
pub(crate) mod keywords;
pub(crate) mod kvn;
pub mod ndm;
pub mod oem;
pub mod omm;
pub mod opm;
pub(crate) mod xml;

pub use kvn::{CcsdsHeader, CcsdsVersion};
