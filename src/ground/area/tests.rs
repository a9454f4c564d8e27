use super::*;
use crate::ground::{GroundError, PointWeights};

fn area(text: &str) -> ServiceArea {
    ServiceArea::from_geojson(text.as_bytes()).unwrap()
}

fn polygon(rings: &str) -> ServiceArea {
    area(&format!(r#"{{"type": "Polygon", "coordinates": {rings}}}"#))
}

#[track_caller]
fn refused(text: &str, message: &str) {
    let error = ServiceArea::from_geojson(text.as_bytes())
        .unwrap_err()
        .to_string();
    assert!(error.contains(message), "{error}");
}

#[track_caller]
fn refused_ring(ring: &str, message: &str) {
    refused(
        &format!(r#"{{"type": "Polygon", "coordinates": [{ring}]}}"#),
        message,
    );
}

fn lattice(step_deg: f64) -> AreaPoints {
    AreaPoints::Lattice {
        step_deg: [step_deg; 2],
        weights: PointWeights::Equal,
    }
}

fn places(points: AreaPoints, area: &ServiceArea) -> Vec<(f64, f64)> {
    let sites = points.sites(area, Surface::Wgs84).unwrap();
    sites
        .iter()
        .map(|site| (site.latitude_deg, site.longitude_deg))
        .collect()
}

const SQUARE: &str = "[[[0,0],[10,0],[10,10],[0,10],[0,0]]]";

#[test]
fn points_are_inside_by_the_half_open_rule() {
    let square = polygon(SQUARE);
    for (latitude, longitude, inside) in [
        (5.0, 5.0, true),
        (0.0, 0.0, true),
        (0.0, 10.0, false),
        (10.0, 0.0, false),
        (5.0, -355.0, true),
        (5.0, 365.0, true),
        (-1.0, 5.0, false),
    ] {
        assert_eq!(
            square.contains(latitude, longitude),
            inside,
            "{latitude} {longitude}"
        );
    }
}

/// The area of two neighbours has each point of the lattice once, also on their common border, straight or not.
#[test]
fn a_shared_border_counts_once() {
    let whole = places(lattice(1.0), &polygon(SQUARE));
    assert_eq!(whole.len(), 100);
    for border in [
        "[4,0],[4,10]",
        "[1,0],[9,10]",
        "[0.3,0],[7.1,3.3],[2,6],[9.7,10]",
    ] {
        let backwards: Vec<&str> = border.split("],[").collect();
        let backwards: Vec<String> = backwards
            .iter()
            .rev()
            .map(|one| format!("[{}]", one.trim_matches(['[', ']'])))
            .collect();
        let start = border.split("],").next().unwrap().to_owned() + "]";
        let west = polygon(&format!("[[{border},[0,10],[0,0],{start}]]"));
        let end = backwards[0].clone();
        let east = polygon(&format!("[[{},[10,0],[10,10],{end}]]", backwards.join(",")));
        let mut both = places(lattice(1.0), &west);
        both.extend(places(lattice(1.0), &east));
        both.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(both, whole, "{border}");
    }
}

#[test]
fn holes_and_several_polygons_are_read_in_every_wrapping() {
    let with_hole =
        polygon("[[[0,0],[10,0],[10,10],[0,10],[0,0]],[[4,4],[4,6],[6,6],[6,4],[4,4]]]");
    assert!(!with_hole.contains(5.0, 5.0) && with_hole.contains(2.0, 2.0));
    let island = r#"{"type": "Polygon", "coordinates": [[[4.5,4.5],[5.5,4.5],[5.5,5.5],[4.5,5.5],[4.5,4.5]]]}"#;
    let outer = "[[[0,0],[10,0],[10,10],[0,10],[0,0]],[[4,4],[4,6],[6,6],[6,4],[4,4]]]";
    let all = area(&format!(
        r#"{{"type": "FeatureCollection", "features": [
            {{"type": "Feature", "properties": null, "geometry": null}},
            {{"type": "Feature", "properties": {{}}, "geometry": {{"type": "GeometryCollection", "geometries": [
                {{"type": "MultiPolygon", "coordinates": [{outer}]}}, {island}]}}}}]}}"#
    ));
    assert!(all.contains(5.0, 5.0) && !all.contains(4.2, 4.2) && all.contains(2.0, 2.0));
    assert_eq!(all.outlines().len(), 3);
}

