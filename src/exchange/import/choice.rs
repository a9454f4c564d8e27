//! Which states are kept while a file is read: those of the satellites that are selected, around the interval of the study.

use super::objects::{SatelliteFilter, identity_of};
use super::stem;
use crate::formats::ccsds::oem::SegmentMetadata;
use crate::formats::kept_states::KeptStates;
use crate::printable::printable;
use crate::time::{Epoch, TimeGrid};

/// The states that are kept of a file. Of the other satellites it is kept which they are and when they have states, so that
/// names and selections are those of the whole file.
#[derive(Debug, Clone, Default)]
pub struct StateChoice {
    filter: SatelliteFilter,
    interval: Option<(Epoch, Epoch)>,
}

impl StateChoice {
    /// The states of the satellites that `filter` selects, for a study on `grid`.
    #[must_use]
    pub fn new(filter: SatelliteFilter, grid: TimeGrid) -> Self {
        let last = grid.epoch().plus_seconds(grid.elapsed_s(grid.len()));
        Self {
            filter,
            interval: Some((grid.epoch(), last)),
        }
    }

    /// The same for all satellites.
    #[must_use]
    pub fn of_all(&self) -> Self {
        Self {
            filter: SatelliteFilter::default(),
            ..self.clone()
        }
    }

    /// The states of a satellite by name and identifier in a file, which names those that have neither.
    pub(super) fn kept(
        &self,
        (name, id): (&str, &str),
        file_name: Option<&str>,
    ) -> KeptStates<Epoch> {
        let (name, id) = (printable(name), printable(id));
        let own = identity_of(&name, &id);
        let is_selected = match (own.label(), file_name) {
            (None, Some(file_name)) => {
                let stem = printable(stem(file_name));
                self.filter.may_select(&identity_of(&stem, &stem))
            }
            _ => self.filter.may_select(&own),
        };
        match (is_selected, self.interval) {
            (false, _) => KeptStates::None,
            (true, None) => KeptStates::All,
            (true, Some((first, last))) => KeptStates::Around(first, last),
        }
    }

