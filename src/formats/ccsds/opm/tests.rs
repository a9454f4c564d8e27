use super::*;
use crate::formats::ccsds::ndm;
use crate::formats::metadata::Theory;
use crate::formats::text::finding::{Finding, FindingList};
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::from_teme;
use crate::keyword::Keyword;
use crate::orbit::Model;
use nalgebra::Vector3;
use proptest::prelude::*;

/// An ellipse of Vallado, *Fundamentals of Astrodynamics and Applications*, example 2-5, with a
/// manoeuvre.
const VALLADO: &str = "\
CCSDS_OPM_VERS = 2.0
COMMENT example
CREATION_DATE = 2025-01-01T00:00:00
ORIGINATOR = NOBODY
OBJECT_NAME = A
OBJECT_ID = 2025-001A
CENTER_NAME = EARTH
REF_FRAME = EME2000
TIME_SYSTEM = UTC
EPOCH = 2025-01-01T00:00:00.000
X = 6524.834 [km]
Y = 6862.875
Z = 6448.296
X_DOT = 4.901327 [km/s]
Y_DOT = 5.533756
Z_DOT = -1.976341
SEMI_MAJOR_AXIS = 36127.343
ECCENTRICITY = 0.832853
INCLINATION = 87.870
RA_OF_ASC_NODE = 227.898
ARG_OF_PERICENTER = 53.38
TRUE_ANOMALY = 92.335
GM = 398600.4418
MAN_EPOCH_IGNITION = 2025-01-01T01:00:00
MAN_DURATION = 0.0
MAN_DELTA_MASS = -1.0
MAN_REF_FRAME = RTN
MAN_DV_1 = 0.0
MAN_DV_2 = 0.001
MAN_DV_3 = 0.0
USER_DEFINED_NOTE = kept
";

/// The same message in XML, with units and comments where a file may have them.
const VALLADO_XML: &str = "\
<?xml version=\"1.0\" encoding=\"UTF-8\"?>
<opm id=\"CCSDS_OPM_VERS\" version=\"2.0\">
<header>
<COMMENT>example</COMMENT>
<CREATION_DATE>2025-01-01T00:00:00</CREATION_DATE>
<ORIGINATOR>NOBODY</ORIGINATOR>
</header>
<body><segment>
<metadata>
<COMMENT>of no use</COMMENT>
<OBJECT_NAME>A</OBJECT_NAME>
<OBJECT_ID>2025-001A</OBJECT_ID>
<CENTER_NAME>EARTH</CENTER_NAME>
<REF_FRAME>EME2000</REF_FRAME>
<TIME_SYSTEM>UTC</TIME_SYSTEM>
</metadata>
<data>
<stateVector>
<EPOCH>2025-01-01T00:00:00.000</EPOCH>
<X units=\"km\">6524.834</X>
<Y units=\"km\">6862.875</Y>
<Z>6448.296</Z>
<X_DOT units=\"km/s\">4.901327</X_DOT>
<Y_DOT>5.533756</Y_DOT>
<Z_DOT>-1.976341</Z_DOT>
</stateVector>
<keplerianElements>
<SEMI_MAJOR_AXIS units=\"km\">36127.343</SEMI_MAJOR_AXIS>
<ECCENTRICITY>0.832853</ECCENTRICITY>
<INCLINATION units=\"deg\">87.870</INCLINATION>
<RA_OF_ASC_NODE>227.898</RA_OF_ASC_NODE>
<ARG_OF_PERICENTER>53.38</ARG_OF_PERICENTER>
<TRUE_ANOMALY>92.335</TRUE_ANOMALY>
<GM units=\"km**3/s**2\">398600.4418</GM>
</keplerianElements>
<spacecraftParameters><MASS units=\"kg\">100.0</MASS></spacecraftParameters>
<maneuverParameters>
<MAN_EPOCH_IGNITION>2025-01-01T01:00:00</MAN_EPOCH_IGNITION>
<MAN_DURATION>0.0</MAN_DURATION>
<MAN_DELTA_MASS>-1.0</MAN_DELTA_MASS>
<MAN_REF_FRAME>RTN</MAN_REF_FRAME>
<MAN_DV_1>0.0</MAN_DV_1>
<MAN_DV_2>0.001</MAN_DV_2>
<MAN_DV_3>0.0</MAN_DV_3>
</maneuverParameters>
<userDefinedParameters>
<USER_DEFINED parameter=\"NOTE\">kept</USER_DEFINED>
</userDefinedParameters>
</data>
</segment></body>
</opm>
";

