use super::*;
use crate::ground::{RegionMap, Tiling};
use crate::keyword::Keyword;
use crate::report::coastline::Bounds;
use crate::report::figures::{
    Axis, AxisScale, Better, DeviationChart, Layer, MapChart, MeasureAxis, PlaneChart, Projection,
    RowChart, Style, TimelineChart,
};

fn plane() -> Chart {
    let layer = |name: &str, style| Layer {
        name: name.to_owned(),
        points: vec![(0.0, 1.0), (1.0, 3.0), (2.0, 2.0)],
        style,
    };
    Chart::Plane(PlaneChart {
        title: "A <title> & more".to_owned(),
        x: Axis::new("x (km)"),
        y: Axis::new("J_pos"),
        measure: MeasureAxis::Y,
        layers: vec![
            layer("faint", Style::Faint),
            layer("band", Style::Band(0)),
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
        colours: Axis::new("PDOP"),
        better: Better::Low,
        projection: Projection::PlateCarree,
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

fn row_chart(sizes: &[f64]) -> Chart {
    Chart::Rows(RowChart {
        title: "rows".to_owned(),
        x: "km".to_owned(),
        marks: vec!["a".to_owned(), "b".to_owned()],
        rows: vec![("one".to_owned(), sizes.to_vec())],
    })
}

fn drawn(chart: &Chart) -> String {
    drawn_on(chart, Sheet::default())
}

fn drawn_on(chart: &Chart, sheet: Sheet) -> String {
    let mut bytes = Vec::new();
    svg(chart, sheet, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// Every text of an SVG, read back with an XML parser.
fn texts(svg: &str) -> Vec<String> {
    let tree = usvg::roxmltree::Document::parse(svg).unwrap();
    let texts = tree.descendants().filter(|node| node.has_tag_name("text"));
    texts
        .map(|node| {
            node.descendants()
                .filter_map(|inner| inner.is_text().then(|| inner.text()).flatten())
                .collect::<String>()
                .trim()
                .to_owned()
        })
        .collect()
}

#[test]
fn figures_are_well_formed_and_carry_their_words() {
    let texts = texts(&drawn(&plane()));
    for word in ["A <title> & more", "x (km)", "Jpos", "faint", "cross"] {
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
        row_chart(&[0.5, 20.0]),
    ] {
        assert_eq!(drawn(&chart), drawn(&chart));
        let encoded = || {
            let mut bytes = Vec::new();
            png(&chart, Sheet::default(), &mut bytes).unwrap();
            bytes
        };
        assert_eq!(encoded(), encoded());
        let paged = || {
            let mut bytes = Vec::new();
            pdf(&chart, Sheet::default(), &mut bytes).unwrap();
            bytes
        };
        assert_eq!(paged(), paged());
    }
}

#[test]
fn a_png_has_text_without_system_fonts() {
    let mut bytes = Vec::new();
    png(&plane(), Sheet::default(), &mut bytes).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    // 180 mm at 300 dots per inch.
    assert_eq!(info.width, 2126);
    // The title is in the topmost strip, where there is nothing else.
    let strip = &pixels[..3 * info.width as usize * 60];
    let dark = strip.chunks(3).filter(|p| p[0] < 100).count();
    assert!(dark > 500, "{dark} dark dots in the title");
}

/// One value, equal values, none and extreme ones, in every chart, on the least, the usual and the largest sheet.
#[test]
fn degenerate_charts_are_drawn() {
    let one = |points: Vec<(f64, f64)>, scale| {
        let axis = Axis {
            scale,
            ..Axis::default()
        };
        let styles = [
            Style::Line(1),
            Style::Band(0),
            Style::Dots(0),
            Style::Marks(3),
            Style::Rule,
        ];
        let layer = |style| Layer {
            name: "a name <&> that is long ".repeat(9),
            points: points.clone(),
            style,
        };
        Chart::Plane(PlaneChart {
            title: String::new(),
            x: axis.clone(),
            y: axis,
            measure: MeasureAxis::X,
            layers: styles.map(layer).to_vec(),
        })
    };
    let of_map = |cells: Vec<(f64, f64, Option<f64>)>, projection| match map(None) {
        Chart::Map(chart) => Chart::Map(MapChart {
            cells,
            projection,
            ..chart
        }),
        other => other,
    };
    let timeline = |span| {
        Chart::Timeline(TimelineChart {
            title: String::new(),
            x: String::new(),
            span,
            rows: vec![("x".repeat(400), vec![[0.0, 9.0]])],
        })
    };
    let deviations = Chart::Deviations(DeviationChart {
        title: "t".repeat(900),
        x: String::new(),
        rows: vec![],
    });
    let mut charts = vec![deviations, timeline([0.0, 0.0]), timeline([0.0, 24.0])];
    for points in [
        vec![],
        vec![(3.0, 3.0)],
        vec![(0.0, 0.0); 2],
        vec![(-1e300, 1e-300), (1e300, 1e300)],
    ] {
        charts.extend([AxisScale::Linear, AxisScale::Log].map(|scale| one(points.clone(), scale)));
    }
    for cells in [
        vec![(10.0, 50.0, None)],
        vec![(10.0, 50.0, Some(2.0)); 3],
        vec![],
    ] {
        charts.extend(
            Projection::ALL
                .iter()
                .map(|one| of_map(cells.clone(), *one)),
        );
    }
    charts.extend([&[0.0][..], &[], &[1e-300, 1e300]].map(row_chart));
    let sheets = [(40.0, 4.0), (180.0, 8.0), (1200.0, 72.0), (85.0, 10.0)];
    for (width_mm, font_pt) in sheets {
        let sheet = Sheet::new(width_mm, font_pt).unwrap();
        for chart in &charts {
            assert!(drawn_on(chart, sheet).contains("</svg>"));
        }
    }
}

#[test]
fn sheets_without_room_are_refused() {
    for (width_mm, font_pt) in [
        (0.0, 8.0),
        (f64::NAN, 8.0),
        (180.0, 0.0),
        (40.0, 20.0),
        (1e9, 8.0),
    ] {
        assert!(
            Sheet::new(width_mm, font_pt).is_err(),
            "{width_mm} {font_pt}"
        );
    }
}

/// The PDF has its words as text in an embedded typeface.
#[test]
fn a_pdf_has_the_size_of_the_sheet_and_an_embedded_typeface() {
    let mut bytes = Vec::new();
    pdf(&plane(), Sheet::new(85.0, 7.0).unwrap(), &mut bytes).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.starts_with("%PDF-1.7"));
    // 85 mm are 240.94 points.
    assert!(text.contains("/MediaBox [0 0 240.9"), "{}", &text[..400]);
    for part in ["/FontFile2", "/ToUnicode", "/CIDFontType2", "/Arimo"] {
        assert!(text.contains(part), "{part}");
    }
}

/// Every cell reaches under its neighbours, so that no renderer leaves a seam: the planted error is an overlap of 0.
#[test]
fn cells_of_a_map_overlap() {
    let text = drawn(&map(Some([2.0, 2.0])));
    let across = |line: &str| -> Option<[f64; 2]> {
        let points = line.split("points=\"").nth(1)?.split('"').next()?;
        let xs = points
            .split_whitespace()
            .filter_map(|point| point.split(',').next()?.parse::<f64>().ok());
        let ends = xs.fold([f64::INFINITY, 0.0], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
        Some(ends)
    };
    let cells = text
        .lines()
        .filter(|line| line.starts_with("<polygon"))
        .filter_map(across);
    let cells: Vec<[f64; 2]> = cells.take(3).collect();
    assert!(
        cells[0][1] > cells[1][0] && cells[1][1] > cells[2][0],
        "{cells:?}"
    );
}
