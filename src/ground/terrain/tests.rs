use super::*;
use crate::earth::RADIUS_KM;

/// Nodes every `step_deg` over `rows` x `columns` around latitude and longitude 0, by the latitude and longitude of each.
fn around_zero(
    [rows, columns]: [usize; 2],
    step_deg: f64,
    height_m: impl Fn(f64, f64) -> f64,
) -> Terrain {
    let middle = |count: usize| (count / 2) as f64;
    let corner = [-middle(rows) * step_deg, -middle(columns) * step_deg];
    let nodes = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let height = |(row, column): (usize, usize)| {
        let at = |n: usize, count: usize| (n as f64 - middle(count)) * step_deg;
        height_m(at(row, rows), at(column, columns)) as f32
    };
    let raster = Raster::new(corner, [step_deg; 2], columns, nodes.map(height).collect());
    Terrain::new(raster.unwrap()).unwrap()
}

fn site(latitude_deg: f64, longitude_deg: f64) -> Site {
    Site::new(Surface::Sphere, latitude_deg, longitude_deg, 1.0).unwrap()
}

/// The skyline of the point at 0, 0 on a sphere.
fn skyline(terrain: &Terrain, antenna_m: f64) -> Vec<(f64, f64)> {
    let mut sites = [site(0.0, 0.0)];
    terrain
        .carry(&mut sites, Surface::Sphere, antenna_m)
        .unwrap();
    let skyline = sites[0].skyline.as_ref();
    skyline.map_or_else(Vec::new, |skyline| skyline.vertices().to_vec())
}

/// Elevation, degrees, of a height at a central angle on the sphere, from an antenna at another height.
fn elevation_deg(central_rad: f64, height_m: f64, antenna_m: f64) -> f64 {
    let (from_km, to_km) = (RADIUS_KM + antenna_m / 1e3, RADIUS_KM + height_m / 1e3);
    let up_km = to_km * central_rad.cos() - from_km;
    (up_km / (to_km * central_rad.sin())).atan().to_degrees()
}

/// Central angle and latitude, radians, at which a great circle from 0, 0 crosses a meridian: a right spherical triangle.
fn crossing(azimuth_deg: f64, meridian_deg: f64) -> (f64, f64) {
    let (sin, cos) = azimuth_deg.to_radians().sin_cos();
    let central_rad = (meridian_deg.to_radians().tan() / sin).atan();
    (central_rad, (central_rad.sin() * cos).asin())
}

/// Pieces of a ray are straight to 2 cm times the tangent of the latitude, here 1e-3, and heights are exact: 1e-5 m at 5 km
/// is 1e-7 degrees.
const CLOSE_DEG: f64 = 1e-6;

/// High ground begins along the meridian of 0.05°, 5.6 km away; its edge is the skyline. Over a flat Earth it would be
/// 0.025° higher.
#[test]
fn validate_a_wall() {
    let wall = around_zero([201, 201], 1e-3, |_, longitude| {
        if longitude > 0.0495 { 300.0 } else { 0.0 }
    });
    let skyline = skyline(&wall, 10.0);
    let mut compared = 0;
    for &(azimuth_deg, found_deg) in &skyline {
        let (central_rad, latitude_rad) = crossing(azimuth_deg, 0.05);
        let meets =
            azimuth_deg > 0.0 && azimuth_deg < 180.0 && latitude_rad.to_degrees().abs() < 0.0999;
        let expected_deg = if meets {
            elevation_deg(central_rad, 300.0, 10.0)
        } else {
            0.0
        };
        // Past the end of the wall a ray may climb its side.
        if meets || !(0.0..=180.0).contains(&azimuth_deg) {
            assert!(
                (found_deg - expected_deg).abs() < CLOSE_DEG,
                "{azimuth_deg}: {found_deg} {expected_deg}"
            );
            compared += 1;
        }
    }
    assert_eq!(compared, 253 + 360);
    // By hand: 290 m less 2.43 m of curvature, over 5566.3 m.
    assert!((skyline[180].1 - 2.9574).abs() < 1e-3, "{:?}", skyline[180]);
}

/// A crest along the meridian of -0.05° that rises northwards, between lattice lines that rays cross anywhere.
#[test]
fn validate_a_ridge() {
    let crest_m = |latitude_deg: f64| 256.0 + 2000.0 * latitude_deg;
    let ridge = around_zero([251, 251], 1e-3, |latitude, longitude| {
        crest_m(latitude) * (1.0 - 50.0 * (longitude + 0.05).abs()).max(0.0)
    });
    let skyline = skyline(&ridge, 2.0);
    for &(azimuth_deg, found_deg) in skyline.iter().filter(|one| (240.0..300.0).contains(&one.0)) {
        let (central_rad, latitude_rad) = crossing(azimuth_deg, -0.05);
        let height_m = crest_m(latitude_rad.to_degrees());
        let expected_deg = elevation_deg(central_rad, height_m, 2.0);
        // Heights of the terrain are in single precision: 1e-5 m.
        assert!(
            (found_deg - expected_deg).abs() < CLOSE_DEG,
            "{azimuth_deg}: {found_deg} {expected_deg}"
        );
    }
}

