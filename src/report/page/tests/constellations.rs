//! Many constellations, and constellations without GNSS.

use super::*;

/// Positions take no more of the page for many constellations than for one.
#[test]
fn many_constellations_of_files_share_the_bytes_of_their_positions() {
    let (scenario, evaluator) = evaluator();
    let shown: Vec<Compared> = (0..60)
        .map(|n| compared(of_many(&format!("{n}.csv")), &scenario, &evaluator))
        .collect();
    let run = run(Some(scenario), 0);
    let html = written(&page_of(&run, &evaluator, &shown));
    let data = data(&html);
    let tracks = |n: usize| data["baselines"][n]["cuts"]["tracks"].clone();
    let bytes: usize = (0..shown.len()).map(|n| tracks(n).to_string().len()).sum();
    // Names and notes of each are counted too.
    assert!(bytes < TRACKS_BYTES + 500 * shown.len(), "{bytes} bytes");
    let note = tracks(59)["note"].to_string();
    assert!(note.contains("of the 400 are drawn"), "{note}");
    assert!(html.len() < 8_000_000, "{} bytes", html.len());
}

/// Four hundred satellites in a file of this name.
fn of_many(name: &str) -> Constellation {
    let mut table = "object,epoch_utc,semi_major_axis_km,eccentricity,inclination_deg,raan_deg,arg_perigee_deg,mean_anomaly_deg\n".to_owned();
    for n in 0..400 {
        table += &format!("A{n},2025-01-01T00:00:00Z,7300,0,50,{},0,{n}\n", n / 2);
    }
    let imported = Fleet::read(table.as_bytes(), None, Some(name)).unwrap();
    Constellation::of_files(FileSatellites::of_file(name.to_owned(), imported))
}

/// Without GNSS nothing is left when the constellations are taken away, and the table does not say so.
#[test]
fn a_page_without_gnss_has_no_row_of_the_gnss_alone() {
    for (gnss, has_row) in [("[]", false), ("['beidou-3']", true)] {
        let changed = [
            "region.step-deg=20".to_owned(),
            "time.step-s=7200".to_owned(),
            format!("gnss.constellations={gnss}"),
        ];
        let scenario = Scenario::parse("paper", SCENARIO.as_bytes(), &changed).unwrap();
        let setup = scenario.setup(&|_| Err(std::io::ErrorKind::NotFound.into()));
        let evaluator = Evaluator::new(setup.unwrap()).unwrap();
        let shown = [
            design("few", "delta:55:36/6/1@925"),
            design("many", "delta:55:182/13/1@925"),
        ];
        let shown = shown.map(|one| compared(one, &scenario, &evaluator));
        let run = run(Some(scenario), 0);
        let html = written(&page_of(&run, &evaluator, &shown));
        assert!(html.contains("<bdi>many</bdi>"));
        assert_eq!(html.contains("<td>GNSS alone</td>"), has_row, "{gnss}");
    }
}
