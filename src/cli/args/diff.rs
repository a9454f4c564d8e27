//! Arguments of `navwalker diff`.

use super::OutputFormat;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct DiffArgs {
    /// The result to compare with: a directory or a file.
    pub(crate) a: PathBuf,

    /// The result that is compared.
    pub(crate) b: PathBuf,

    /// Numbers that differ by at most this, in their own unit, count as equal.
    #[arg(long, value_name = "VALUE", default_value = "0", allow_negative_numbers = true, value_parser = tolerance)]
    pub(crate) absolute: f64,

    /// Numbers that differ by at most this share of the larger one count as equal.
    #[arg(long, value_name = "SHARE", default_value = "0", allow_negative_numbers = true, value_parser = tolerance)]
    pub(crate) relative: f64,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

fn tolerance(text: &str) -> Result<f64, &'static str> {
    let found = text
        .parse()
        .ok()
        .filter(|value: &f64| value.is_finite() && *value >= 0.0);
    found.ok_or("expected a number, at least 0")
}
