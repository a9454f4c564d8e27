//! The names of satellites: after their file or their place where the file has none, and as they can be shown.

use super::Fleet;
use super::objects::identity;
use crate::printable::printable;
use std::borrow::Cow;

impl Fleet {
    /// Names sampled satellites by their position, from 1: for files that each restart their ids, such as
    /// the parts of a large constellation in SP3.
    pub fn name_by_place(&mut self) {
        if let Self::Sampled(trajectories) = self {
            for (place, trajectory) in (1..).zip(trajectories) {
                trajectory.name = format!("{place}");
                trajectory.id.clone_from(&trajectory.name);
            }
        }
    }

    /// Names satellites that have no identifier in their file after the file.
    pub(super) fn name_after_file(&mut self, file_name: Option<&str>) {
        let Some(file_name) = file_name else { return };
        match self {
            Self::Sampled(trajectories) => {
                for trajectory in trajectories {
                    if identity(trajectory).label().is_none() {
                        trajectory.name = stem(file_name).to_owned();
                        trajectory.id.clone_from(&trajectory.name);
                    }
                }
            }
            Self::Mixed(parts) => parts
                .iter_mut()
                .for_each(|part| part.name_after_file(Some(file_name))),
            Self::Sets(_) | Self::Elements(_) | Self::Almanacs(_) => {}
        }
    }

    /// Writes names and identifiers as they can be shown.
    pub(super) fn make_names_printable(&mut self) {
        let make = |text: &mut String| {
            if let Cow::Owned(safe) = printable(text) {
                *text = safe;
            }
        };
        match self {
            Self::Sets(sets) => {
                for set in sets {
                    let texts = [&mut set.object_name, &mut set.international_designator];
                    texts.into_iter().flatten().for_each(make);
                }
            }
            Self::Elements(rows) => rows.iter_mut().for_each(|row| make(&mut row.name)),
            Self::Sampled(trajectories) => {
                for trajectory in trajectories {
                    make(&mut trajectory.name);
                    make(&mut trajectory.id);
                }
            }
            // Their names are made from numbers.
            Self::Almanacs(_) => {}
            Self::Mixed(parts) => parts.iter_mut().for_each(Self::make_names_printable),
        }
    }
}

/// The name of a file without its directory and its last extension.
pub(super) fn stem(file_name: &str) -> &str {
    let file_name = file_name.rsplit(['/', '\\']).next().unwrap_or(file_name);
    file_name
        .rsplit_once('.')
        .map_or(file_name, |(stem, _)| stem)
}