    /// The same of a segment of an ephemeris message.
    pub(super) fn of_segment(
        &self,
        metadata: &SegmentMetadata,
        file_name: Option<&str>,
    ) -> KeptStates<Epoch> {
        self.kept((&metadata.object_name, &metadata.object_id), file_name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exchange::export::testing::{in_memory, subject};
    use crate::exchange::export::{Choices, Product};
    use crate::exchange::import::{Fleet, SamplingNote};
    use crate::formats::ccsds::oem::OemSyntax;
    use crate::orbit::Model;

    /// A CZML document of satellites, with every sample: half of the samples in a packet of their own, which comes first.
    fn in_czml(fleet: &Fleet) -> String {
        let Fleet::Sampled(trajectories) = fleet else {
            panic!("states are read");
        };
        let origin = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let mut text = r#"[{"id":"document","version":"1.0"}"#.to_owned();
        for trajectory in trajectories {
            let nodes = &trajectory.arcs[0].nodes;
            for half in [&nodes[nodes.len() / 2..], &nodes[..nodes.len() / 2]] {
                let samples: Vec<String> = half
                    .iter()
                    .map(|(at, state)| {
                        let [x, y, z] = (state.position_km.km() * 1000.0).into();
                        format!("{},{x},{y},{z}", at.seconds_since(origin))
                    })
                    .collect();
                text += &format!(
                    ",\n{{\"id\":\"{}\",\"position\":{{\"epoch\":\"2025-01-01T00:00:00Z\",\"referenceFrame\":\"FIXED\",\
                     \"interpolationAlgorithm\":\"LAGRANGE\",\"interpolationDegree\":7,\"cartesian\":[{}]}}}}",
                    trajectory.name,
                    samples.join(",")
                );
            }
        }
        text + "]"
    }

    /// An STK file without its velocities, with a boundary in the middle of its day.
    fn without_velocities(text: &str) -> String {
        let boundary =
            "BEGIN SegmentBoundaryTimes\n14700\nEND SegmentBoundaryTimes\nEphemerisTimePos\n";
        let lines = text.lines().map(|line| match line {
            "EphemerisTimePosVel" => boundary.to_owned(),
            _ if line.starts_with(|first: char| first.is_ascii_digit()) => {
                let words: Vec<&str> = line.split(' ').take(4).collect();
                words.join(" ") + "\n"
            }
            _ => format!("{line}\n"),
        });
        lines.collect()
    }

    /// Six satellites for eight hours as OEM in both notations, SP3, STK with and without velocities, and CZML.
    fn exported() -> Vec<(String, Vec<u8>)> {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 28_800.0, 60.0).unwrap();
        let subject = subject("delta:55:6/3/1@925".parse().unwrap(), grid);
        let of = |choices, product| in_memory(&subject, &[product], choices).1.into_iter();
        let xml = Choices {
            oem: OemSyntax::Xml,
            ..Choices::default()
        };
        let files = of(Choices::default(), Product::Oem)
            .chain(of(xml, Product::Oem))
            .chain(of(Choices::default(), Product::Sp3))
            .chain(of(Choices::default(), Product::Stk));
        let mut files: Vec<_> = files.filter(|(path, _)| path != "manifest.json").collect();
        let in_sp3 = files
            .iter()
            .find(|(path, _)| path.ends_with(".sp3"))
            .unwrap();
        let czml = in_czml(&read(in_sp3, &StateChoice::default()));
        let in_stk = files.iter().find(|(path, _)| path.ends_with(".e")).unwrap();
        let positions = without_velocities(str::from_utf8(&in_stk.1).unwrap());
        files.push(("positions.e".to_owned(), positions.into_bytes()));
        files.push(("constellation.czml".to_owned(), czml.into_bytes()));
        files
    }

    fn study(start_s: f64) -> TimeGrid {
        let epoch: Epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        TimeGrid::new(epoch.plus_seconds(start_s), 1_200.0, 25.0).unwrap()
    }

    fn read((path, bytes): &(String, Vec<u8>), choice: &StateChoice) -> Fleet {
        let name = path.rsplit('/').next();
        let read = Fleet::read_chosen(bytes.as_slice(), None, name, choice);
        read.unwrap().fleet
    }

    fn states(fleet: &Fleet) -> usize {
        let Fleet::Sampled(trajectories) = fleet else {
            panic!("states are read");
        };
        let arcs = trajectories.iter().flat_map(|one| &one.arcs);
        arcs.map(|arc| arc.nodes.len()).sum()
    }

    fn filter(only: &[&str]) -> SatelliteFilter {
        SatelliteFilter {
            only: only.iter().map(|&text| text.to_owned()).collect(),
            exclude: Vec::new(),
        }
    }

    /// At the beginning, in the middle and at the end of the file, between its samples too.
    #[test]
    fn states_around_a_study_propagate_as_all_states_do() {
        for file in exported() {
            let whole = read(&file, &StateChoice::default());
            for start_s in [0.0, 14_400.0, 27_000.0] {
                let grid = study(start_s);
                let part = read(&file, &StateChoice::new(SatelliteFilter::default(), grid));
                // 20 minutes, at most 96 states before and 48 after, one of them perhaps in two arcs.
                let each = states(&part) / part.len();
                assert!(each <= 21 + 96 + 48 + 1, "{}: {each}", file.0);
                assert!(states(&whole) > 2 * states(&part));
                let [part, whole] = [&part, &whole]
                    .map(|fleet| fleet.propagate_continuously(grid, Model::J2).unwrap());
                for (a, b) in part.satellites().iter().zip(whole.satellites()) {
                    assert_eq!(a.name, b.name);
                    for elapsed_s in grid.iter().chain([333.3, 1_199.0]) {
                        let state = |of: &crate::ephemeris::Ephemeris, one| {
                            of.state_or_gap(one, elapsed_s).unwrap()
                        };
                        assert_eq!(
                            state(&part, a),
                            state(&whole, b),
                            "{} at {elapsed_s}",
                            file.0
                        );
                    }
                }
            }
        }
    }

    /// The names, and the errors of a selection, are those of the whole file; the states are not kept.
    #[test]
    fn states_of_other_satellites_are_not_kept() {
        let grid = study(0.0);
        for file in exported() {
            for only in [&["*P02*"][..], &["nw-p01-s02", "*-P03-*"], &["NW-P01-S09"]] {
                let filter = filter(only);
                let all = StateChoice::new(SatelliteFilter::default(), grid);
                let (mut all, mut part) = (
                    read(&file, &all),
                    read(&file, &StateChoice::new(filter.clone(), grid)),
                );
                assert_eq!(part.labels(), all.labels());
                assert!(states(&part) < states(&all) || all.len() == 1);
                assert!(!part.lacks_states(&filter));
                assert_eq!(part.choose(&filter), all.choose(&filter), "{}", file.0);
                if all.choose(&filter).is_ok() {
                    assert_eq!(part, all);
                }
            }
        }
    }

    /// Two messages of one name get numbers as labels, by which one of them is selected.
    #[test]
    fn a_selection_by_a_label_is_told_to_need_all_states() {
        let files = exported();
        let twice = |choice: &StateChoice| {
            let mut twice = read(&files[0], choice);
            twice.append(read(&files[0], choice));
            twice
        };
        let labels = twice(&StateChoice::default()).labels();
        assert!(labels[1].ends_with(" #2"), "{labels:?}");
        let label = filter(&[&labels[1]]);
        let choice = StateChoice::new(label.clone(), study(0.0));
        assert!(twice(&choice).lacks_states(&label));
        assert!(!twice(&choice.of_all()).lacks_states(&label));
    }

    /// What is told of a file does not depend on what is kept of it.
    #[test]
    fn a_study_beyond_the_states_is_told_the_same() {
        for file in exported() {
            for (start_s, told) in [
                (-600.0, "begin at 2025-01-01T00:00:00"),
                (28_000.0, "end at 2025-01-01T07:59:00"),
            ] {
                let grid = study(start_s);
                let error = |choice: &StateChoice| {
                    let fleet = read(&file, choice);
                    let notes = fleet.sampling_notes(grid);
                    let gaps = notes
                        .iter()
                        .filter(|note| matches!(note, SamplingNote::Gaps { .. }));
                    let gaps: Vec<String> = gaps.map(SamplingNote::to_string).collect();
                    let error = fleet.propagate(grid, Model::J2).err().unwrap();
                    (error.to_string(), gaps)
                };
                let part = error(&StateChoice::new(SatelliteFilter::default(), grid));
                assert!(part.0.contains(told), "{}", part.0);
                assert_eq!(part, error(&StateChoice::default()));
            }
        }
    }
}
