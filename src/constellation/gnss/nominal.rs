//! The nominal constellations, from the documents that define them.
//!
//! All are referred to the epoch of the study: the angles of a table, or Ω = M = 0 of the first
//! satellite, are mean elements in TEME at that instant, and the satellites are propagated under
//! secular J2. A study therefore has the nominal geometry whatever its date; the ground tracks follow
//! from the sidereal time of its epoch. For actual satellite positions, use element sets.

use super::{GeosynchronousOrbit, GnssOrbit, GnssSatellite};
use crate::constellation::{Pattern, Shell, ShellParameters};
use crate::earth::RADIUS_KM;
use crate::orbit::MeanElements;
use crate::orbit::j2::SecularOrbit;
use crate::time::Epoch;
use std::f64::consts::TAU;

/// BeiDou-3 as in Table I of the paper: MEO Walker 24/3/1 at 56° and 21 528 km; 3 IGSO at 55°.
///
/// The paper gives no slots. The GEO longitudes are the nominal ones of BeiDou-3 (China Satellite
/// Navigation Office, *BeiDou Open Service Performance Standard* 3.0, 2021); the IGSO share one
/// ground track that crosses the equator at 118°E.
pub(super) fn beidou3(epoch: Epoch) -> Vec<GnssSatellite> {
    let mut satellites = walker_24_3_1("MEO", 56.0, 21_528.0);
    for member in 0..3 {
        satellites.push(GnssSatellite {
            name: format!("IGSO-{}", member + 1),
            orbit: figure_of_eight(epoch, 55.0, 118.0, TAU * f64::from(member) / 3.0),
        });
    }
    satellites.extend(geostationary(epoch, &[80.0, 110.5, 140.0]));
    satellites
}

/// Geostationary satellites over these longitudes, degrees.
fn geostationary(epoch: Epoch, longitudes_deg: &[f64]) -> impl Iterator<Item = GnssSatellite> {
    (1..)
        .zip(longitudes_deg)
        .map(move |(number, longitude_deg)| GnssSatellite {
            name: format!("GEO-{number}"),
            orbit: GnssOrbit::Geostationary {
                longitude_rad: longitude_deg.to_radians(),
                epoch,
            },
        })
}

/// A circular orbit whose ground track crosses the equator at a longitude; northwards when the Earth has turned by
/// `behind_rad` since the epoch.
fn figure_of_eight(
    epoch: Epoch,
    inclination_deg: f64,
    longitude_deg: f64,
    behind_rad: f64,
) -> GnssOrbit {
    GnssOrbit::Geosynchronous(GeosynchronousOrbit {
        eccentricity: 0.0,
        arg_perigee_rad: 0.0,
        inclination_rad: inclination_deg.to_radians(),
        raan_rad: longitude_deg.to_radians() + epoch.gmst_rad(0.0) + behind_rad,
        argument_of_latitude_rad: -behind_rad,
    })
}

/// GPS as the 24 slots of the baseline constellation: six planes 60° apart with four satellites
/// each, unevenly spaced so that one may fail; 55°, 26 559.7 km, e = 0.
///
/// Source: *GPS Standard Positioning Service Performance Standard* (2001), tables 3-1 and A-2-1.
/// Its epoch is 1993-07-01T00:00:00Z; see the module documentation for how it is used here.
pub(super) fn gps() -> Vec<GnssSatellite> {
    let mut satellites = Vec::with_capacity(24);
    for (plane, raan_deg, arguments_deg) in GPS_PLANES {
        for (number, argument_deg) in (1..).zip(arguments_deg) {
            let elements = MeanElements {
                semi_major_axis_km: 26_559.7,
                eccentricity: 0.0,
                inclination_rad: 55_f64.to_radians(),
                raan_rad: raan_deg.to_radians(),
                arg_perigee_rad: 0.0,
                mean_anomaly_rad: argument_deg.to_radians(),
            };
            satellites.push(GnssSatellite {
                name: format!("{plane}{number}"),
                orbit: GnssOrbit::Secular(SecularOrbit::j2(&elements)),
            });
        }
    }
    satellites
}

/// Planes of GPS: letter, right ascension of the node and arguments of latitude, degrees.
const GPS_PLANES: [(char, f64, [f64; 4]); 6] = [
    ('A', 272.847, [268.126, 161.786, 11.676, 41.806]),
    ('B', 332.847, [80.956, 173.336, 309.976, 204.376]),
    ('C', 32.847, [111.876, 11.796, 339.666, 241.556]),
    ('D', 92.847, [135.226, 265.446, 35.156, 167.356]),
    ('E', 152.847, [197.046, 302.596, 66.066, 333.686]),
    ('F', 212.847, [238.886, 345.226, 105.206, 135.346]),
];