fn findings(text: impl AsRef<[u8]>) -> Vec<Finding> {
    let mut findings = FindingList::of_linter(50);
    let text = text.as_ref();
    if text.starts_with(b"<?xml") {
        ndm::parse(text, &["opm"], &mut findings, |_| ()).unwrap();
    } else {
        parse(text, &mut findings).unwrap();
    }
    let found = findings.into_vec();
    // These examples are of other orbits than those that are imported.
    let broken = found.into_iter().filter(|one| one.rule != "unsupported");
    broken.collect()
}

#[test]
fn validate_a_published_state_and_its_elements() {
    assert_eq!(findings(VALLADO), []);
    let message = read(VALLADO.as_bytes()).unwrap();
    let published = message.keplerian.unwrap();
    let found = Keplerian::of_state(&message.state, published.gm_km3_s2).unwrap();
    // The printed state has seven digits and the printed elements at least five: half a unit of
    // the last, with the sensitivity of a at e = 0.83 (a changes by 2a²v/mu per km/s: 5e-7 km/s
    // make 0.02 km).
    assert!((found.semi_major_axis_km - published.semi_major_axis_km).abs() < 0.1);
    assert!((found.eccentricity - published.eccentricity).abs() < 1e-6);
    for (ours, theirs) in [
        (found.inclination_deg, published.inclination_deg),
        (found.raan_deg, published.raan_deg),
        (found.arg_perigee_deg, published.arg_perigee_deg),
        (found.true_anomaly_deg, published.true_anomaly_deg),
    ] {
        assert!((ours - theirs).abs() < 6e-3, "{ours} {theirs}");
    }
    // tan(E/2) = sqrt((1-e)/(1+e)) tan(92.335°/2) gives E = 34.9234°, and M = E - e sin E.
    let mean = VALLADO.replace("TRUE_ANOMALY = 92.335", "MEAN_ANOMALY = 7.6043");
    let of_mean = read(mean.as_bytes()).unwrap().keplerian.unwrap();
    assert!(
        (of_mean.true_anomaly_deg - 92.335).abs() < 6e-3,
        "{}",
        of_mean.true_anomaly_deg
    );
    assert_eq!(
        message.user_defined,
        [("USER_DEFINED_NOTE".to_owned(), "kept".to_owned())]
    );
    assert_eq!(message.mean_elements(), None);
}

fn written(frame: Frame, design: &str) -> (MeanElements, Opm) {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let design: crate::constellation::Design = design.parse().unwrap();
    let elements = design.satellites()[4].elements;
    let teme = Model::J2
        .propagator(&elements, epoch)
        .unwrap()
        .state_at(0.0)
        .unwrap();
    let metadata = Metadata {
        originator: "NAVWALKER".to_owned(),
        creation: epoch,
        frame,
        time_system: TimeSystem::Tai,
        theory: Theory::Propagated(Model::J2),
        subject: vec!["Design".to_owned()],
        frame_note: None,
        from_files: false,
    };
    let object = Object::numbered("NW-P02-S02", 4, epoch).unwrap();
    let state = from_teme(teme, frame, epoch, 0.0);
    (
        elements,
        Opm::new(
            CcsdsVersion::V2,
            &metadata,
            &object,
            Some(&elements),
            epoch,
            state,
        ),
    )
}

#[test]
fn what_is_written_reads_back_and_writes_the_same() {
    for frame in [Frame::Teme, Frame::Eme2000, Frame::Gcrf, Frame::EarthFixed] {
        for design in [
            "delta:55:6/2/1@925",
            "star:90:6/2/1@780",
            "lattice:63.4:6/3/1@950,e=0.1,w=270",
        ] {
            let (elements, message) = written(frame, design);
            let mut text = Vec::new();
            message.write(&mut text).unwrap();
            assert_eq!(findings(&text), [], "{frame} {design}");
            let read = read(text.as_slice()).unwrap();
            assert_eq!(xml_again(&message), read, "{frame} {design}");
            assert_eq!(read.keplerian.is_some(), frame != Frame::EarthFixed);
            let mut again = Vec::new();
            read.write(&mut again).unwrap();
            assert_eq!(again, text);
            // Half a digit of a position.
            assert!((read.state.position_km - message.state.position_km).norm() < 1e-9);
            let mean = read.mean_elements().unwrap();
            // Twelve decimals of a degree, nine of a kilometre.
            assert!((mean.mean_anomaly_rad - elements.mean_anomaly_rad).abs() < 1e-14);
            assert!((mean.semi_major_axis_km - elements.semi_major_axis_km).abs() < 1e-9);
        }
    }
}

