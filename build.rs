//! Tells the program where it comes from: the platform it is built for and, in optimised builds from a checkout, its commit.

use std::env;
use std::path::Path;
use std::process::Command;

fn main() {
    let target = env::var("TARGET").unwrap_or_default();
    println!("cargo::rustc-env=NAVWALKER_TARGET={target}");
    println!("cargo::rerun-if-changed=build.rs");
    // A debug build would otherwise be made again at each commit.
    if env::var("PROFILE").is_ok_and(|profile| profile == "release")
        && let Some(commit) = commit()
    {
        println!("cargo::rustc-env=NAVWALKER_COMMIT={commit}");
    }
}

/// The commit of the checkout, with `+` where its files were changed since; `None` outside a checkout of this project.
fn commit() -> Option<String> {
    let here = env::var("CARGO_MANIFEST_DIR").ok()?;
    // Of a package that was unpacked inside another project's repository, the commit would be that of the other project.
    let top = git(&["rev-parse", "--show-toplevel"])?;
    if Path::new(&top).canonicalize().ok()? != Path::new(&here).canonicalize().ok()? {
        return None;
    }
    let moves = [
        git(&["rev-parse", "--git-path", "logs/HEAD"])?,
        git(&["rev-parse", "--git-path", "HEAD"])?,
    ];
    let sources = ["src", "data", "Cargo.toml", "Cargo.lock"].map(str::to_owned);
    // A watched file that is missing would have everything built again each time.
    for watched in moves
        .into_iter()
        .chain(sources)
        .filter(|path| Path::new(path).exists())
    {
        println!("cargo::rerun-if-changed={watched}");
    }
    let commit = git(&["rev-parse", "HEAD"])?;
    let changed = git(&["status", "--porcelain", "--untracked-files=no"])?;
    Some(if changed.is_empty() {
        commit
    } else {
        commit + "+"
    })
}

fn git(args: &[&str]) -> Option<String> {
    let output = Command::new("git").args(args).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
