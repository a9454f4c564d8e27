use super::*;
use crate::earth::GMST_RATE_RAD_S;
use crate::earth::Surface;
use crate::frames::{LocalFrame, Position};
use crate::orbit::j2::SecularRates;
use std::f64::consts::TAU;

fn epoch() -> Epoch {
    Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap())
}

fn earth_fixed(orbit: &GnssOrbit, elapsed_s: f64) -> Vector3<f64> {
    let state = orbit.state_at(elapsed_s).unwrap();
    EarthRotation::from_gmst(epoch().gmst_rad(elapsed_s))
        .to_earth_fixed(state.position_km)
        .km()
}

#[test]
fn validate_geostationary_satellites_stand_still() {
    let satellites = Preset::Beidou3.satellites(epoch());
    assert_eq!(satellites.len(), 30);
    for (satellite, longitude_deg) in satellites[27..].iter().zip([80.0, 110.5, 140.0_f64]) {
        for t in [0.0, 40_000.0, 86_340.0] {
            let p = earth_fixed(&satellite.orbit, t);
            assert!((p.y.atan2(p.x).to_degrees() - longitude_deg).abs() < 1e-10);
            assert!(p.z == 0.0 && (p.norm() - 42_164.17).abs() < 1e-9);
        }
    }
}

/// The three IGSO satellites cross the equator northwards at 118°E, a third of a sidereal
/// day after each other.
#[test]
fn validate_igso_share_one_ground_track() {
    let satellites = Preset::Beidou3.satellites(epoch());
    for (k, satellite) in satellites[24..27].iter().enumerate() {
        let crossing = TAU * k as f64 / 3.0 / GMST_RATE_RAD_S;
        let p = earth_fixed(&satellite.orbit, crossing);
        // 1e-8° is 7 m at this radius: the rate constant and gmst82 differ by that in a day.
        assert!((p.y.atan2(p.x).to_degrees() - 118.0).abs() < 1e-8, "{k}");
        assert!(p.z.abs() < 1e-6 && earth_fixed(&satellite.orbit, crossing + 60.0).z > 0.0);
    }
}

#[test]
fn velocities_are_derivatives() {
    let satellites = Preset::Beidou3.satellites(epoch());
    let quasi_zenith = Preset::Qzss.satellites(epoch());
    for satellite in satellites.iter().step_by(5).chain(&quasi_zenith) {
        let at = |t: f64| satellite.orbit.state_at(t).unwrap();
        let slope = (at(1001.0).position_km - at(999.0).position_km) / 2.0;
        // Central difference over 2 s: r n³/6 = 2e-8 km/s for the MEO.
        assert!(
            (slope - at(1000.0).velocity_km_s).norm() < 5e-8,
            "{}",
            satellite.name
        );
    }
}

/// The elements at the epoch, for constellations that propagate under secular J2.
fn elements(preset: Preset) -> Vec<crate::orbit::MeanElements> {
    let elements = |satellite: &GnssSatellite| match &satellite.orbit {
        GnssOrbit::Secular(orbit) => Some(orbit.elements_at(0.0)),
        _ => None,
    };
    preset
        .satellites(epoch())
        .iter()
        .filter_map(elements)
        .collect()
}

/// Degrees by which the ground track misses itself after revolutions from node to node.
fn track_shift_deg(preset: Preset, revolutions: f64, sidereal_days: f64) -> f64 {
    let rates = SecularRates::j2(&elements(preset)[0]);
    let nodal_s = TAU / rates.arg_latitude_rad_s();
    let turned = (GMST_RATE_RAD_S - rates.raan_rad_s) * nodal_s * revolutions;
    (sidereal_days * TAU - turned).to_degrees()
}