/// The mean elements are propagated, and the state beside them must be of the same orbit, in a frame that is known.
#[test]
fn mean_elements_and_state_are_of_one_orbit() {
    for syntax in OpmSyntax::ALL {
        let (_, message) = written(Frame::Eme2000, "delta:55:6/2/1@925");
        let mut bytes = Vec::new();
        message.write_as(*syntax, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(findings(&text), [], "{syntax}");
        let is_xml = *syntax == OpmSyntax::Xml;
        let value = |key: &str| {
            let after = match (is_xml, key.strip_prefix(USER_DEFINED)) {
                (false, _) => format!("\n{key} = "),
                (true, Some(name)) => format!("\"{name}\">"),
                (true, None) => format!("<{key}>"),
            };
            let at = text.find(&after).unwrap() + after.len();
            let end = text[at..].find(['\n', '<']).unwrap();
            (at, at + end)
        };
        let with = |key: &str, new: &str| {
            let (from, to) = value(key);
            format!("{}{new}{}", &text[..from], &text[to..])
        };
        let swapped = |one: &str, other: &str| {
            let ((a, b), (c, d)) = (value(one), value(other));
            let (first, second) = (&text[a..b], &text[c..d]);
            format!("{}{second}{}{first}{}", &text[..a], &text[b..c], &text[d..])
        };
        let [a_km, _, i_deg, _, _, anomaly_deg] = MEAN;
        for (damaged, rule) in [
            (swapped("X", "Y"), "opm-mean-elements"),
            (swapped("X_DOT", "Y_DOT"), "opm-mean-elements"),
            (with(i_deg, "0.959931088597"), "opm-mean-elements"),
            (with(anomaly_deg, "0.0"), "opm-mean-elements"),
            (with(a_km, "7403.137"), "opm-mean-elements"),
            (with(a_km, "7313.137"), ""),
            (with("REF_FRAME", "ITRF2014"), "opm-mean-elements"),
            (with("REF_FRAME", "TOD"), "opm-frame"),
            (with("REF_FRAME", "NONE"), "opm-frame"),
            (with("TIME_SYSTEM", "UT1"), "unsupported"),
        ] {
            let mut all = FindingList::of_linter(50);
            match is_xml {
                true => ndm::parse(damaged.as_bytes(), &["opm"], &mut all, |_| ()).unwrap(),
                false => drop(parse(damaged.as_bytes(), &mut all).unwrap()),
            }
            let rules: Vec<&str> = all.into_vec().iter().map(|one| one.rule).collect();
            let expected = Vec::from_iter(Some(rule).filter(|rule| !rule.is_empty()));
            assert_eq!(rules, expected, "{damaged}");
        }
    }
    // In a frame that turns, only the one of date is known.
    let (_, message) = written(Frame::Teme, "delta:55:6/2/1@925");
    let mut bytes = Vec::new();
    message.write(&mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let of_epoch = "REF_FRAME = TEME\nREF_FRAME_EPOCH = 2025-01-01T00:00:00\n";
    let text = text.replacen("REF_FRAME = TEME\n", of_epoch, 1);
    assert_eq!(findings(&text)[0].rule, "opm-frame");
}

/// States of every theory that is exported are within the limit of their mean elements, at any altitude and place.
#[test]
fn periodic_terms_are_within_the_limit() {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let mut nearest = 0.0_f64;
    for model in Model::ALL {
        for design in [
            "delta:0:8/1/0@300",
            "delta:30:8/1/0@400",
            "delta:55:8/1/0@925",
            "delta:90:8/1/0@500",
            "delta:56:8/1/0@21528",
            "lattice:63.4:8/1/0@900,e=0.1,w=270",
            "lattice:116.6:8/1/0@5000,e=0.3,w=90",
        ] {
            let design: crate::constellation::Design = design.parse().unwrap();
            for satellite in design.satellites() {
                let propagator = model.propagator(&satellite.elements, epoch).unwrap();
                let teme = propagator.state_at(0.0).unwrap();
                let state = from_teme(teme, Frame::Gcrf, epoch, 0.0);
                let (_, message) = written(Frame::Gcrf, "delta:55:6/2/1@925");
                let message = Opm {
                    state,
                    user_defined: mean_parameters(&satellite.elements),
                    ..message
                };
                let apart = read::elements_apart(&message).unwrap();
                nearest = nearest.max(apart.distance_km / apart.limit_km);
            }
        }
    }
    // Twice the sum of the amplitudes, which are rarely all reached at once.
    assert!((0.1..0.5).contains(&nearest), "{nearest}");
}

/// The message by way of XML.
fn xml_again(message: &Opm) -> Opm {
    let mut xml = Vec::new();
    message.write_xml(&mut xml).unwrap();
    assert_eq!(findings(&xml), []);
    read_xml(xml.as_slice()).unwrap().remove(0)
}

/// Both notations say the same, and broken rules have their place in XML too.
#[test]
fn xml_is_read_as_keyword_and_value() {
    assert_eq!(findings(VALLADO_XML), []);
    let read = read_xml(VALLADO_XML.as_bytes()).unwrap();
    assert_eq!(read, [super::read(VALLADO.as_bytes()).unwrap()]);
    let odd = Opm {
        object_name: "A & <B>".to_owned(),
        user_defined: vec![("USER_DEFINED_A\"B".to_owned(), "1 < 2".to_owned())],
        ..read[0].clone()
    };
    assert_eq!(xml_again(&odd), odd);
    for (from, to, (line, rule)) in [
        ("<X units=\"km\">", "<X units=\"m\">", (20, "ccsds-unit")),
        ("<Z>6448.296</Z>\n", "", (50, "ccsds-missing")),
        ("<Z>6448.296", "<Z>6448,296", (22, "ccsds-number")),
        ("<GM units", "<GN units", (34, "xml-syntax")),
        ("<MAN_DV_2>0.001</MAN_DV_2>\n", "", (44, "ccsds-missing")),
        (" parameter=\"NOTE\"", "", (47, "ccsds-missing")),
        (
            "<ECCENTRICITY>0.832853</ECCENTRICITY>\n",
            "",
            (28, "opm-elements"),
        ),
        (
            "version=\"2.0\">\n<h",
            "version=\"5.0\">\n<h",
            (2, "ccsds-version"),
        ),
        ("</opm>\n", "", (51, "xml-truncated")),
    ] {
        assert!(VALLADO_XML.contains(from), "{from}");
        let text = VALLADO_XML.replacen(from, to, 1);
        let found = findings(&text);
        let told = found.iter().any(|f| (f.line, f.rule) == (line, rule));
        assert!(told, "{to}: {found:#?}");
        assert!(read_xml(text.as_bytes()).is_err(), "{to}");
    }
}

#[test]
fn circular_and_equatorial_states_have_angles() {
    let speed = (MU_KM3_S2 / 7000.0_f64).sqrt();
    let state = State::<Frame>::new(
        Vector3::new(0.0, 7000.0, 0.0),
        Vector3::new(-speed, 0.0, 0.0),
    );
    let elements = Keplerian::of_state(&state, MU_KM3_S2).unwrap();
    assert_eq!((elements.raan_deg, elements.arg_perigee_deg), (0.0, 0.0));
    assert!((elements.true_anomaly_deg - 90.0).abs() < 1e-12);
    let open = State {
        velocity_km_s: 2.0 * state.velocity_km_s,
        ..state
    };
    assert_eq!(Keplerian::of_state(&open, MU_KM3_S2), None);
}

#[test]
fn broken_rules_are_named_with_their_place() {
    for (from, to, (line, column, rule)) in [
        ("X = 6524.834 [km]\n", "", (30, 1, "ccsds-missing")),
        ("Y = 6862.875", "Y = 6862.875 km", (12, 5, "ccsds-number")),
        ("GM = 398600.4418\n", "", (17, 19, "opm-elements")),
        ("TRUE_ANOMALY = 92.335\n", "", (17, 19, "opm-elements")),
        ("MAN_DV_2 = 0.001\n", "", (30, 1, "ccsds-missing")),
        ("MAN_DV_2 =", "MAN_DV_3 =", (30, 1, "ccsds-repeated")),
        ("= 2.0", "= 5.0", (1, 18, "ccsds-version")),
        // Metres, which CCSDS does not have.
        (
            "X = 6524.834 [km]",
            "X = 6524834.0",
            (11, 5, "implausible-state"),
        ),
        (
            "EPOCH = 2025-01-01T00",
            "EPOCH = 2025-01-01 00",
            (10, 9, "ccsds-time"),
        ),
        ("OBJECT_NAME = A", "hello", (5, 1, "opm-line")),
    ] {
        let text = VALLADO.replacen(from, to, 1);
        let found = findings(&text);
        assert!(
            found
                .iter()
                .any(|f| (f.line, f.column, f.rule) == (line, column, rule)),
            "{to}: {found:#?}"
        );
        assert!(read(text.as_bytes()).is_err(), "{to}");
    }
    for text in ["", "hello", "CCSDS_OPM_VERS = 2.0\n", "\0"] {
        assert!(read(text.as_bytes()).is_err(), "{text:?}");
    }
}

proptest! {
    #[test]
    fn damaged_xml_never_panics(at in 0..VALLADO_XML.len(), byte in any::<u8>(), cut in 0_usize..40) {
        let mut bytes = VALLADO_XML.as_bytes().to_vec();
        bytes[at] = byte;
        bytes.drain(at..(at + cut).min(VALLADO_XML.len()));
        let _ = findings(&bytes);
    }

    #[test]
    fn damaged_files_never_panic(at in 0..VALLADO.len(), byte in any::<u8>(), cut in 0_usize..40) {
        let mut bytes = VALLADO.as_bytes().to_vec();
        bytes[at] = byte;
        bytes.drain(at..(at + cut).min(VALLADO.len()));
        let _ = findings(&bytes);
    }
}
