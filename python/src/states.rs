//! Where the satellites of a constellation are, and where they are seen.

use crate::constellation::NativeConstellation;
use anyhow::Context;
use navwalker::ephemeris::sampled::Sampled;
use navwalker::evaluate::Setup;
use navwalker::frames::{EarthFixed, Frame};
use rayon::prelude::*;

/// Positions by satellite, in it by instant, km; the names of the satellites; and the number of instants.
pub(crate) fn positions(
    one: &NativeConstellation,
    setup: &Setup,
    frame: Frame,
) -> anyhow::Result<(Vec<f64>, Vec<String>, usize)> {
    let ephemeris = one.propagate(setup)?;
    let sampled = Sampled::new(&ephemeris, frame);
    let grid = sampled.grid();
    let of_satellite = |satellite| -> anyhow::Result<Vec<f64>> {
        let mut all = Vec::with_capacity(3 * grid.len());
        for (k, elapsed_s) in grid.iter().enumerate() {
            let state = ephemeris.state_or_gap(satellite, elapsed_s)?;
            match state.map(|teme| sampled.rotated(k, teme)) {
                Some(state) => all.extend(state.position_km.km().iter()),
                None => all.extend([f64::NAN; 3]),
            }
        }
        Ok(all)
    };
    let all = ephemeris.satellites().par_iter().map(of_satellite);
    let all = all.collect::<anyhow::Result<Vec<_>>>()?.concat();
    let names = ephemeris.satellites().iter().map(|one| one.name.clone());
    Ok((all, names.collect(), grid.len()))
}

/// Azimuths and elevations, each by satellite and in it by instant, degrees.
type Angles = (Vec<Vec<f64>>, Vec<Vec<f64>>);

/// Azimuths and elevations of every satellite from a ground point, by satellite and in it by instant, degrees.
pub(crate) fn look_angles(
    one: &NativeConstellation,
    setup: &Setup,
    point: usize,
) -> anyhow::Result<Angles> {
    let ephemeris = one.propagate(setup)?;
    let fixed = Sampled::new(&ephemeris, EarthFixed);
    let site = setup.sites.get(point).context("there is no such point")?;
    let (mut azimuths, mut elevations) = (Vec::new(), Vec::new());
    for satellite in ephemeris.satellites() {
        let mut angles = Vec::with_capacity(setup.grid.len());
        for (k, elapsed_s) in setup.grid.iter().enumerate() {
            let state = ephemeris.state_or_gap(satellite, elapsed_s)?;
            let seen = state.map(|teme| site.local.look_angles(fixed.rotated(k, teme).position_km));
            angles.push(seen.unwrap_or((f64::NAN, f64::NAN)));
        }
        azimuths.push(
            angles
                .iter()
                .map(|(_, azimuth)| azimuth.to_degrees())
                .collect(),
        );
        elevations.push(
            angles
                .iter()
                .map(|(elevation, _)| elevation.to_degrees())
                .collect(),
        );
    }
    Ok((azimuths, elevations))
}