/// Across the antimeridian, in one ring or cut there (RFC 7946, 3.1.9): the same points, in one piece.
#[test]
fn areas_across_the_antimeridian_are_in_one_piece() {
    let one = polygon("[[[170,-10],[190,-10],[190,10],[170,10],[170,-10]]]");
    let west = polygon("[[[-190,-10],[-170,-10],[-170,10],[-190,10],[-190,-10]]]");
    let two = area(
        r#"{"type": "MultiPolygon", "coordinates": [
            [[[170,-10],[180,-10],[180,10],[170,10],[170,-10]]],
            [[[-180,-10],[-170,-10],[-170,10],[-180,10],[-180,-10]]]]}"#,
    );
    let expected = places(lattice(5.0), &one);
    assert_eq!(expected.len(), 16);
    assert_eq!(
        expected[..4],
        [
            (-10.0, 170.0),
            (-10.0, 175.0),
            (-10.0, 180.0),
            (-10.0, 185.0)
        ]
    );
    assert_eq!(places(lattice(5.0), &two), expected);
    assert_eq!(places(lattice(5.0), &west), expected);
    // East of Greenwich more than west: the other way around.
    let alaska = polygon("[[[172,50],[230,50],[230,70],[172,70],[172,50]]]");
    let longitudes: Vec<f64> = places(lattice(10.0), &alaska)
        .iter()
        .map(|place| place.1)
        .collect();
    assert_eq!(
        longitudes[..6],
        [-180.0, -170.0, -160.0, -150.0, -140.0, -180.0]
    );
}

#[test]
fn a_map_of_the_world_has_every_point_with_both_poles() {
    let world = polygon("[[[-180,-90],[180,-90],[180,90],[-180,90],[-180,-90]]]");
    assert_eq!(places(lattice(30.0), &world).len(), 7 * 12);
    let cells = AreaPoints::Cells { spacing_km: 1000.0 }
        .sites(&world, Surface::Wgs84)
        .unwrap();
    let globe = crate::ground::EqualAreaCells::globe(1000.0)
        .sites(Surface::Wgs84)
        .unwrap();
    assert_eq!(cells.len(), globe.len());
}

#[test]
fn the_lattice_is_anchored_at_zero() {
    let small = polygon("[[[0.95,0.95],[1.45,0.95],[1.45,1.25],[0.95,1.25],[0.95,0.95]]]");
    assert_eq!(
        places(lattice(0.2), &small),
        [
            (1.0, 1.0),
            (1.0, 1.2),
            (1.0, 1.4),
            (1.2, 1.0),
            (1.2, 1.2),
            (1.2, 1.4)
        ]
    );
    let weighted = AreaPoints::Lattice {
        step_deg: [60.0, 60.0],
        weights: PointWeights::CosLatitude,
    };
    let square = polygon("[[[-10,50],[10,50],[10,70],[-10,70],[-10,50]]]");
    let sites = weighted.sites(&square, Surface::Wgs84).unwrap();
    assert_eq!(sites.len(), 1);
    assert!((sites[0].weight - 0.5).abs() < 1e-15);
}

#[test]
fn an_area_between_the_points_is_told_which_spacing_has_some() {
    let small = polygon("[[[0.31,0.31],[0.39,0.31],[0.39,0.39],[0.31,0.39],[0.31,0.31]]]");
    let error = lattice(5.0).sites(&small, Surface::Wgs84).unwrap_err();
    // 0.1° is at 0.3 and 0.4; 0.05° at 0.35.
    assert!(
        matches!(
            error,
            GroundError::NoPoint {
                suggested: Some((0.05, 1)),
                ..
            }
        ),
        "{error}"
    );
    let message = error.to_string();
    assert!(
        message.starts_with("no point lies inside the area of 78.7")
            && message.ends_with("step-deg is 5 degrees; 0.05 gives 1 point"),
        "{message}"
    );
    let cells = AreaPoints::Cells { spacing_km: 5000.0 };
    let message = cells.sites(&small, Surface::Wgs84).unwrap_err().to_string();
    assert!(message.contains("spacing-km is 5000 km; "), "{message}");
    let sliver =
        polygon("[[[0.3100001,0.31],[0.3100002,0.31],[0.3100002,0.3100001],[0.3100001,0.31]]]");
    let message = lattice(5.0)
        .sites(&sliver, Surface::Wgs84)
        .unwrap_err()
        .to_string();
    assert!(
        message.ends_with("give a smaller one, or a list of points"),
        "{message}"
    );
    assert!(matches!(
        lattice(0.001).sites(&polygon(SQUARE), Surface::Wgs84),
        Err(GroundError::TooMany { .. })
    ));
}

/// Small cells are counted inside the area, not over the globe, of which there would be 500 million.
#[test]
fn small_cells_in_a_small_area() {
    let square = polygon("[[[6,49],[6.5,49],[6.5,49.5],[6,49.5],[6,49]]]");
    let cells = AreaPoints::Cells { spacing_km: 1.0 };
    let points = cells.sites(&square, Surface::Wgs84).unwrap().len() as f64;
    let area_km2 = square.area_km2(Surface::Wgs84);
    // The border of 180 km cuts a cell each km, half of which count.
    assert!(
        (points - area_km2).abs() < 0.25 * 180.0,
        "{points} {area_km2}"
    );
    let fine = lattice(1e-300).sites(&square, Surface::Wgs84).unwrap_err();
    assert_eq!(fine, GroundError::FineStep(1e-300));
}

