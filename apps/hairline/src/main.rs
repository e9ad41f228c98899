//! `hairline`: pictures of iridescent scratches from the command line.
//!
//! Exit codes: 0 done; 1 the work failed; 2 the command line or the scene is wrong.

mod backend;
mod cli;
mod failure;
mod info;
mod progress;
mod render;

use std::process::ExitCode;

use clap::{CommandFactory, Parser};

fn main() -> ExitCode {
    let cli = cli::Cli::parse();
    let result = match &cli.command {
        Some(cli::Command::Render(arguments)) => render::run(arguments),
        Some(cli::Command::Info) => info::run(),
        None => cli::Cli::command()
            .print_help()
            .map_err(|e| failure::Failure::Work(e.into())),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            failure.exit_code()
        }
    }
}