/// GPS: two revolutions a sidereal day, Galileo 17 in ten, GLONASS 17 in eight, BeiDou's MEO 13 in
/// seven (the interface control documents). A kilometre of semi-major axis is worth 0.02° a day,
/// and sources differ by some tenths of a kilometre.
#[test]
fn validate_ground_tracks_repeat() {
    for (preset, revolutions, days) in [
        (Preset::Gps, 2.0, 1.0),
        (Preset::Galileo, 17.0, 10.0),
        (Preset::Glonass, 17.0, 8.0),
        (Preset::Beidou3, 13.0, 7.0),
    ] {
        let per_day = track_shift_deg(preset, revolutions, days) / days;
        assert!(per_day.abs() < 0.015, "{preset}: {per_day}");
    }
}

/// The almanac of the GPS performance standard (2001, table A-2-1) has the node at
/// -4.4874e-7 °/s; the Moon and the Sun have a share in it that J2 has not.
#[test]
fn validate_gps_node_rate() {
    let rate_deg_s = SecularRates::j2(&elements(Preset::Gps)[0])
        .raan_rad_s
        .to_degrees();
    assert!((rate_deg_s / -4.4874e-7 - 1.0).abs() < 1e-3, "{rate_deg_s}");
}

/// The GLONASS ICD has a draconic period of 11 h 15 min 44 s ± 5 s.
#[test]
fn validate_glonass_period() {
    let rates = SecularRates::j2(&elements(Preset::Glonass)[0]);
    let nodal_s = TAU / rates.arg_latitude_rad_s();
    assert!((nodal_s - 40_544.0).abs() < 5.0, "{nodal_s}");
}

/// The four satellites of each GPS plane as the almanac of the same standard has them: mean
/// anomalies (table A-2-1) of planes D and F less that of their first satellite.
#[test]
fn validate_gps_slots_against_the_almanac() {
    let satellites = elements(Preset::Gps);
    let plane = |first: usize| {
        [0, 1, 2, 3].map(|n| {
            let apart = satellites[first + n].mean_anomaly_rad - satellites[first].mean_anomaly_rad;
            crate::units::wrap_360(apart.to_degrees())
        })
    };
    let published = [
        (12, [-50.074, -279.854, 209.856, -17.944]),
        (16, [11.746, -242.704, -119.234, -211.614]),
        (20, [53.586, 159.926, -80.094, -49.954]),
    ];
    for (first, anomalies) in published {
        for (ours, anomaly) in plane(first).into_iter().zip(anomalies) {
            let theirs = crate::units::wrap_360(anomaly - anomalies[0] + 1e-9);
            assert!((ours - theirs).abs() < 1e-6, "{first}: {ours} {theirs}");
        }
    }
}

/// Slots of the nominal constellations: six GPS planes 60° apart with four satellites; Galileo
/// and GLONASS with three planes 120° apart, eight satellites 45° apart, 15° from plane to plane.
#[test]
fn validate_slots() {
    let gps = elements(Preset::Gps);
    assert_eq!(gps.len(), 24);
    for (n, satellite) in gps.iter().enumerate() {
        let node = crate::units::wrap_360(272.847 + 60.0 * (n / 4) as f64);
        assert!((satellite.raan_rad.to_degrees() - node).abs() < 1e-9);
    }
    for preset in [Preset::Galileo, Preset::Glonass] {
        let satellites = elements(preset);
        assert_eq!(satellites.len(), 24);
        for (n, satellite) in satellites.iter().enumerate() {
            let (plane, place) = ((n / 8) as f64, (n % 8) as f64);
            let argument = crate::units::wrap_360(45.0 * place + 15.0 * plane);
            assert!((satellite.mean_anomaly_rad.to_degrees() - argument).abs() < 1e-9);
            assert!((satellite.raan_rad.to_degrees() - 120.0 * plane).abs() < 1e-9);
        }
    }
}

#[test]
fn names_are_unique_and_round_trip() {
    for &preset in Preset::ALL {
        assert_eq!(preset.keyword().parse(), Ok(preset));
        let satellites = preset.satellites(epoch());
        let mut names: Vec<_> = satellites.iter().map(|s| s.name.clone()).collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), satellites.len(), "{preset}");
    }
}