#[test]
fn what_is_not_an_area_is_refused_with_its_place() {
    refused(
        "",
        "not GeoJSON: EOF while parsing a value at line 1 column 0",
    );
    refused("[1]", "the file: expected a GeoJSON object");
    refused(
        r#"{"type": "Topology"}"#,
        "the file: found \"Topology\", expected a Polygon",
    );
    refused(
        r#"{"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 2]}}]}"#,
        "features[0].geometry: found \"Point\", expected a Polygon or a MultiPolygon",
    );
    refused(
        r#"{"type": "FeatureCollection", "features": []}"#,
        "there is no polygon in it",
    );
    refused(
        r#"{"type": "Polygon"}"#,
        "coordinates: expected a list of rings",
    );
    refused(
        r#"{"type": "Polygon", "coordinates": [[["a", 1]]]}"#,
        "coordinates[0][0]: expected a position",
    );
    refused(
        r#"{"type": "Polygon", "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}}, "coordinates": []}"#,
        "crs: the coordinates are in urn:ogc:def:crs:EPSG::3857, expected WGS 84",
    );
    refused_ring(
        "[[0,0],[1,0],[0,0]]",
        "coordinates[0]: found 3 positions, expected at least 4",
    );
    refused_ring(
        "[[0,0],[1,0],[1,1],[0,1]]",
        "coordinates[0]: the ring is not closed",
    );
    refused_ring(
        "[[0,0],[1,0],[1,91],[0,0]]",
        "coordinates[0][2]: longitude 1, latitude 91 is out of range",
    );
    refused_ring(
        "[[0,0],[721,0],[1,1],[0,0]]",
        "coordinates[0][1]: longitude 721",
    );
    refused_ring(
        "[[177,-20],[-179,-20],[-179,-15],[177,-15],[177,-20]]",
        "coordinates[0][0]: the edge from longitude 177 to -179 spans more than 180 degrees",
    );
    refused(
        r#"{"type": "Polygon", "coordinates": [[[0,0],[9,0],[9,9],[0,0]], [[20,1],[21,1],[21,2],[20,1]]]}"#,
        "coordinates[1]: the hole reaches outside its polygon",
    );
    let named = polygon_with_known_system();
    assert!(named.contains(5.0, 5.0));
}

fn polygon_with_known_system() -> ServiceArea {
    area(&format!(
        r#"{{"type": "Polygon", "crs": {{"properties": {{"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}}}, "coordinates": {SQUARE}}}"#
    ))
}

#[test]
fn a_border_that_crosses_itself_is_refused_with_the_place() {
    refused_ring(
        "[[0,0],[10,10],[10,0],[0,10],[0,0]]",
        "coordinates: the border crosses itself near longitude 5.0000, latitude 5.0000",
    );
    refused(
        r#"{"type": "MultiPolygon", "coordinates": [[[[0,0],[9,0],[9,9],[0,9],[0,0]]], [[[0,0],[9,0],[9,9],[0,9],[0,0]],
            [[1,1],[9,4],[12,5],[1,5],[1,1]]]]}"#,
        "the hole reaches outside",
    );
    refused(
        r#"{"type": "Polygon", "coordinates": [[[0,0],[9,0],[9,9],[5,5],[0,9],[0,0]], [[4,4],[5,8],[6,4],[4,4]]]}"#,
        "coordinates: the border crosses itself near",
    );
    // Touching is allowed: a hole with a corner on the border, and two parts that meet in a point.
    polygon("[[[0,0],[9,0],[9,9],[0,9],[0,0]],[[3,0],[4,2],[2,2],[3,0]]]");
    polygon("[[[0,0],[5,5],[0,10],[10,10],[5,5],[10,0],[0,0]]]");
}

/// A wave around a circle with a hundred thousand positions takes seconds at the most, also when it crosses itself.
#[test]
fn large_polygons_are_checked() {
    let ring = |twist: f64| {
        let count = 100_000;
        let place = |n: usize| {
            let angle = std::f64::consts::TAU * (n % count) as f64 / count as f64;
            let radius = 30.0 + (200.0 * angle).sin();
            let [x, y] = [radius * angle.cos(), radius * angle.sin()];
            // Near the end the border jumps over its beginning.
            let y = if n == count - 3 { y + twist } else { y };
            format!("[{x},{y}]")
        };
        let places: Vec<String> = (0..=count).map(place).collect();
        format!(
            r#"{{"type": "Polygon", "coordinates": [[{}]]}}"#,
            places.join(",")
        )
    };
    let sound = area(&ring(0.0));
    // Straight in degrees, a wavy circle of mean square radius 900.5.
    assert!(sound.contains(0.0, 0.0));
    refused(&ring(0.5), "crosses itself near");
}

