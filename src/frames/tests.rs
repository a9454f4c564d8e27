use super::*;

fn epoch(text: &str) -> Epoch {
    Epoch::from_utc(text.parse().unwrap())
}

fn sample() -> State<Teme> {
    State::new(
        Vector3::new(5094.18016210, 6127.64465950, 6380.34453270),
        Vector3::new(-4.746131487, 0.785818041, 5.531931288),
    )
}

/// Vallado et al., AIAA 2006-6753, appendix C: the state of 2004-04-06 07:51:28.386009 UTC in
/// TEME and in J2000 (IAU 1976/1980 without corrections, `ddpsi = ddeps = 0`).
/// The paper prints 1e-8 km. The equation of the equinoxes there includes the 1994 terms.
#[test]
fn validate_teme_to_j2000_of_aiaa_2006_6753() {
    let at = epoch("2004-04-06T07:51:28.386009Z");
    let j2000 = from_teme(sample(), Eme2000, at, 0.0);
    let expected = Vector3::new(5102.50960000, 6123.01152000, 6378.13630000);
    assert!(
        (j2000.position_km - Position::new(expected)).norm() < 2e-6,
        "{:?}",
        j2000.position_km
    );
}

/// The same paper's PEF position, computed with the UT1 - UTC = -0.439 961 9 s of that day.
#[test]
fn validate_teme_to_pef_of_aiaa_2006_6753() {
    let ut1 = epoch("2004-04-06T07:51:28.386009Z").plus_seconds(-0.439_961_9);
    let rotation = EarthRotation::from_gmst(ut1.gmst_rad(0.0));
    let fixed = rotation.state_to_earth_fixed(sample());
    let position = Vector3::new(-1033.4750312, 7901.3055856, 6380.3445328);
    let velocity = Vector3::new(-3.225632747, -2.872442511, 5.531931288);
    assert!(
        (fixed.position_km - Position::new(position)).norm() < 1e-3,
        "{:?}",
        fixed.position_km
    );
    assert!(
        (fixed.velocity_km_s - velocity).norm() < 1e-6,
        "{:?}",
        fixed.velocity_km_s
    );
}

#[test]
fn every_frame_is_undone() {
    let at = epoch("2026-03-21T12:34:56Z");
    for frame in [Frame::Teme, Frame::Eme2000, Frame::Gcrf, Frame::EarthFixed] {
        let back = to_teme(from_teme(sample(), frame, at, 777.0), frame, at, 777.0);
        assert!(
            (back.position_km - sample().position_km).norm() < 1e-10,
            "{frame}"
        );
        assert!(
            (back.velocity_km_s - sample().velocity_km_s).norm() < 1e-13,
            "{frame}"
        );
        assert_eq!(frame.to_string().parse(), Ok(frame));
    }
    assert!("J2000".parse::<Frame>().is_err());
}

/// The Earth-fixed velocity is the derivative of the Earth-fixed position.
#[test]
fn earth_fixed_velocity_is_a_derivative() {
    let at = epoch("2025-01-01T00:00:00Z");
    let straight = |t: f64| State {
        position_km: sample().position_km + sample().velocity_km_s * t,
        ..sample()
    };
    let at_t = |t: f64| from_teme(straight(t), EarthFixed, at, t);
    let difference = (at_t(1.0).position_km - at_t(-1.0).position_km) / 2.0;
    // Central difference over 2 s: truncation v ω² / 6 is 1e-8 km/s.
    assert!((difference - at_t(0.0).velocity_km_s).norm() < 1e-7);
}

/// A satellite due east at 30° elevation, built by hand.
#[test]
fn validate_look_angles_of_a_built_geometry() {
    for surface in [Surface::Wgs84, Surface::Sphere] {
        let site = LocalFrame::new(surface, 0.7, 2.1);
        let line = site.east * 30f64.to_radians().cos() + site.up * 30f64.to_radians().sin();
        let (elevation, azimuth) = site.look_angles(site.origin_km + line * 1000.0);
        assert!((elevation.to_degrees() - 30.0).abs() < 1e-10);
        assert!((azimuth.to_degrees() - 90.0).abs() < 1e-10);
        // North increases latitude: 1 km north is 1 / 6371 rad, within the flattening.
        let latitude = |p: Position<EarthFixed>| (p.km().z / p.norm()).asin();
        let north = site.origin_km + site.north;
        let geocentric = latitude(north) - latitude(site.origin_km);
        assert!((geocentric * 6371.0 - 1.0).abs() < 0.01);
    }
}

/// The bias is 23 mas: 0.8 m in low orbit, and no more.
#[test]
fn validate_size_of_the_frame_bias() {
    let moved = eme2000_to_gcrf() * Vector3::new(7000.0, 0.0, 0.0) - Vector3::new(7000.0, 0.0, 0.0);
    // dα0 = -14.6 mas, ξ0 = -16.617 mas (IERS Conventions 2010, 5.4.4): the x axis moves by
    // sqrt(14.6² + 16.617²) mas.
    let mas = 1e-3 / 3600.0_f64 * std::f64::consts::PI / 180.0;
    let expected = 7000.0 * (14.6_f64.hypot(16.617)) * mas;
    assert!((moved.norm() - expected).abs() < 1e-6, "{}", moved.norm());
}

#[test]
fn ric_axes_of_a_circular_state() {
    let state = State::<Teme>::new(Vector3::new(7000.0, 0.0, 0.0), Vector3::new(0.0, 5.0, 5.0));
    let basis = ric_basis(&state).unwrap();
    let ric = basis * state.velocity_km_s;
    assert!((ric - Vector3::new(0.0, 50.0_f64.sqrt(), 0.0)).norm() < 1e-14);
    let parallel = State {
        velocity_km_s: state.position_km.km(),
        ..state
    };
    assert!(ric_basis(&parallel).is_none());
}