/// Look angles over a day, every five minutes: the elevation of each satellite, degrees.
fn elevations_deg(preset: Preset, latitude_deg: f64, longitude_deg: f64) -> Vec<Vec<f64>> {
    let [latitude, longitude] = [latitude_deg, longitude_deg].map(f64::to_radians);
    let site = LocalFrame::new(Surface::Wgs84, latitude, longitude);
    let elevation = |satellite: &GnssSatellite, k: u32| {
        let position = earth_fixed(&satellite.orbit, 300.0 * f64::from(k));
        site.look_angles(Position::new(position)).0.to_degrees()
    };
    let satellites = preset.satellites(epoch());
    let at = |k| satellites.iter().map(|one| elevation(one, k)).collect();
    (0..288).map(at).collect()
}

/// The orbit of the first quasi-zenith satellite as JAXA reported it on 27 September 2010: apogee height 38 950 km, perigee height
/// 32 618 km, inclination 41.0°, centre of the figure of eight at about 135°E. The period fixes the semi-major axis, so the heights
/// differ by what the eccentricity is rounded by: 0.0001 is 4 km.
#[test]
fn validate_quasi_zenith_orbit() {
    let satellites = Preset::Qzss.satellites(epoch());
    assert_eq!(satellites.len(), 4);
    let day_s = TAU / GMST_RATE_RAD_S;
    for (member, satellite) in satellites[..3].iter().enumerate() {
        let states: Vec<_> = (0..2880)
            .map(|k| earth_fixed(&satellite.orbit, day_s * f64::from(k) / 2880.0))
            .collect();
        let heights = states.iter().map(|p| p.norm() - crate::earth::RADIUS_KM);
        let highest = heights.clone().fold(0.0, f64::max);
        let lowest = heights.fold(f64::INFINITY, f64::min);
        assert!((highest - 38_950.0).abs() < 5.0, "{highest}");
        assert!((lowest - 32_618.0).abs() < 10.0, "{lowest}");
        let northernmost = states.iter().map(|p| (p.z / p.norm()).asin().to_degrees());
        assert!((northernmost.fold(0.0, f64::max) - 41.0).abs() < 1e-3);
        let longitudes = states.iter().map(|p| p.y.atan2(p.x).to_degrees());
        let (west, east) = longitudes.fold((360.0_f64, 0.0_f64), |(west, east), x| {
            (west.min(x), east.max(x))
        });
        assert!(((west + east) / 2.0 - 135.0).abs() < 0.01, "{west} {east}");
        // The track closes, and all three are on it, a third of a sidereal day after each other.
        let start = earth_fixed(&satellite.orbit, 0.0);
        assert!((earth_fixed(&satellite.orbit, day_s) - start).norm() < 0.01);
        let behind = earth_fixed(&satellite.orbit, day_s * member as f64 / 3.0);
        assert!((behind - earth_fixed(&satellites[0].orbit, 0.0)).norm() < 0.01);
    }
    let geo = earth_fixed(&satellites[3].orbit, 0.0);
    assert!((geo.y.atan2(geo.x).to_degrees() - 127.0).abs() < 1e-9);
}

/// JAXA on the system: a satellite is near the zenith over Japan for about eight hours each day, so that three are always so. One
/// quasi-zenith satellite is above 70° in Tokyo at any time, each for more than eight hours; the GEO is high all day.
#[test]
fn validate_quasi_zenith_over_tokyo() {
    let elevations = elevations_deg(Preset::Qzss, 35.68, 139.77);
    let best = elevations
        .iter()
        .map(|sky| sky[..3].iter().copied().fold(0.0, f64::max));
    assert!(best.fold(90.0, f64::min) > 70.0);
    for satellite in 0..3 {
        let high = elevations
            .iter()
            .filter(|sky| sky[satellite] > 70.0)
            .count();
        let hours = high as f64 / 12.0;
        assert!((8.0..10.0).contains(&hours), "{hours}");
    }
    // 20° is what the system specifies its services for.
    let in_view = |sky: &Vec<f64>| sky.iter().filter(|e| **e > 20.0).count();
    assert!(elevations.iter().map(in_view).min() >= Some(3));
}

