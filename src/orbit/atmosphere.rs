//! Mean density of the upper atmosphere at three levels of solar activity.

use crate::keyword::keywords;
use std::sync::LazyLock;

/// NRLMSISE-00 averaged over the globe, local time and the year, for the long-term activities of ECSS-E-ST-10-04C; see
/// `data/MANIFEST.toml`.
const DENSITIES: &str = include_str!("../../data/atmosphere/density.txt");

keywords! {
    /// How active the Sun is, over years (ECSS-E-ST-10-04C, long-term activities).
    SolarActivity {
        /// F10.7 = 65, Ap = 0.
        Low = "low",
        /// F10.7 = 140, Ap = 15.
        Moderate = "moderate",
        /// F10.7 = 250, Ap = 45.
        High = "high",
    }
}

/// A line of the table: altitude in km, and the logarithm of the density in kg/m³ at each activity.
type DensityLine = (f64, [f64; 3]);

static TABLE: LazyLock<Vec<DensityLine>> = LazyLock::new(|| {
    let lines = DENSITIES.lines().filter(|line| !line.starts_with('#'));
    lines.filter_map(line).collect()
});

fn line(text: &str) -> Option<DensityLine> {
    let mut numbers = text.split(' ').map_while(|word| word.parse::<f64>().ok());
    let altitude_km = numbers.next()?;
    let mut density = || Some(numbers.next()?.ln());
    Some((altitude_km, [density()?, density()?, density()?]))
}

/// Altitudes that have a density, km.
pub const ALTITUDES_KM: [f64; 2] = [100.0, 1500.0];

/// Mean density, kg/m³ ([M-68](crate::models#m-68)); `None` outside [`ALTITUDES_KM`].
///
/// Its logarithm is linear between altitudes 20 km apart. Means over a year and the planes of all nodes are within 4 % of it at
/// 40°, 55° and 90°; those of single revolutions are 0.54 to 1.46 times as large.
#[must_use]
pub fn mean_density_kg_m3(altitude_km: f64, activity: SolarActivity) -> Option<f64> {
    let above = TABLE.partition_point(|line| line.0 < altitude_km);
    let high = TABLE.get(above)?;
    let low = TABLE.get(above.saturating_sub(1))?;
    if !(low.0..=high.0).contains(&altitude_km) {
        return None;
    }
    let at = activity as usize;
    let span = high.0 - low.0;
    let part = if span > 0.0 {
        (altitude_km - low.0) / span
    } else {
        0.0
    };
    Some((low.1[at] + part * (high.1[at] - low.1[at])).exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keyword::Keyword;

    #[test]
    fn the_table_is_whole_and_interpolated() {
        assert_eq!(TABLE.len(), 71);
        let [low, high] = ALTITUDES_KM;
        assert_eq!((TABLE[0].0, TABLE[70].0), (low, high));
        for activity in SolarActivity::ALL {
            let of = |km: f64| mean_density_kg_m3(km, *activity);
            assert!(
                of(low - 0.001).is_none() && of(high + 0.001).is_none() && of(f64::NAN).is_none()
            );
            let (here, there) = (of(920.0).unwrap(), of(940.0).unwrap());
            assert!((of(930.0).unwrap() / (here * there).sqrt() - 1.0).abs() < 1e-12);
            assert!(of(low).is_some() && of(high).is_some());
        }
    }

    /// Densities of CIRA-72 as tabulated by Vallado, *Fundamentals of Astrodynamics* (4th ed.), table 8-4, for mean activity.
    #[test]
    fn validate_densities_against_cira_72() {
        for (altitude_km, published) in [
            (300.0, 2.418e-11),
            (400.0, 3.725e-12),
            (500.0, 6.967e-13),
            (600.0, 1.454e-13),
            (800.0, 1.170e-14),
        ] {
            let found = mean_density_kg_m3(altitude_km, SolarActivity::Moderate).unwrap();
            // Another model, and a mean activity that is not given; low and high activity are off by a factor of 3 or more.
            let ratio = found / published;
            assert!((0.7..1.4).contains(&ratio), "{altitude_km}: {ratio}");
        }
    }
}
