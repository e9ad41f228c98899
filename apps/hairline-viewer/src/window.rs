//! Reason why there is no window, in one sentence that says what to do.

use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};

use anyhow::anyhow;

use hairline_render::failure::Failure;

/// Opens the window by `open`. The window's libraries panic where the system lacks one that they need: that becomes a sentence.
pub fn in_one_sentence<T>(open: impl FnOnce() -> T) -> Result<T, Failure> {
    let hook = take_hook();
    // Other panics are told of as ever.
    set_hook(Box::new(move |panic| {
        if missing_library(text_of(panic.payload())).is_none() {
            hook(panic);
        }
    }));
    catch_unwind(AssertUnwindSafe(open)).map_err(|payload| {
        match missing_library(text_of(payload.as_ref())) {
            Some(library) => failure(library),
            None => Failure::Work(anyhow!("the viewer has ended")),
        }
    })
}

/// Translates an error of the window's libraries for the user.
pub fn failure(reason: &str) -> Failure {
    let else_render = "`hairline render` needs no window";
    let mentions = |words: &[&str]| {
        let reason = reason.to_lowercase();
        words.iter().any(|word| reason.contains(word))
    };
    // One of four libraries is missing, and the message does not say which.
    let sentence = if reason.contains("xlib's shared libraries") {
        format!(
            "no window could be opened: a library of the X Window System is missing; install them (on Debian and Ubuntu \
             `apt install libx11-6 libx11-xcb1 libxcursor1 libxi6`); {else_render}"
        )
    } else if let Some(library) = missing_library(reason) {
        format!(
            "no window could be opened: the library {library} is missing; install it (on Debian and Ubuntu \
             `apt install {}`); {else_render}",
            package_of(library)
        )
    } else if mentions(&[
        "display is set",
        "connection to x server",
        "wayland_display",
        "wayland compositor",
        "noconnection",
        "open display",
    ]) {
        format!(
            "no window could be opened: there is no display; start it in a desktop session, or set DISPLAY or \
             WAYLAND_DISPLAY to one that runs; {else_render}"
        )
    } else if mentions(&["adapter", "wgpu", "surface", "vulkan"]) {
        format!(
            "no window could be opened: no graphics driver can draw it; install one (on Debian and Ubuntu \
             `apt install mesa-vulkan-drivers libegl1 libgl1-mesa-dri`); {else_render}"
        )
    } else {
        format!(
            "no window could be opened ({}); {else_render}",
            without_place(reason)
        )
    };
    Failure::Work(anyhow!(sentence))
}

/// Returns the text after `os error at /a/folder/of/another/machine.rs:12: `.
fn without_place(reason: &str) -> &str {
    let place = reason.find(".rs:").map(|at| &reason[at + 4..]);
    let after = place.and_then(|place| Some(place.split_once(": ")?.1));
    after.unwrap_or(reason).trim_end_matches('.')
}

/// The file name of a library in a message, `libX11-xcb.so.1`.
fn missing_library(text: &str) -> Option<&str> {
    let is_name = |c: char| c.is_ascii_alphanumeric() || "-_.+".contains(c);
    let library = text
        .split(|c: char| !is_name(c))
        .map(|word| word.trim_end_matches('.'))
        .find(|word| word.starts_with("lib") && word.contains(".so"));
    library.or_else(|| {
        // Names of the libraries, without the files' endings.
        [
            "xkbcommon-x11",
            "xkbcommon",
            "libxcursor",
            "libxi",
            "libx11",
        ]
        .into_iter()
        .find(|name| {
            let text = text.to_lowercase();
            text.contains(name)
                && ["load", "found", "missing", "open", "not be"]
                    .iter()
                    .any(|w| text.contains(w))
        })
    })
}

/// Package of a library in Debian and Ubuntu.
fn package_of(library: &str) -> &'static str {
    let library = library.to_lowercase();
    let packages = [
        ("xkbcommon-x11", "libxkbcommon-x11-0"),
        ("xkbcommon", "libxkbcommon0"),
        ("x11-xcb", "libx11-xcb1"),
        ("xcursor", "libxcursor1"),
        ("libxi", "libxi6"),
        ("libx11", "libx11-6"),
        ("libxcb", "libxcb1"),
        ("wayland", "libwayland-client0"),
    ];
    let found = packages.iter().find(|(name, _)| library.contains(name));
    found.map_or(
        "libx11-6 libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0",
        |(_, package)| package,
    )
}

fn text_of(payload: &(dyn std::any::Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_become_what_to_do() {
        let place = "winit EventLoopError: os error at /root/.cargo/registry/src/x/winit-0.30.13/src/mod.rs:765: ";
        for (reason, expected) in [
            (
                "neither WAYLAND_DISPLAY nor WAYLAND_SOCKET nor DISPLAY is set.",
                "there is no display",
            ),
            (
                "Failed to open connection to X server",
                "there is no display",
            ),
            (
                "Library libxkbcommon-x11.so could not be loaded.",
                "apt install libxkbcommon-x11-0",
            ),
            (
                "Failed to load one of xlib's shared libraries",
                "apt install libx11-6 libx11-xcb1",
            ),
            (
                "No suitable graphics adapter found",
                "apt install mesa-vulkan-drivers libegl1 libgl1-mesa-dri",
            ),
            ("the moon is full.", "(the moon is full)"),
        ] {
            let failure = failure(&format!("{place}{reason}")).to_string();
            assert!(failure.contains(expected), "{failure}");
            assert!(
                !failure.contains("/root") && !failure.contains("{}"),
                "{failure}"
            );
            assert!(failure.contains("hairline render"), "{failure}");
        }
    }
}
