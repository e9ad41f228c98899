//! `hairline completions` and `hairline man`: made from the flags themselves.

use anyhow::anyhow;
use clap::CommandFactory;
use clap_complete::Shell;
use clap_mangen::Man;
use clap_mangen::roff::Roff;

use crate::cli::Cli;
use hairline_console::print;
use hairline_render::failure::Failure;

/// Prints a shell's completions of the command line.
pub fn completions(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "hairline", &mut script);
    print(&String::from_utf8_lossy(&script))
}

/// Prints one page about all commands, or about one of them.
pub fn page(only: Option<&str>) -> Result<(), Failure> {
    let failed = |error: std::io::Error| Failure::Work(error.into());
    let mut command = Cli::command();
    // So that each command's synopsis has the whole name.
    command.build();
    let parts: Vec<_> = command
        .get_subcommands()
        .filter(|part| part.get_name() != "help")
        .collect();
    let mut page = Vec::new();
    if let Some(name) = only {
        let Some(part) = parts.iter().find(|part| part.get_name() == name) else {
            let names: Vec<_> = parts.iter().map(|part| part.get_name()).collect();
            let names = names.join(", ");
            return Err(Failure::Input(anyhow!(
                "found the command `{name}`; must be one of {names}"
            )));
        };
        Man::new((*part).clone())
            .render(&mut page)
            .map_err(failed)?;
        return print(&String::from_utf8_lossy(&page));
    }
    Man::new(command.clone())
        .render(&mut page)
        .map_err(failed)?;
    for part in parts {
        let name = format!("hairline {}", part.get_name());
        let mut roff = Roff::new();
        roff.control("SH", [name.to_uppercase().as_str()]);
        roff.to_writer(&mut page).map_err(failed)?;
        let man = Man::new(part.clone());
        man.render_description_section(&mut page).map_err(failed)?;
        man.render_synopsis_section(&mut page).map_err(failed)?;
        man.render_options_section(&mut page).map_err(failed)?;
    }
    print(&String::from_utf8_lossy(&page))
}