/// NavIC as its interface document has it: GEO at 32.5, 83 and 131.5°E, tracks of 29° that cross the equator at 55 and 111.75°E, in both
/// directions, with two satellites half a sidereal day apart on each.
#[test]
fn validate_navic_tracks() {
    let satellites = Preset::Navic.satellites(epoch());
    assert_eq!(satellites.len(), 7);
    let day_s = TAU / GMST_RATE_RAD_S;
    let longitude = |p: Vector3<f64>| p.y.atan2(p.x).to_degrees();
    let crossings = [(55.0, 0.0), (55.0, 0.5), (111.75, 0.25), (111.75, 0.75)];
    for (satellite, (expected_deg, share)) in satellites.iter().zip(crossings) {
        for half in [0.0, 0.5] {
            let p = earth_fixed(&satellite.orbit, day_s * (share + half));
            assert!(
                (longitude(p) - expected_deg).abs() < 1e-7,
                "{}",
                satellite.name
            );
            assert!(p.z.abs() < 1e-5);
        }
        let north = earth_fixed(&satellite.orbit, day_s * (share + 0.25));
        assert!(((north.z / north.norm()).asin().to_degrees() - 29.0).abs() < 1e-9);
    }
    for (satellite, expected_deg) in satellites[4..].iter().zip([32.5, 83.0, 131.5]) {
        assert!((longitude(earth_fixed(&satellite.orbit, 0.0)) - expected_deg).abs() < 1e-9);
    }
}

/// The system was laid out so that all its satellites are in view of India at all times (ISRO on IRNSS).
#[test]
fn validate_navic_is_always_in_view_of_india() {
    for (latitude_deg, longitude_deg) in [(28.61, 77.21), (12.97, 77.59)] {
        let elevations = elevations_deg(Preset::Navic, latitude_deg, longitude_deg);
        let lowest = elevations.iter().flatten().copied().fold(90.0, f64::min);
        assert!(lowest > 10.0, "{latitude_deg}: {lowest}");
    }
}

/// A phase of a medium orbit is the constellation of a study that starts a share of a sidereal day later, over the Earth of
/// that time; of a geosynchronous one it is the place on its track that much later. The rate of GMST is that of the
/// epoch: 1e-8° a day, or 7 m. A whole day changes nothing.
#[test]
fn validate_a_phase_against_a_later_start() {
    let share = 0.3;
    let later_s = share * TAU / GMST_RATE_RAD_S;
    let start = epoch().plus_seconds(later_s);
    for &preset in Preset::ALL {
        let nominal = preset.satellites(epoch());
        let later = preset.satellites(start);
        let phase = preset.satellites_at_phase(epoch(), share);
        let whole = preset.satellites_at_phase(epoch(), 1.0);
        for (n, phase) in phase.iter().enumerate() {
            for t in [0.0, 5000.0] {
                let place = earth_fixed(&phase.orbit, t);
                let expected = match nominal[n].orbit {
                    GnssOrbit::Secular(_) => {
                        let rotation = EarthRotation::from_gmst(start.gmst_rad(t));
                        let state = later[n].orbit.state_at(t).unwrap();
                        rotation.to_earth_fixed(state.position_km).km()
                    }
                    _ => earth_fixed(&nominal[n].orbit, t + later_s),
                };
                let apart = (place - expected).norm();
                assert!(apart < 0.02, "{preset} {}: {apart}", phase.name);
                let again = earth_fixed(&whole[n].orbit, t);
                let apart = (again - earth_fixed(&nominal[n].orbit, t)).norm();
                assert!(apart < 1e-6, "{preset} {}: {apart}", phase.name);
            }
        }
    }
}