/// A street of 22 m from north to south between houses of 30 m: open along the street.
#[test]
fn validate_a_canyon() {
    let canyon = around_zero([401, 61], 1e-5, |_, longitude| {
        if longitude.abs() > 9.5e-5 { 30.0 } else { 0.0 }
    });
    let skyline = skyline(&canyon, 2.0);
    let mut compared = 0;
    for &(azimuth_deg, found_deg) in &skyline {
        let side_deg = if azimuth_deg < 180.0 { 1e-4 } else { -1e-4 };
        let (central_rad, latitude_rad) = crossing(azimuth_deg, side_deg);
        if latitude_rad.to_degrees().abs() < 1.99e-3 {
            let expected_deg = elevation_deg(central_rad, 30.0, 2.0);
            assert!(
                (found_deg - expected_deg).abs() < CLOSE_DEG,
                "{azimuth_deg}: {found_deg} {expected_deg}"
            );
            compared += 1;
        }
    }
    assert!(compared > 690, "{compared}");
    assert_eq!((skyline[0], skyline[360]), ((0.0, 0.0), (180.0, 0.0)));
    assert!((skyline[180].1 - 68.3).abs() < 0.1, "{:?}", skyline[180]);
}

/// On the ellipsoid: crests in the north and the south by the look angle to a point on each, and a summit of 1000 m that the
/// curvature hides at 150 km.
#[test]
fn validate_crests_on_the_ellipsoid() {
    let step_deg = 0.01;
    let rows = 301;
    let at = |row: usize| 45.0 + row as f64 * step_deg;
    let heights = |north_m: f32| {
        (0..rows)
            .flat_map(|row| {
                [if row == 200 {
                    north_m
                } else if row == 50 {
                    900.0
                } else {
                    0.0
                }; 3]
            })
            .collect::<Vec<f32>>()
    };
    let new = |north_m| {
        let raster = Raster::new([45.0, 9.99], [step_deg; 2], 3, heights(north_m));
        Terrain::new(raster.unwrap()).unwrap()
    };
    let place = |row: usize, height_m: f64| {
        let site = Site::new(Surface::Wgs84, at(row), 10.0, 1.0).unwrap();
        site.at_height_m(height_m).unwrap()
    };
    let seen = |terrain: &Terrain| {
        let mut sites = [place(100, 30.0)];
        terrain.carry(&mut sites, Surface::Wgs84, 0.0).unwrap();
        let skyline = sites[0].skyline.clone().unwrap();
        [skyline.degrees_at(0.0), skyline.degrees_at(180.0)]
    };
    let expected_deg = |row: usize, height_m: f64| {
        let target = place(row, height_m).local.origin_km;
        place(100, 30.0).local.look_angles(target).0.to_degrees()
    };
    let [north_deg, south_deg] = seen(&new(3000.0));
    // Straight pieces of 1 km at a latitude of 46 degrees: none in the meridian.
    assert!(
        (north_deg - expected_deg(200, 3000.0)).abs() < 1e-7,
        "{north_deg}"
    );
    assert!(
        (south_deg - expected_deg(50, 900.0)).abs() < 1e-7,
        "{south_deg}"
    );
    assert!(expected_deg(200, 800.0) < 0.0);
    assert_eq!(seen(&new(800.0))[0], 0.0);
}

/// A point on flat terrain is the same point without it, to the bit.
#[test]
fn flat_terrain_changes_nothing() {
    for surface in [Surface::Sphere, Surface::Wgs84] {
        let flat = around_zero([401, 401], 0.01, |_, _| 123.0);
        let places = [(0.0, 0.0), (0.123_456, -1.234_5), (-1.999, 1.5)];
        for antenna_m in [0.0, 2.0, 500.0] {
            let bare = places
                .map(|(latitude, longitude)| Site::new(surface, latitude, longitude, 1.0).unwrap());
            let mut standing = bare.clone();
            flat.carry(&mut standing, surface, antenna_m).unwrap();
            let raised = bare.map(|site| site.at_height_m(123.0 + antenna_m).unwrap());
            assert_eq!(standing, raised);
        }
    }
}

