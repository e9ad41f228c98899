//! Tasks that cargo does not do itself. `cargo xtask COMMAND`; each command is one file.

mod accuracy;
mod dist;
mod fit_lobes;
mod fuzz;
mod gratings;
mod make_models;
mod models;
mod package;
mod paths;
mod pictures;
mod rooms;
mod shaders;
mod touches;
mod unbiased;
mod wear;
mod web;
mod wheel;

use clap::Parser;

#[derive(Parser)]
#[command(name = "cargo xtask", about)]
enum Command {
    /// Measure closed form, separable model and full one against each other, and write docs/accuracy.md.
    Accuracy(accuracy::Accuracy),
    /// Make an archive of the program with scenes, docs and licences, for Linux.
    Dist(dist::Dist),
    /// Fit the tables of the area-light lobes and write them to crates/optics/data.
    FitLobes(fit_lobes::FitLobes),
    /// Run mutated inputs through the command line: no panic, no hang, no flood of memory.
    Fuzz(fuzz::Fuzz),
    /// Measure gratings against the full wave, and write docs/accuracy/gratings.md.
    Gratings(gratings::Gratings),
    /// Make the models and the sky of scenes/, and write them to scenes/models and scenes/maps.
    MakeModels(make_models::MakeModels),
    /// Open and render glTF files of public repositories, and write docs/accuracy/models.md.
    Models(models::Models),
    /// Make the package of shaders, tables and JavaScript for other engines.
    Package(package::Package),
    /// Find paths in documents and shaders that name no file.
    Paths,
    /// Render the pictures of the docs into docs/pictures.
    Pictures(pictures::Pictures),
    /// Find modules that import each other in a circle; there must be none.
    Rooms(rooms::Rooms),
    /// Write the shaders as JSON, for tests/tint.
    Shaders(shaders::Shaders),
    /// Count the files that a new groove parameter and a new light shape would touch.
    Touches(touches::Touches),
    /// Measure shadows and bounces against the path tracer, and write docs/accuracy/shadows.md.
    Unbiased(unbiased::Unbiased),
    /// Measure how much of models shows their wear, in the light of `hairline render MODEL`.
    Wear(wear::WearShown),
    /// Make the viewer for browsers, a folder of static files.
    Web(web::Web),
    /// Make the package for Python, a wheel for Linux, and test it in an environment of its own.
    Wheel(wheel::Wheel),
}

fn main() -> anyhow::Result<()> {
    match Command::parse() {
        Command::Accuracy(command) => command.run(),
        Command::Dist(command) => command.run(),
        Command::FitLobes(command) => command.run(),
        Command::Fuzz(command) => command.run(),
        Command::Gratings(command) => command.run(),
        Command::MakeModels(command) => command.run(),
        Command::Models(command) => command.run(),
        Command::Package(command) => command.run(),
        Command::Paths => paths::run(),
        Command::Pictures(command) => command.run(),
        Command::Rooms(command) => command.run(),
        Command::Shaders(command) => command.run(),
        Command::Touches(command) => command.run(),
        Command::Unbiased(command) => command.run(),
        Command::Wear(command) => command.run(),
        Command::Web(command) => command.run(),
        Command::Wheel(command) => command.run(),
    }
}
