//! `hairline`: the viewer, and pictures of iridescent scratches from the command line.
//!
//! Exit codes: 0 done; 1 the work failed; 2 the command line or the scene is wrong.

mod bench;
mod cli;
mod compare;
mod console;
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
mod switch;
mod view;
mod watch;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    console::tell_of_panics();
    quiet_the_search_for_wayland();
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
        Some(cli::Command::Man) => manual::page(),
        Some(cli::Command::View(arguments)) => view::run(arguments),
        None => view::run(&cli::View::default()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            console::tell(format_args!("error: {failure}"));
            failure.exit_code()
        }
    }
}

/// Mesa's Vulkan drivers look for a Wayland display, and complain on stderr on machines that have none. With a folder
/// to look in, they find nothing there and are quiet.
fn quiet_the_search_for_wayland() {
    if cfg!(target_os = "linux") && std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        #[expect(unsafe_code, reason = "sound at the start, while there is one thread")]
        unsafe {
            std::env::set_var("XDG_RUNTIME_DIR", "/nonexistent");
        }
    }
}
