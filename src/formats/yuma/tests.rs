use super::*;
use crate::constellation::gnss::Preset;
use crate::frames::{EarthFixed, from_teme};
use crate::keyword::Keyword;
use crate::orbit::Propagator;
use nalgebra::Vector3;

fn epoch() -> Epoch {
    Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap())
}

/// 2025-01-01T00:00:18 GPS time is second 259 218 of week 2347 (the week of 2024-12-29).
#[test]
fn validate_week_and_time_of_applicability() {
    let at = Applicability::next_to(epoch());
    assert_eq!((at.week, at.toa_s), (2347, 258_048.0));
    assert_eq!(epoch().seconds_since(at.epoch()), 259_218.0 - 258_048.0);
    // Ten seconds before the week ends, the next multiple is in the new week.
    let late = Epoch::from_utc("2025-01-04T23:59:32Z".parse().unwrap());
    let at = Applicability::next_to(late);
    assert_eq!((at.week, at.toa_s), (2348, 0.0));
}

/// Every satellite of every preset is where its own propagation puts it, from a day before to a day after the time of
/// applicability, but for the shift of its radius; degrees for radians, or a node that is not turned by
/// sidereal time, are thousands of kilometres, and a leap second between the epoch and that time would be 3.
#[test]
fn almanacs_hold_the_presets() {
    hold_the_presets(epoch());
    let after_leap_second = Epoch::from_utc("2017-01-01T00:20:00Z".parse().unwrap());
    let at = Applicability::next_to(after_leap_second).epoch();
    assert_eq!(at.to_string(), "2016-12-31T23:59:43Z");
    hold_the_presets(after_leap_second);
}

