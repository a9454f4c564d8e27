use super::*;
use crate::ground::{RegionMap, Tiling};
use crate::report::coastline::Bounds;
use crate::report::figures::{Layer, MapChart, Style};

fn plane() -> Chart {
    let layer = |name: &str, style| Layer {
        name: name.to_owned(),
        points: vec![(0.0, 1.0), (1.0, 3.0), (2.0, 2.0)],
        style,
    };
    Chart::Plane(PlaneChart {
        title: "A <title> & more".to_owned(),
        x: "x (km)".to_owned(),
        y: "y".to_owned(),
        layers: vec![
            layer("faint", Style::Faint),
            layer("dots", Style::Dots(1)),
            layer("line", Style::Line(0)),
            layer("rule", Style::Rule),
            layer("ring", Style::Marks(0)),
            layer("triangle", Style::Marks(1)),
            layer("cross", Style::Marks(2)),
        ],
    })
}

fn map(step_deg: Option<[f64; 2]>) -> Chart {
    Chart::Map(MapChart {
        title: "map".to_owned(),
        label: "PDOP".to_owned(),
        cells: vec![
            (10.0, 50.0, Some(1.5)),
            (12.0, 50.0, None),
            (14.0, 50.0, Some(2.5)),
        ],
        names: match step_deg {
            Some(_) => Vec::new(),
            None => ["Westerland", "", "Ostend"].map(str::to_owned).to_vec(),
        },
        map: RegionMap {
            tiling: step_deg.map(Tiling::Steps),
            outlines: vec![vec![[9.0, 49.0], [15.0, 49.0], [12.0, 53.0], [9.0, 49.0]]].into(),
            ..RegionMap::default()
        },
        bounds: Bounds {
            latitude_deg: [48.0, 56.0],
            longitude_deg: [7.0, 17.0],
        },
    })
}

fn bar_chart(sizes: &[f64]) -> Chart {
    Chart::Bars(BarChart {
        title: "bars".to_owned(),
        y: "km".to_owned(),
        bars: vec!["a".to_owned(), "b".to_owned()],
        groups: vec![("one".to_owned(), sizes.to_vec())],
    })
}

fn drawn(chart: &Chart) -> String {
    let mut bytes = Vec::new();
    svg(chart, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// Every text of an SVG, read back with an XML parser.
fn texts(svg: &str) -> Vec<String> {
    let tree = usvg::roxmltree::Document::parse(svg).unwrap();
    let texts = tree.descendants().filter(|node| node.has_tag_name("text"));
    texts
        .filter_map(|node| Some(node.text()?.trim().to_owned()))
        .collect()
}

#[test]
fn figures_are_well_formed_and_carry_their_words() {
    let texts = texts(&drawn(&plane()));
    for word in ["A <title> & more", "x (km)", "faint", "cross"] {
        assert!(
            texts.iter().any(|text| text == word),
            "{word} is not in {texts:?}"
        );
    }
}

#[test]
fn the_same_chart_has_the_same_bytes() {
    for chart in [
        plane(),
        map(Some([2.0, 2.0])),
        map(None),
        bar_chart(&[0.5, 20.0]),
    ] {
        assert_eq!(drawn(&chart), drawn(&chart));
        let encoded = || {
            let mut bytes = Vec::new();
            png(&chart, &mut bytes).unwrap();
            bytes
        };
        assert_eq!(encoded(), encoded());
    }
}

#[test]
fn a_png_has_text_without_system_fonts() {
    let mut bytes = Vec::new();
    png(&plane(), &mut bytes).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (3 * WIDTH, 3 * HEIGHT));
    // The title is in the topmost strip, where there is nothing else.
    let strip = &pixels[..3 * info.width as usize * 100];
    let dark = strip.chunks(3).filter(|p| p[0] < 100).count();
    assert!(dark > 500, "{dark} dark dots in the title");
}

#[test]
fn degenerate_charts_are_drawn() {
    let one = |points: Vec<(f64, f64)>| {
        Chart::Plane(PlaneChart {
            title: String::new(),
            x: String::new(),
            y: String::new(),
            layers: vec![Layer {
                name: String::new(),
                points,
                style: Style::Line(0),
            }],
        })
    };
    let unsolved = match map(None) {
        Chart::Map(chart) => Chart::Map(MapChart {
            cells: vec![(10.0, 50.0, None)],
            ..chart
        }),
        other => other,
    };
    for chart in [
        one(vec![]),
        one(vec![(3.0, 3.0)]),
        one(vec![(0.0, 0.0); 2]),
        unsolved,
        bar_chart(&[0.0]),
        bar_chart(&[]),
    ] {
        assert!(drawn(&chart).contains("</svg>"));
    }
}
