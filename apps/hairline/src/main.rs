//! `hairline`: pictures of iridescent scratches from the command line.
//!
//! Exit codes: 0 done; 1 the work failed; 2 the command line or the scene is wrong.

mod bench;
mod cli;
mod compare;
mod export;
mod highlight;
mod info;
mod interrupt;
mod manual;
mod method_flags;
mod progress;
mod reference;
mod render;
mod scene_file;
mod scratches;
mod size_limit;
mod view;
mod watch;

use std::env;
use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    hairline_console::tell_of_panics();
    hairline_console::quiet_the_search_for_wayland();
    let cli = cli::Cli::parse();
    let result = match &cli.command {
        Some(cli::Command::Render(arguments)) if arguments.watch => watch::run(arguments),
        Some(cli::Command::Render(arguments)) => render::run(arguments),
        Some(cli::Command::Compare(arguments)) => compare::run(arguments),
        Some(cli::Command::Reference(arguments)) => reference::run(arguments),
        Some(cli::Command::Bench(arguments)) => bench::run(arguments),
        Some(cli::Command::Info(arguments)) => info::run(arguments),
        Some(cli::Command::Scratches(arguments)) => scratches::run(arguments),
        Some(cli::Command::Export(arguments)) => export::run(arguments),
        Some(cli::Command::Completions(arguments)) => manual::completions(arguments.shell),
        Some(cli::Command::Man(arguments)) => manual::page(arguments.command.as_deref()),
        Some(cli::Command::View(_)) => view::run(env::args_os().skip(2)),
        None => view::run(env::args_os().skip(1)),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            hairline_console::tell(format_args!("error: {failure}"));
            failure.exit_code()
        }
    }
}
