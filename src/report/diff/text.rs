//! A diff for people.

use super::{Diff, Moved};
use crate::report::shown::significant;
use crate::report::{Align, Table};
use crate::run::ResultProvenance;
use crate::units::counted;
use std::fmt::Write;

/// Characters of a value that are shown.
const MOST_SHOWN: usize = 40;

/// Words of a command line that are shown even if both have them.
const KEPT_WORDS: usize = 2;

impl Diff {
    /// What differs in where the sides come from, what moved by quantity, and the count of all.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        if let [Some(a), Some(b)] = &self.provenance
            && a != b
        {
            text += &origins(a, b).to_text();
            text.push('\n');
        }
        if !self.moved.is_empty() {
            text += &self.quantities().to_text();
            text.push('\n');
        }
        let lists = [
            ("only in A", &self.only_in_a),
            ("only in B", &self.only_in_b),
            ("different bytes", &self.differing_files),
            ("drawn differently", &self.differing_drawings),
        ];
        for (what, files) in lists.into_iter().filter(|(_, files)| !files.is_empty()) {
            let _ = writeln!(text, "{what}: {}", files.join(", "));
        }
        text + &self.total() + "\n"
    }

    fn total(&self) -> String {
        let values = self.compared.values().sum();
        if values == 0 {
            return "no values to compare; files of other kinds are compared by their bytes"
                .to_owned();
        }
        let compared = format!(
            "{} in {}",
            counted(values, "value"),
            counted(self.compared.len(), "file")
        );
        let tolerance = match (self.tolerance.absolute, self.tolerance.relative) {
            (0.0, 0.0) => String::new(),
            (absolute, 0.0) => format!(" by more than {absolute}"),
            (0.0, relative) => format!(" by more than {relative} of its value"),
            (absolute, relative) => format!(" by more than {absolute} and {relative} of its value"),
        };
        match self.moved.len() {
            0 => format!("{compared} compared, none moved{tolerance}"),
            moved => format!("{compared} compared, {moved} moved{tolerance}"),
        }
    }

    /// A row for each quantity of a file: how many of its values moved, and the one that moved most.
    fn quantities(&self) -> Table {
        let mut table = Table::new(&[
            ("file", Align::Left),
            ("quantity", Align::Left),
            ("moved", Align::Right),
            ("most: A", Align::Right),
            ("B", Align::Right),
            ("B - A", Align::Right),
            ("share", Align::Right),
            ("of", Align::Left),
        ]);
        for group in self.groups() {
            let most = group.iter().copied().reduce(further).unwrap_or(group[0]);
            let value = |value: &Option<String>| value.as_deref().map_or("-".to_owned(), shortened);
            let share = |relative: f64| format!("{} %", significant(100.0 * relative));
            table.row([
                most.file.clone(),
                most.quantity.clone(),
                group.len().to_string(),
                value(&most.a),
                value(&most.b),
                most.difference.map_or(String::new(), signed),
                most.relative.map_or(String::new(), share),
                most.of.clone(),
            ]);
        }
        table
    }

    /// The moved values of each quantity of each file, in their first order.
    fn groups(&self) -> Vec<Vec<&Moved>> {
        let mut groups: Vec<Vec<&Moved>> = Vec::new();
        for moved in &self.moved {
            let same = |group: &&mut Vec<&Moved>| {
                group[0].file == moved.file && group[0].quantity == moved.quantity
            };
            match groups.iter_mut().find(same) {
                Some(group) => group.push(moved),
                None => groups.push(vec![moved]),
            }
        }
        groups
    }
}

/// The one of two values that moved further; one that is a number on one side only goes first.
fn further<'m>(one: &'m Moved, other: &'m Moved) -> &'m Moved {
    let size = |moved: &Moved| moved.difference.map_or(f64::INFINITY, f64::abs);
    if size(other) > size(one) { other } else { one }
}

fn signed(difference: f64) -> String {
    match difference {
        by if by.abs() < 1e-4 => format!("{by:+.1e}"),
        by if by > 0.0 => format!("+{}", significant(by)),
        by => significant(by),
    }
}

fn shortened(value: &str) -> String {
    let short = value.parse::<f64>().ok().filter(|_| value.len() > 12);
    if let Some(number) = short {
        return significant(number);
    }
    match value.char_indices().nth(MOST_SHOWN) {
        Some((end, _)) => format!("{}…", &value[..end]),
        None => value.to_owned(),
    }
}

/// What the two provenances do not share.
fn origins(a: &ResultProvenance, b: &ResultProvenance) -> Table {
    let mut table = Table::new(&[("", Align::Left), ("A", Align::Left), ("B", Align::Left)]);
    for ((name, a), (_, b)) in facts(a).into_iter().zip(facts(b)) {
        if a != b {
            table.row([name.to_owned(), a, b]);
        }
    }
    if a.command != b.command {
        let [one, other] = [a, b].map(|of| of.command.as_deref().unwrap_or_default());
        let [one, other] = apart(one, other);
        table.row(["command".to_owned(), one, other]);
    }
    table
}

/// What two command lines do not share; the words that they begin with, the program and its command, are kept.
fn apart(one: &[String], other: &[String]) -> [String; 2] {
    let shortest = one.len().min(other.len());
    let shared = |pairs: &mut dyn Iterator<Item = (&String, &String)>| {
        pairs.take_while(|(one, other)| one == other).count()
    };
    let first = shared(&mut one.iter().zip(other));
    let last = shared(&mut one.iter().rev().zip(other.iter().rev())).min(shortest - first);
    [one, other].map(|words| {
        let kept = first.min(KEPT_WORDS);
        let mut shown: Vec<_> = words[..kept].iter().map(String::as_str).collect();
        if first > kept {
            shown.push("…");
        }
        shown.extend(words[first..words.len() - last].iter().map(String::as_str));
        if last > 0 {
            shown.push("…");
        }
        shown.join(" ")
    })
}

fn facts(of: &ResultProvenance) -> [(&'static str, String); 5] {
    let scenarios = of.scenarios.iter().map(|one| {
        let hash = one.hash.get(..8).unwrap_or(&one.hash);
        format!("{} ({hash})", one.name)
    });
    let none = || "-".to_owned();
    [
        ("version", of.version.clone()),
        ("commit", of.commit.clone().unwrap_or_else(none)),
        ("platform", of.platform.clone()),
        ("instruction set", of.instruction_set.clone()),
        ("scenario", scenarios.collect::<Vec<_>>().join(", ")),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn command_lines_are_told_apart() {
        let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
        for (one, other, shown) in [
            (
                "navwalker optimize paper --seed 1 --set a=1",
                "navwalker optimize paper --seed 2 --set a=1",
                ["navwalker optimize … 1 …", "navwalker optimize … 2 …"],
            ),
            (
                "navwalker sweep",
                "navwalker sweep --as csv",
                ["navwalker sweep", "navwalker sweep --as csv"],
            ),
            (
                "navwalker optimize --seed 1",
                "navwalker sweep --seed 1",
                ["navwalker optimize …", "navwalker sweep …"],
            ),
            (
                "navwalker plot a a",
                "navwalker plot a",
                ["navwalker plot … a", "navwalker plot …"],
            ),
        ] {
            assert_eq!(apart(&words(one), &words(other)), shown.map(str::to_owned));
        }
    }
}