/// Galileo: Walker 24/3/1 at 56°, semi-major axis 29 600.318 km (23 222 km above the equator).
///
/// Source: *European GNSS (Galileo) Open Service Service Definition Document* (reference
/// constellation of 24 slots in three planes, 56°). The semi-major axis is the customary one, with
/// which 17 revolutions take ten sidereal days under J2; the almanac of the *OS SIS Interface
/// Control Document* refers to 29 600 km.
pub(super) fn galileo() -> Vec<GnssSatellite> {
    walker_24_3_1("GAL", 56.0, 29_600.318 - RADIUS_KM)
}

/// GLONASS: Walker 24/3/1 at 64.8°, semi-major axis 25 508 km, 17 revolutions in eight sidereal
/// days, 11 h 15 min 44 s each.
///
/// Source: *GLONASS Interface Control Document*, edition 5.1 (2008), section on the orbital
/// constellation: three planes 120° apart, eight satellites 45° apart, planes shifted by 15°.
pub(super) fn glonass() -> Vec<GnssSatellite> {
    walker_24_3_1("GLO", 64.8, 25_508.0 - RADIUS_KM)
}

/// QZSS as the system of four satellites in service since 2018: three in quasi-zenith orbits that share one ground track, a third
/// of a sidereal day after each other, and one GEO. The perigee is at the southernmost point.
///
/// Sources: *Quasi-Zenith Satellite System Interface Specification, Satellite Positioning, Navigation and Timing Service*
/// (IS-QZSS-PNT, as others quote it; e = 0.075, ω = 270°, GEO at 127°E); inclination 41° and centre of the figure of eight at 135°E as reported by JAXA for the
/// first satellite (press release of 27 September 2010: apogee 38 950 km, perigee 32 618 km, 41.0°, about 135°).
pub(super) fn qzss(epoch: Epoch) -> Vec<GnssSatellite> {
    let perigee_rad = 270_f64.to_radians();
    let orbit = |member: u32| {
        let behind_rad = TAU * f64::from(member) / 3.0;
        // The longitude of perigee is the centre of the track; the first satellite is there at the epoch.
        GnssOrbit::Geosynchronous(GeosynchronousOrbit {
            eccentricity: 0.075,
            arg_perigee_rad: perigee_rad,
            inclination_rad: 41_f64.to_radians(),
            raan_rad: 135_f64.to_radians() + epoch.gmst_rad(0.0) - perigee_rad + behind_rad,
            argument_of_latitude_rad: perigee_rad - behind_rad,
        })
    };
    let quasi_zenith = (0..3).map(|member| GnssSatellite {
        name: format!("QZO-{}", member + 1),
        orbit: orbit(member),
    });
    quasi_zenith.chain(geostationary(epoch, &[127.0])).collect()
}

/// NavIC as the system of seven satellites: four in circular geosynchronous orbits of 29°, two on each of two ground tracks, half a
/// sidereal day apart, and three GEO.
///
/// Source: ISRO, *Indian Regional Navigation Satellite System, Signal in Space ICD for Standard Positioning Service* 1.1
/// (2017): GEO at 32.5°, 83° and 131.5°E; inclined orbits that cross the equator at 55° and 111.75°E. The document gives no phase
/// from one ground track to the other; here they are a quarter of a sidereal day apart.
pub(super) fn navic(epoch: Epoch) -> Vec<GnssSatellite> {
    let tracks = [(55.0, 0.0), (55.0, 0.5), (111.75, 0.25), (111.75, 0.75)];
    let satellite = |(number, (longitude_deg, behind)): (u32, (f64, f64))| GnssSatellite {
        name: format!("GSO-{number}"),
        orbit: figure_of_eight(epoch, 29.0, longitude_deg, TAU * behind),
    };
    let inclined = (1..).zip(tracks).map(satellite);
    inclined
        .chain(geostationary(epoch, &[32.5, 83.0, 131.5]))
        .collect()
}

/// A circular Walker delta 24/3/1 under secular J2; the first satellite has Ω = M = 0.
fn walker_24_3_1(prefix: &str, inclination_deg: f64, altitude_km: f64) -> Vec<GnssSatellite> {
    let shell = Shell::new(ShellParameters {
        pattern: Pattern::Delta,
        planes: 3,
        satellites_per_plane: 8,
        phasing: 1,
        inclination_deg,
        altitude_km,
    });
    // The presets are constants of this module, covered by its tests.
    let satellites = shell.map(|shell| shell.satellites()).unwrap_or_default();
    (1..)
        .zip(satellites)
        .map(|(number, satellite)| GnssSatellite {
            name: format!("{prefix}-{number}"),
            orbit: GnssOrbit::Secular(SecularOrbit::j2(&satellite.elements)),
        })
        .collect()
}
