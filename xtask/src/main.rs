//! Tasks that cargo does not do itself. `cargo xtask COMMAND`; each command is one file.

#[cfg(test)]
mod architecture;
mod archive;
mod blender;
mod dist;
mod mutate;
mod package;
mod paths;
mod pictures;
mod program;
mod rooms;
mod shaders;
mod wasm;
mod web;
mod wheel;

use clap::Parser;

#[derive(Parser)]
#[command(name = "cargo xtask", about)]
enum Command {
    /// Make the extension for Blender, a zip for Linux.
    Blender(blender::Blender),
    /// Make all that is handed out for the machine that it runs on: an archive of the programs, the packages for Python, Blender and npm, the page.
    Dist(dist::Dist),
    /// Make each fault of tests/mutants.toml, which a test must find.
    Mutate(mutate::Mutate),
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
    /// Make the viewer for browsers, a folder of static files.
    Web(web::Web),
    /// Make the package for Python, a wheel for Linux, and test it in an environment of its own.
    Wheel(wheel::Wheel),
}

fn main() -> anyhow::Result<()> {
    match Command::parse() {
        Command::Blender(command) => command.run(),
        Command::Dist(command) => command.run(),
        Command::Mutate(command) => command.run(),
        Command::Package(command) => command.run(),
        Command::Paths => paths::run(),
        Command::Pictures(command) => command.run(),
        Command::Rooms(command) => command.run(),
        Command::Shaders(command) => command.run(),
        Command::Web(command) => command.run(),
        Command::Wheel(command) => command.run(),
    }
}

#[cfg(test)]
mod tests {
    use hairline_fixtures::documents::documents;

    use super::*;

    #[test]
    fn tasks_in_documents_exist() {
        for block in documents().into_iter().flat_map(|(_, blocks)| blocks) {
            let commands = block.text.lines().filter(|_| block.language == "sh");
            for command in commands.filter_map(|line| line.split("cargo xtask ").nth(1)) {
                let command = command.split(['#', '&']).next().unwrap_or(command);
                let words = ["xtask"].into_iter().chain(command.split_whitespace());
                let parsed = Command::try_parse_from(words);
                assert!(parsed.is_ok(), "{}: {:?}", block.place, parsed.err());
            }
        }
    }
}
