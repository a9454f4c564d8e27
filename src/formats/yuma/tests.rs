use super::*;
use crate::constellation::gnss::Preset;
use crate::frames::from_teme;
use crate::keyword::Keyword;
use crate::orbit::Propagator;

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
        // Digits: 5e-8 of sqrt(A) is 0.5 m of radius, and 0.3 m more along the track in a day.
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
    assert!(matches!(
        read(broken.as_bytes()),
        Err(ReadAlmanacError::Line { line: 6, .. })
    ));
    let lacking = text.replace("SQRT(A)  (m 1/2):           5153.596191\n", "");
    assert!(matches!(
        read(lacking.as_bytes()),
        Err(ReadAlmanacError::Lacks { key: "SQRT(A)", .. })
    ));
}
