//! The `navwalker` program.

fn main() -> std::process::ExitCode {
    navwalker::cli::main(std::env::args_os())
}
