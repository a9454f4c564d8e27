use super::*;
use crate::earth::RADIUS_KM;
use crate::ground::Grid;
use crate::ground::PointWeights;

/// Position over a place of the sphere.
fn over([longitude, latitude]: LonLat, altitude_km: f64) -> Position<EarthFixed> {
    let (latitude, longitude) = (latitude.to_radians(), longitude.to_radians());
    Position::new(Surface::Sphere.vertical(latitude, longitude) * (RADIUS_KM + altitude_km))
}

fn well_formed(rings: &[Vec<LonLat>]) {
    for ring in rings {
        assert_eq!(ring.first(), ring.last());
        assert!(signed_area(&ring[1..]) > 0.0, "clockwise: {ring:?}");
        for [longitude, latitude] in ring {
            assert!(longitude.abs() <= 180.0 && latitude.abs() <= 90.0);
        }
    }
}

/// On a sphere the angle at the centre is acos(R cos ε / r) - ε (Wertz, *Mission Geometry*,
/// equation 9-4 with elevation).
#[test]
fn validate_footprints_against_the_sphere() {
    for (place, mask_deg) in [
        ([10.0, 40.0], 7.0),
        ([-179.0, -88.0], 0.0),
        ([0.0, 90.0], 25.0),
    ] {
        let satellite = over(place, 925.0);
        let mask = f64::to_radians(mask_deg);
        let expected = (RADIUS_KM * mask.cos() / (RADIUS_KM + 925.0)).acos() - mask;
        for [longitude, latitude] in footprint(Surface::Sphere, satellite, mask) {
            let edge = over([longitude, latitude], 0.0);
            // The bisection ends at 2⁻⁴⁰ of a right angle.
            assert!((edge.km().angle(&satellite.km()) - expected).abs() < 1e-7);
        }
    }
}

/// Seen from the edge on the ellipsoid, the satellite is at the mask, by [`LocalFrame::look_angles`].
#[test]
fn edges_see_the_satellite_at_the_mask() {
    let satellite = over([100.0, 62.0], 925.0);
    let mask = 10_f64.to_radians();
    for [longitude, latitude] in footprint(Surface::Wgs84, satellite, mask) {
        let (lat, lon) = (latitude.to_radians(), longitude.to_radians());
        let elevation = LocalFrame::new(Surface::Wgs84, lat, lon)
            .look_angles(satellite)
            .0;
        assert!((elevation - mask).abs() < 1e-9, "{elevation}");
    }
}

/// Whether a place is in one of the rings, by counting their crossings of the meridian to the north of it.
fn holds(rings: &[Vec<LonLat>], [x, y]: LonLat) -> bool {
    rings.iter().any(|ring| {
        let crossings = ring.windows(2).filter(|pair| {
            let [a, b] = [pair[0], pair[1]];
            (a[0] > x) != (b[0] > x) && y < a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0])
        });
        crossings.count() % 2 == 1
    })
}

/// Places inside and outside footprints, including those over the poles and the antimeridian, checked by
/// the angle at the centre of the Earth.
#[test]
fn footprints_hold_what_sees_the_satellite() {
    let radius_deg = ((RADIUS_KM / (RADIUS_KM + 925.0)).acos()).to_degrees();
    for centre in [
        [0.0, 0.0],
        [179.0, 10.0],
        [-170.0, 50.0],
        [33.0, 85.0],
        [120.0, -89.9],
        [-180.0, 66.0],
    ] {
        let satellite = over(centre, 925.0);
        let rings = rings(&footprint(Surface::Sphere, satellite, 0.0));
        well_formed(&rings);
        for place in (-179..180).step_by(7).flat_map(|lon| {
            (-89..90)
                .step_by(4)
                .map(move |lat| [f64::from(lon) + 0.3, f64::from(lat) + 0.1])
        }) {
            let apart_deg = over(place, 0.0).km().angle(&satellite.km()).to_degrees();
            // Edges that are straight on the map deviate from the circle, most of all around a
            // pole, where 5° along the circle can be a right angle in longitude.
            if (apart_deg - radius_deg).abs() > 1.5 {
                assert_eq!(
                    holds(&rings, place),
                    apart_deg < radius_deg,
                    "{place:?} of {centre:?}"
                );
            }
        }
    }
}

/// A cap over a pole is one ring across the whole map, whatever its first corner.
#[test]
fn caps_over_a_pole_are_one_ring() {
    for place in [[33.0, 85.0], [-120.0, -89.9], [180.0, -80.0], [0.0, 90.0]] {
        let rings = rings(&footprint(Surface::Sphere, over(place, 925.0), 0.0));
        well_formed(&rings);
        assert_eq!(rings.len(), 1, "{place:?}");
        let longitudes = || rings[0].iter().map(|corner| corner[0]);
        assert_eq!(longitudes().reduce(f64::min), Some(-180.0));
        assert_eq!(longitudes().reduce(f64::max), Some(180.0));
        let pole = 90.0_f64.copysign(place[1]);
        assert_eq!(
            rings[0].iter().filter(|corner| corner[1] == pole).count(),
            2
        );
    }
}

#[test]
fn areas_are_cut_at_the_antimeridian() {
    let cut = rings(&[[170.0, 0.0], [-170.0, 0.0], [-170.0, 10.0], [170.0, 10.0]]);
    well_formed(&cut);
    assert_eq!(cut.len(), 2);
    let area: f64 = cut.iter().map(|ring| signed_area(&ring[1..])).sum();
    assert_eq!(area, 200.0);
    // Touching it is not crossing it.
    assert_eq!(cell_rings([[170.0, 0.0], [180.0, 5.0]]).len(), 1);
    assert_eq!(cell_rings([[-190.0, 0.0], [-180.0, 5.0]]).len(), 1);
    assert_eq!(cell_rings([[-180.0, 0.0], [180.0, 5.0]]).len(), 1);
}

#[test]
fn cells_stay_on_the_map() {
    let grid = Grid {
        latitude_deg: [-90.0, 90.0],
        longitude_deg: [-180.0, 180.0],
        step_deg: [45.0, 60.0],
        weights: PointWeights::Equal,
    };
    let mut area = 0.0;
    for latitude in grid.latitudes_deg().unwrap() {
        for longitude in grid.longitudes_deg().unwrap() {
            let cut = cell_rings(cell(grid.step_deg, [longitude, latitude]));
            well_formed(&cut);
            assert_eq!(cut.len(), if longitude == -180.0 { 2 } else { 1 });
            area += cut.iter().map(|ring| signed_area(&ring[1..])).sum::<f64>();
        }
    }
    assert!((area - 360.0 * 180.0).abs() < 1e-9, "{area}");
}

#[test]
fn tracks_are_cut_at_the_antimeridian() {
    let cut = lines(&[[170.0, 0.0], [178.0, 10.0], [-178.0, 20.0], [-170.0, 30.0]]);
    assert_eq!(
        cut,
        [
            vec![[170.0, 0.0], [178.0, 10.0], [180.0, 15.0]],
            vec![[-180.0, 15.0], [-178.0, 20.0], [-170.0, 30.0]]
        ]
    );
    let westwards = lines(&[[-178.0, 0.0], [178.0, 8.0]]);
    assert_eq!(westwards[1], [[180.0, 4.0], [178.0, 8.0]]);
    assert_eq!(lines(&[[1.0, 2.0], [3.0, 4.0]]).len(), 1);
}