/// Heights between nodes are bilinear; those of a site are kept, as is its own skyline.
#[test]
fn points_stand_on_the_terrain() {
    let slope = around_zero([11, 11], 0.1, |latitude, longitude| {
        100.0 + 100.0 * latitude * longitude
    });
    let own = Arc::new(MaskTable::new(vec![(0.0, 1.0), (360.0, 1.0)]).unwrap());
    let mut sites = [site(0.25, 0.35), site(0.25, 0.35 + 360.0), site(0.25, 0.35)];
    sites[2] = sites[2].clone().at_height_m(400.0).unwrap();
    sites[2].skyline = Some(Arc::clone(&own));
    slope.carry(&mut sites, Surface::Sphere, 1.5).unwrap();
    for site in &sites[..2] {
        // Single precision of 100 m.
        assert!((site.height_m - 110.25).abs() < 1e-4, "{}", site.height_m);
    }
    assert_eq!((sites[2].height_m, &sites[2].skyline), (400.0, &Some(own)));
}

/// A height of 0 is one like any other: on the terrain, or below it.
#[test]
fn a_height_of_zero_is_kept() {
    let given = || site(0.25, 0.35).at_height_m(0.0).unwrap();
    let sea = around_zero([11, 11], 0.1, |_, _| 0.0);
    let mut sites = [site(0.25, 0.35), given()];
    sea.carry(&mut sites, Surface::Sphere, 1.5).unwrap();
    assert_eq!(sites.map(|site| site.height_m), [1.5, 0.0]);
    let land = around_zero([11, 11], 0.1, |_, _| 300.0);
    let error = land
        .carry(&mut [given()], Surface::Sphere, 1.5)
        .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("is at 0 m, 300.00 m below the terrain"),
        "{error}"
    );
}

#[test]
fn what_does_not_stand_is_told() {
    let told = |terrain: &Terrain, mut site: Site| {
        site.name = Some("A".into());
        let mut sites = [site];
        terrain
            .carry(&mut sites, Surface::Sphere, 2.0)
            .unwrap_err()
            .to_string()
    };
    let bowl = around_zero([21, 21], 0.01, |latitude, _| 50.0 + 1000.0 * latitude.abs());
    assert_eq!(
        told(&bowl, site(0.2, 0.0)),
        "the site A is outside the terrain, which reaches from latitude -0.1000 to 0.1000 and longitude -0.1000 to 0.1000"
    );
    let low = site(0.0, 0.0).at_height_m(20.0).unwrap();
    assert_eq!(
        told(&bowl, low),
        "the site A is at 20 m, 30.00 m below the terrain of 50.00 m there"
    );
    let holed = around_zero([21, 21], 0.01, |latitude, longitude| {
        if latitude > 0.055 && longitude > 0.055 {
            f64::NAN
        } else {
            50.0 + 100.0 * latitude.abs()
        }
    });
    let hole = told(&holed, site(0.0, 0.0));
    assert!(
        hole.starts_with("the terrain has a hole (NODATA) at latitude 0.0"),
        "{hole}"
    );
    assert!(
        hole.ends_with(
            ", in sight of the site A; fill it (gdal_fillnodata), or give the sea its height of 0"
        ),
        "{hole}"
    );
    let nodes = |height: f32| {
        let raster = Raster::new([0.0; 2], [0.1; 2], 2, vec![0.0, 0.0, 0.0, height]);
        Terrain::new(raster.unwrap())
    };
    let error = nodes(-9999.0).unwrap_err().to_string();
    assert!(
        error
            .starts_with("height -9999 m at latitude 0.1, longitude 0.1 is outside -500 to 9000 m"),
        "{error}"
    );
    assert!(nodes(f32::NAN).is_ok());
    let projected = Raster::new([5_000_000.0, 400_000.0], [30.0; 2], 2, vec![0.0; 4]);
    assert!(
        projected
            .unwrap_err()
            .to_string()
            .contains("are not degrees on the globe")
    );
    assert!(matches!(
        Raster::new([0.0; 2], [0.1; 2], 1, vec![0.0; 4]),
        Err(RasterError::Shape { .. })
    ));
}

/// Where the terrain ends in sight is told, and where a mountain hides what is beyond it is not.
#[test]
fn the_end_of_the_terrain_is_told() {
    let mut sites = [site(0.0, 0.0)];
    let hills = around_zero([21, 21], 0.01, |latitude, _| 1000.0 * latitude.abs());
    let end_km = hills
        .carry(&mut sites, Surface::Sphere, 2.0)
        .unwrap()
        .unwrap();
    // Pieces of 1 km.
    assert!((9.0..=11.2).contains(&end_km), "{end_km}");
    let crater = around_zero([21, 21], 0.01, |latitude, longitude| {
        if latitude.abs().max(longitude.abs()) > 0.035 {
            900.0
        } else {
            0.0
        }
    });
    let mut sites = [site(0.0, 0.0)];
    assert_eq!(crater.carry(&mut sites, Surface::Sphere, 2.0), Ok(None));
}
