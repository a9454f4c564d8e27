//! The arguments of `lifetime`.

use super::OutputFormat;
use crate::constellation::Design;
use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct LifetimeArgs {
    /// Designs, as `delta:55:182/13/1@925`: pattern, inclination, T/P/F and altitude; + joins shells.
    #[arg(value_name = "NOTATION", required = true)]
    pub(crate) designs: Vec<Design>,

    /// Mass of a satellite, kg.
    #[arg(long, value_name = "KG", default_value = "200")]
    pub(crate) mass_kg: f64,

    /// Its mean area across the track, m².
    #[arg(long, value_name = "M2", default_value = "2")]
    pub(crate) area_m2: f64,

    /// Its drag coefficient.
    #[arg(long, value_name = "CD", default_value = "2.2")]
    pub(crate) drag_coefficient: f64,

    /// Keep each satellite within this distance from its slot, along the track, km.
    #[arg(long, value_name = "KM", default_value = "5", value_parser = length)]
    pub(crate) box_km: f64,

    /// Error of the semi-major axis at injection, one sigma, km.
    #[arg(long, value_name = "KM", default_value = "0.1", value_parser = length)]
    pub(crate) sigma_a_km: f64,

    /// Error of the inclination at injection, one sigma, degrees.
    #[arg(long, value_name = "DEG", default_value = "0.01", value_parser = small_angle)]
    pub(crate) sigma_i_deg: f64,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Kilometres above zero, up to 1000.
fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(km) if km > 0.0 && km <= 1000.0 => Ok(km),
        _ => Err("expected kilometres above 0, at most 1000".to_owned()),
    }
}

/// Degrees above zero, up to 10.
fn small_angle(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(deg) if deg > 0.0 && deg <= 10.0 => Ok(deg),
        _ => Err("expected degrees above 0, at most 10".to_owned()),
    }
}
