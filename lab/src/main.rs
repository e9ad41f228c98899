//! Measurements, fits and models that are made now and then. `cargo lab COMMAND`; each command is one file.

mod accuracy;
mod fine_gratings;
mod fit_lobes;
mod fuzz;

mod gratings;
mod grooves;
mod make_models;
mod models;
mod passes;
mod plot;
mod random;
mod unbiased;
mod wear;

use clap::Parser;

#[derive(Parser)]
#[command(name = "cargo lab", about)]
enum Command {
    /// Measure closed form, separable model and full one against each other, and write docs/accuracy.md.
    Accuracy(accuracy::Accuracy),
    /// Fit the tables of the area-light lobes and write them to crates/optics/data.
    FitLobes(fit_lobes::FitLobes),
    /// Run mutated inputs through the command line: no panic, no hang, no flood of memory.
    Fuzz(fuzz::Fuzz),
    /// Measure gratings against the full wave, and write docs/accuracy/gratings.md.
    Gratings(gratings::Gratings),
    /// Measure wide grooves and profiles against both references, and write docs/accuracy/grooves.md.
    Grooves(grooves::Grooves),
    /// Make the models and the sky of scenes/, and write them to scenes/models and scenes/maps.
    MakeModels(make_models::MakeModels),
    /// Open and render glTF files of public repositories, and write docs/accuracy/models.md.
    Models(models::Models),
    /// Measure the time of each pass on a graphics adapter, for pictures with default options.
    Passes(passes::Passes),
    /// Judge random scenes of one body against the reference, and list the worst.
    Random(random::Random),
    /// Measure shadows and bounces against the path tracer, and write docs/accuracy/shadows.md.
    Unbiased(unbiased::Unbiased),
    /// Measure how much of models shows their wear, in the light of `hairline render MODEL`.
    Wear(wear::WearShown),
}

fn main() -> anyhow::Result<()> {
    match Command::parse() {
        Command::Accuracy(command) => command.run(),
        Command::FitLobes(command) => command.run(),
        Command::Fuzz(command) => command.run(),
        Command::Gratings(command) => command.run(),
        Command::Grooves(command) => command.run(),
        Command::MakeModels(command) => command.run(),
        Command::Models(command) => command.run(),
        Command::Passes(command) => command.run(),
        Command::Random(command) => command.run(),
        Command::Unbiased(command) => command.run(),
        Command::Wear(command) => command.run(),
    }
}
