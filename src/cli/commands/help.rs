//! `navwalker completions` and `navwalker man`.

use crate::cli::args::Cli;
use crate::cli::{Status, files, output};
use anyhow::{Context, Result, bail};
use clap::CommandFactory;
use clap_complete::Shell;
use clap_mangen::Man;
use std::fs;
use std::path::Path;

const NAME: &str = "navwalker";

pub(crate) fn completions(shell: Shell) -> Result<Status> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), NAME, &mut script);
    output::result(&String::from_utf8(script)?)?;
    Ok(Status::Done)
}

pub(crate) fn man(command: Option<&str>, out: Option<&Path>) -> Result<Status> {
    match out {
        Some(directory) => {
            let names = write_all(directory)?;
            output::result(&names.join("\n"))?;
        }
        None => output::result(&page(command)?)?,
    }
    Ok(Status::Done)
}

/// The program, with the full names of its commands.
fn built() -> clap::Command {
    let mut program = Cli::command().disable_help_subcommand(true);
    program.build();
    program
}

fn page(command: Option<&str>) -> Result<String> {
    let program = built();
    let named = match command {
        None => &program,
        Some(name) => match program.find_subcommand(name) {
            Some(found) => found,
            None => bail!("unknown command '{name}'; navwalker --help lists the commands"),
        },
    };
    render(named)
}

fn render(command: &clap::Command) -> Result<String> {
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page)?;
    Ok(String::from_utf8(page)?)
}

fn write_all(directory: &Path) -> Result<Vec<String>> {
    fs::create_dir_all(directory)
        .with_context(|| format!("cannot create {}", directory.display()))?;
    let program = built();
    let mut names = Vec::new();
    for command in std::iter::once(&program).chain(program.get_subcommands()) {
        let name = format!("{}.1", command.get_display_name().unwrap_or(NAME));
        files::write_atomically(&directory.join(&name), render(command)?.as_bytes())?;
        names.push(name);
    }
    Ok(names)
}
