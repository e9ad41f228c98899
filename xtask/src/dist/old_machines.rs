//! What a program for Linux asks of a machine: no library but glibc's own, of no later version than [`GLIBC`]. All else is opened when it is used.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};

/// The newest glibc that a program may ask for: that of Debian 10, Ubuntu 18.10 and RHEL 8.
pub const GLIBC: [u32; 2] = [2, 28];

/// The beginnings of names of glibc's libraries, and of the one that unwinds stacks, which comes with it.
const LIBRARIES: [&str; 8] = [
    "libc.so.",
    "libm.so.",
    "libdl.so.",
    "libpthread.so.",
    "librt.so.",
    "libutil.so.",
    "libgcc_s.so.",
    "ld-linux",
];

/// Says what a program or a library asks for.
///
/// # Errors
/// Where old machines lack that.
pub fn asks(program: &Path) -> anyhow::Result<String> {
    if cfg!(target_os = "macos") {
        return Ok("macOS".to_owned());
    } else if cfg!(windows) {
        return Ok("Windows 10 or later".to_owned());
    }
    let mut objdump = Command::new("objdump");
    let said = objdump.env("LC_ALL", "C").arg("-p").arg(program).output();
    let said = said.context("objdump, of binutils, cannot be run")?;
    ensure!(said.status.success(), "objdump -p {}", program.display());
    let [major, minor] =
        newest(&String::from_utf8(said.stdout)?).with_context(|| program.display().to_string())?;
    Ok(format!("Linux, glibc {major}.{minor} or later"))
}

/// The same of the module in a wheel's files.
pub fn asks_of_wheel(files: &Path) -> anyhow::Result<String> {
    let module = if cfg!(windows) { "pyd" } else { "abi3.so" };
    asks(&files.join(format!("hairline/_hairline.{module}")))
}

/// The version of glibc that the header of a program asks for, as `objdump -p` writes it.
fn newest(header: &str) -> anyhow::Result<[u32; 2]> {
    let mut newest = [0, 0];
    for line in header.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["NEEDED", library] => ensure!(
                LIBRARIES.iter().any(|start| library.starts_with(start)),
                "found {library}; must be opened when it is used, or be left out"
            ),
            [_, _, _, version] if version.starts_with("GLIBC_2") => {
                let numbers = version["GLIBC_".len()..].split('.').map(str::parse);
                let numbers = numbers.collect::<Result<Vec<u32>, _>>()?;
                let version = [numbers[0], numbers.get(1).copied().unwrap_or(0)];
                ensure!(
                    version <= GLIBC,
                    "found a symbol of glibc {}.{}; must be at most {}.{}",
                    version[0],
                    version[1],
                    GLIBC[0],
                    GLIBC[1]
                );
                newest = newest.max(version);
            }
            _ => {}
        }
    }
    ensure!(newest > [0, 0], "found no symbol of glibc");
    Ok(newest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_old_machines_lack_is_told() {
        let header = "Dynamic Section:\n  NEEDED               libm.so.6\n  NEEDED               libc.so.6\n\nVersion References:\n  required from libc.so.6:\n    0x069691b8 0x00 06 GLIBC_2.28\n    0x09691a75 0x00 03 GLIBC_2.2.5\n";
        assert_eq!(newest(header).unwrap(), [2, 28]);
        let later = header.replace("2.28", "2.34");
        let error = newest(&later).unwrap_err().to_string();
        assert_eq!(error, "found a symbol of glibc 2.34; must be at most 2.28");
        for library in ["libstdc++.so.6", "libX11.so.6", "libvulkan.so.1"] {
            let linked = header.replace("libm.so.6", library);
            assert!(newest(&linked).is_err(), "{library}");
        }
        assert!(newest("").is_err());
    }
}