/// The same polygons with edges so short that geodesics and lines in longitude and latitude are the same: GeographicLib's
/// areas. An edge of 0.02° is off by 1e-8 of its distance to the parallel.
#[test]
#[cfg(feature = "validate")]
fn validate_areas_against_geographiclib() {
    use geographiclib_rs::{Geodesic, PolygonArea, Winding};
    let earth = Geodesic::wgs84();
    let rings: [Ring; 4] = [
        vec![
            [0.0, 0.0],
            [10.0, 0.0],
            [10.0, 10.0],
            [0.0, 10.0],
            [0.0, 0.0],
        ],
        vec![
            [73.0, 3.0],
            [136.0, 3.0],
            [136.0, 54.0],
            [73.0, 54.0],
            [73.0, 3.0],
        ],
        vec![[170.0, 60.0], [200.0, 50.0], [190.0, 85.0], [170.0, 60.0]],
        vec![
            [-70.0, -55.0],
            [-34.0, -7.0],
            [-60.0, 10.0],
            [-81.0, -5.0],
            [-70.0, -55.0],
        ],
    ];
    for ring in rings {
        let mut judge = PolygonArea::new(&earth, Winding::CounterClockwise);
        for pair in ring.windows(2) {
            let steps =
                ((pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]) / 0.02).ceil() as usize;
            for k in 0..steps {
                let share = k as f64 / steps as f64;
                let along = |axis: usize| pair[0][axis] + share * (pair[1][axis] - pair[0][axis]);
                judge.add_point(along(1), along(0));
            }
        }
        let (_, expected_m2, _) = judge.compute(true);
        let found = ServiceArea::of_polygons(vec![vec![ring.clone()]]).area_km2(Surface::Wgs84);
        let off = found / (expected_m2 / 1e6) - 1.0;
        assert!(off.abs() < 1e-6, "{ring:?}: {off:e}");
    }
}

/// On the sphere a rectangle is R² Δλ (sin φ₂ - sin φ₁), and a triangle with a corner at a pole that of its two other
/// corners' straight line: R² Δλ (1 - mean of sin φ).
#[test]
fn validate_areas_on_the_sphere() {
    let radius2 = crate::earth::RADIUS_KM * crate::earth::RADIUS_KM;
    let found = polygon("[[[20,30],[50,30],[50,60],[20,60],[20,30]]]").area_km2(Surface::Sphere);
    let expected = radius2 * 30_f64.to_radians() * (60_f64.to_radians().sin() - 0.5);
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    // From 0° to 90° over a turn of 90°: the mean of sin φ over φ is 2/π.
    let found = polygon("[[[0,0],[90,90],[0,90],[0,0]]]").area_km2(Surface::Sphere);
    let expected = radius2 * std::f64::consts::FRAC_PI_2 * (1.0 - std::f64::consts::FRAC_2_PI);
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    let holed = polygon("[[[0,0],[10,0],[10,10],[0,10],[0,0]],[[4,4],[4,6],[6,6],[6,4],[4,4]]]");
    let whole = polygon(SQUARE).area_km2(Surface::Sphere);
    let hole = polygon("[[[4,4],[4,6],[6,6],[6,4],[4,4]]]").area_km2(Surface::Sphere);
    assert!((holed.area_km2(Surface::Sphere) - (whole - hole)).abs() < 1e-6);
}

proptest::proptest! {
    /// Whatever the bytes, there is an area, whose points can be asked for, or an error, and no panic.
    #[test]
    fn damaged_files_give_an_area_or_an_error(
        at in proptest::prelude::any::<proptest::sample::Index>(),
        length in 0..12_usize,
        patch in "[-0-9.,\\[\\]{}\":eE a-z]{0,12}",
    ) {
        let text = r#"{"type": "MultiPolygon", "coordinates": [[[[170,-10],[190,-10],[190,10],[170,-10]],
            [[175,-9],[180,-9],[180,-8],[175,-9]]],[[[-60,80],[60,80],[60,90],[-60,90],[-60,80]]]]}"#;
        let from = at.index(text.len());
        let to = (from + length).min(text.len());
        let mut damaged = text.to_owned();
        damaged.replace_range(from..to, &patch);
        if let Ok(area) = ServiceArea::from_geojson(damaged.as_bytes()) {
            for points in [lattice(7.0), AreaPoints::Cells { spacing_km: 900.0 }] {
                let _ = points.sites(&area, Surface::Wgs84).map_err(|error| error.to_string());
            }
            assert!(area.area_km2(Surface::Sphere).is_finite());
        }
    }
}