fn hold_the_presets(epoch: Epoch) {
    let at = Applicability::next_to(epoch);
    for preset in Preset::ALL {
        for (n, satellite) in preset.satellites(epoch).iter().enumerate() {
            let almanac = Almanac::of(satellite, n as u32 + 1, epoch, at).unwrap();
            let shift_km = radius_shift_km(&almanac, &satellite.orbit);
            // 2/3 of J2 (R/a)² a: two kilometres at GNSS heights at most.
            assert!(shift_km.abs() < 2.0, "{shift_km}");
            for since_toa_s in [-86_400.0, 0.0, 30_000.0, 86_400.0] {
                let t = at.epoch().seconds_since(epoch) + since_toa_s;
                let propagated = satellite.orbit.state_at(t).unwrap();
                let ours = from_teme(propagated, EarthFixed, epoch, t).position_km.km();
                let theirs = almanac.position_km(since_toa_s).km();
                let moved = theirs - ours * (theirs.norm() / ours.norm());
                // The quadratic term of sidereal time is below a micrometre in a day.
                assert!(
                    moved.norm() < 1e-5,
                    "{preset} {}: {}",
                    satellite.name,
                    moved.norm()
                );
                // The shift of an ellipse is that of its semi-major axis in proportion.
                let mean_km = almanac.sqrt_a * almanac.sqrt_a / 1000.0;
                let shift_km = shift_km * theirs.norm() / mean_km;
                assert!((theirs.norm() - ours.norm() - shift_km).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn what_is_written_is_read() {
    let at = Applicability::next_to(epoch());
    let mut bytes = Vec::new();
    let written: Vec<Almanac> = Preset::Beidou3
        .satellites(epoch())
        .iter()
        .zip(1..)
        .map(|(satellite, prn)| Almanac::of(satellite, prn, epoch(), at).unwrap())
        .collect();
    for almanac in &written {
        almanac.write(&mut bytes).unwrap();
        bytes.push(b'\n');
    }
    let read = read(bytes.as_slice()).unwrap();
    assert_eq!(read.len(), 30);
    for (read, written) in read.iter().zip(&written) {
        assert_eq!(
            (read.prn, read.week, read.toa_s),
            (written.prn, 2347 % 1024, 258_048.0)
        );
        // Digits: 5e-8 of sqrt(A) is 0.5 m of radius, and 0.3 m more in-track in a day.
        let apart = read.position_km(86_400.0) - written.position_km(86_400.0);
        assert!(apart.norm() < 2e-3, "{}", apart.norm());
    }
}

/// An almanac as the Navigation Center publishes them: other widths and exponents.
#[test]
fn validate_a_published_form() {
    let text = "******** Week 295 almanac for PRN-01 ********\n\
        ID:                         01\nHealth:                     000\n\
        Eccentricity:               0.5149364471E-002\nTime of Applicability(s):  405504.0000\n\
        Orbital Inclination(rad):   0.9869852662\nRate of Right Ascen(r/s):  -0.7931758961E-008\n\
        SQRT(A)  (m 1/2):           5153.596191\nRight Ascen at Week(rad):  -0.1240000000E+001\n\
        Argument of Perigee(rad):   0.680129766\nMean Anom(rad):            -0.2413000000E+001\n\
        Af0(s):                     0.4196166992E-003\nAf1(s/s):                   0.0000000000E+000\n\
        week:                        295\n";
    let found = read(text.as_bytes()).unwrap();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].raan_rate_rad_s, -0.793_175_896_1e-8);
    assert_eq!(found[0].sqrt_a, 5153.596191);
    let broken = text.replace("0.9869852662", "north");
    let error = |text: &str| read(text.as_bytes()).unwrap_err().to_string();
    assert_eq!(
        error(&broken),
        "line 6, column 29: 'north' is not a number [yuma-number]"
    );
    let lacking = text.replace("SQRT(A)  (m 1/2):           5153.596191\n", "");
    assert!(error(&lacking).contains("has no 'SQRT(A)' [yuma-missing]"));
    let twice = text.replace("Health:", "ID: 2\nHealth:");
    assert!(error(&twice).starts_with("line 3, column 1: ID is given twice"));
    for (field, wrong) in [("000\nEcc", "-1\nEcc"), ("   295\n", "   295.7\n")] {
        let found = error(&text.replace(field, wrong));
        assert!(
            found.contains("is not a whole number, 0 or more"),
            "{found}"
        );
    }
    let low = text.replace("5153.596191", "5.153596191");
    assert!(error(&low).contains("[implausible-state]"));
}

/// Ten-bit weeks are taken as the ones nearest to the study; larger weeks are taken as they are: week 295 is that of 1985-09-01,
/// 2005-04-17 and 2024-12-01 (each 1024 weeks later), and 2343 the last of them in full.
#[test]
fn validate_weeks_are_those_next_to_the_study() {
    let of = |week: u32, near: &str| {
        let almanac = Almanac {
            week,
            toa_s: 405_504.0,
            ..Almanac::of(
                &Preset::Gps.satellites(epoch())[0],
                1,
                epoch(),
                Applicability::next_to(epoch()),
            )
            .unwrap()
        };
        let at = almanac.applicability(Epoch::from_utc(near.parse().unwrap()));
        at.utc().format("%Y-%m-%dT%H:%M:%S").to_string()
    };
    // 405 504 s are 4 days, 16 h 38 min 24 s; GPS time is ahead of UTC by 4, 13 and 18 s.
    assert_eq!(of(295, "2025-01-01T00:00:00Z"), "2024-12-05T16:38:06");
    assert_eq!(of(295, "2005-01-01T00:00:00Z"), "2005-04-21T16:38:11");
    assert_eq!(of(295, "1986-01-01T00:00:00Z"), "1985-09-05T16:38:20");
    assert_eq!(of(2343, "1986-01-01T00:00:00Z"), "2024-12-05T16:38:06");
}

/// On an ellipse the closed form holds: radius and speed from the anomaly by the vis-viva equation in inertial axes, and
/// the derivative of the position by differences.
#[test]
fn validate_an_eccentric_almanac_keeps_the_energy_of_its_ellipse() {
    let almanac = Almanac {
        eccentricity: 0.02,
        arg_perigee_rad: 0.7,
        raan_rate_rad_s: -8e-9,
        ..Almanac::of(
            &Preset::Gps.satellites(epoch())[0],
            1,
            epoch(),
            Applicability::next_to(epoch()),
        )
        .unwrap()
    };
    let a_km = almanac.sqrt_a.powi(2) / 1000.0;
    let mu = GPS_MU_M3_S2 * 1e-9;
    for t in [-80_000.0, 0.0, 12_345.0, 43_000.0] {
        let state = almanac.state(t);
        let h = 0.5;
        let apart = almanac.position_km(t + h) - almanac.position_km(t - h);
        // h² n² / 6 of 3 km/s: 1e-9; rounding 1e-12 km over 1 s.
        assert!(
            (apart / (2.0 * h) - state.velocity_km_s).norm() < 5e-9,
            "{t}"
        );
        // Without the turning of the node the plane is inertial.
        let turning = Vector3::z() * (almanac.raan_rate_rad_s - GPS_EARTH_RATE_RAD_S);
        let inertial = state.velocity_km_s - turning.cross(&state.position_km.km());
        let energy = 0.5 * inertial.norm_squared() - mu / state.position_km.norm();
        assert!((energy * -2.0 * a_km / mu - 1.0).abs() < 1e-12, "{t}");
    }
}
