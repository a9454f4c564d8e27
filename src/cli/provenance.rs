//! The command that this thread runs, as it goes into the provenance of what it writes.

use crate::run::{ResultProvenance, ScenarioStamp};
use std::cell::RefCell;
use std::ffi::OsString;
use std::path::Path;

/// Options that change where results go, how they are printed or how the work is shared, and no result file.
const LEFT_OUT: [&str; 7] = [
    "--allow-large",
    "--force",
    "--merge",
    "--no-color",
    "--quiet",
    "-q",
    "--resume",
];
/// The same of options with a value.
const WITH_VALUE: [&str; 5] = ["--format", "--out", "--series", "--threads", "--shard"];

thread_local! {
    static COMMAND: RefCell<Option<Vec<String>>> = const { RefCell::new(None) };
}

/// Makes these arguments, which begin with the program name, the command of this thread.
pub(super) fn set_command(args: &[OsString]) {
    COMMAND.set(Some(recorded(args)));
}

/// The provenance of results of these scenarios, made by the command of this thread.
pub(crate) fn provenance(scenarios: Vec<ScenarioStamp>) -> ResultProvenance {
    ResultProvenance::new(COMMAND.with_borrow(Clone::clone), scenarios)
}

/// The words of a command that its results depend on. Of paths only the last name is kept: results hold
/// copies of their inputs, and directories would tell about the user's machine.
fn recorded(args: &[OsString]) -> Vec<String> {
    let mut words = vec![env!("CARGO_PKG_NAME").to_owned()];
    let args = args.iter().skip(1).map(|arg| arg.to_string_lossy());
    let mut args = args.peekable();
    while let Some(arg) = args.next() {
        let option = arg.split('=').next().unwrap_or_default();
        if WITH_VALUE.contains(&option) {
            if !arg.contains('=') {
                args.next();
            }
        } else if option == "--merge" && words.get(1).is_some_and(|command| command == "evaluate") {
            // The files of all tiles, which are the same together however many there are.
            while args.next_if(|file| !file.starts_with('-')).is_some() {}
        } else if !LEFT_OUT.contains(&option) {
            words.push(without_directories(&arg));
        }
    }
    words
}

/// A path, perhaps after `NAME=`, without the directories before its last name; anything else as it is.
fn without_directories(word: &str) -> String {
    let (name, path) = match word.split_once('=') {
        Some((name, path)) if !Path::new(word).exists() => (Some(name), path),
        _ => (None, word),
    };
    let last = Path::new(path)
        .file_name()
        .filter(|_| Path::new(path).exists());
    match (name, last) {
        (_, None) => word.to_owned(),
        (None, Some(last)) => last.to_string_lossy().into_owned(),
        (Some(name), Some(last)) => format!("{name}={}", last.to_string_lossy()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(args: &[&str]) -> String {
        let args: Vec<OsString> = args.iter().map(OsString::from).collect();
        recorded(&args).join(" ")
    }

    #[test]
    fn what_changes_no_result_is_left_out() {
        let args = "/usr/bin/navwalker --threads 2 optimize regional --out=a --seed 3 --force --out b --resume -q --format json";
        let args: Vec<&str> = args.split(' ').collect();
        assert_eq!(words(&args), "navwalker optimize regional --seed 3");
        let args = [
            "navwalker",
            "sweep",
            "--shard",
            "1/4",
            "--chunk",
            "5",
            "--merge",
        ];
        assert_eq!(words(&args), "navwalker sweep --chunk 5");
        let args = [
            "navwalker",
            "evaluate",
            "paper",
            "--merge",
            "one",
            "two",
            "--design",
            "x",
        ];
        assert_eq!(words(&args), "navwalker evaluate paper --design x");
    }

    #[test]
    fn directories_of_files_are_left_out_and_notations_are_not_paths() {
        let directory = tempfile::TempDir::new().unwrap();
        let file = directory.path().join("real.tle");
        std::fs::write(&file, "").unwrap();
        let named = format!("real={}", file.display());
        let given = format!("--run={}", file.display());
        let args = [
            "n",
            "evaluate",
            "--constellation",
            &named,
            &given,
            "--design",
            "a=delta:55:24/6/1@925",
        ];
        assert_eq!(
            words(&args),
            "navwalker evaluate --constellation real=real.tle --run=real.tle --design a=delta:55:24/6/1@925"
        );
    }
}
