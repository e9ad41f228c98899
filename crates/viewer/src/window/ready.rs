//! Checks that a window can be opened; if not, one sentence says what helps.

/// Returns what is missing for a window, before one is tried: the libraries of the display are loaded while it opens, some
/// of which end the program where they are not there.
#[cfg(target_os = "linux")]
pub(super) fn missing() -> Option<String> {
    use x11_dl::{xcursor::Xcursor, xinput2::XInput2, xlib::Xlib, xlib_xcb::Xlib_xcb};
    use xkbcommon_dl::{x11::xkbcommon_x11_option, xkbcommon_option};

    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let has_wayland = is_set("WAYLAND_DISPLAY") || is_set("WAYLAND_SOCKET");
    if !has_wayland && !is_set("DISPLAY") {
        let text = "there is no display, as neither WAYLAND_DISPLAY nor DISPLAY is set: start it in a desktop session, or \
                    through `ssh -X`";
        return Some(text.to_owned());
    }
    let library = |name: &str, debian: &str, fedora: &str| {
        Some(format!(
            "the library {name} is missing: install {debian} (Debian, Ubuntu) or {fedora} (Fedora)"
        ))
    };
    if xkbcommon_option().is_none() {
        return library("libxkbcommon.so.0", "libxkbcommon0", "libxkbcommon");
    }
    if has_wayland {
        return None;
    }
    if Xlib::open().is_err() {
        return library("libX11.so.6", "libx11-6", "libX11");
    }
    if Xlib_xcb::open().is_err() {
        return library("libX11-xcb.so.1", "libx11-xcb1", "libX11-xcb");
    }
    if Xcursor::open().is_err() {
        return library("libXcursor.so.1", "libxcursor1", "libXcursor");
    }
    if XInput2::open().is_err() {
        return library("libXi.so.6", "libxi6", "libXi");
    }
    if xkbcommon_x11_option().is_none() {
        return library(
            "libxkbcommon-x11.so.0",
            "libxkbcommon-x11-0",
            "libxkbcommon-x11",
        );
    }
    None
}

/// Nothing is missing: other systems have their display built in.
#[cfg(not(target_os = "linux"))]
pub(super) fn missing() -> Option<String> {
    None
}

/// The sentence for an error of the window's own library.
pub(super) fn sentence(error: &str) -> String {
    let display = |name: &str| std::env::var(name).unwrap_or_default();
    if error.contains("connection to X server") {
        return format!(
            "no X server answers at DISPLAY={}: check that the desktop session is there and lets this user in",
            display("DISPLAY")
        );
    }
    if error.contains("find wayland compositor") || error.contains("NoCompositor") {
        return format!(
            "no Wayland compositor answers at WAYLAND_DISPLAY={}: unset it to use X11, or start it in a desktop session",
            display("WAYLAND_DISPLAY")
        );
    }
    let is_graphics = [
        "Failed to create surface",
        "wgpu adapter",
        "adapter",
        "graphics",
    ];
    if is_graphics.iter().any(|words| error.contains(words)) {
        return "there is no graphics driver that can draw a window: install mesa-vulkan-drivers (Debian, Ubuntu, Fedora) \
                or the driver of the graphics card"
            .to_owned();
    }
    without_paths(error)
}

/// Removes places in the source of libraries on the machine that built this program, and empty lists.
fn without_paths(error: &str) -> String {
    let mut kept: Vec<&str> = Vec::new();
    for part in error.split(": ") {
        let is_place = part.contains(".rs:");
        if !is_place && part.trim() != "{}" && !part.is_empty() {
            kept.push(part);
        }
    }
    match kept.is_empty() {
        true => "the system gave no reason".to_owned(),
        false => kept.join(": "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_is_a_sentence_without_places_of_the_build() {
        let place = "winit EventLoopError: os error at /home/a/.cargo/registry/winit/src/linux/mod.rs:788: ";
        for (said, wanted) in [
            (
                "Failed to open connection to X server",
                "no X server answers",
            ),
            ("Could not find wayland compositor", "no Wayland compositor"),
            ("Something else", "winit EventLoopError: Something else"),
        ] {
            let text = sentence(&format!("{place}{said}"));
            assert!(text.contains(wanted), "{text}");
            assert!(!text.contains(".rs") && !text.contains(".cargo"), "{text}");
        }
        let none = sentence("WGPU error: Failed to create surface for any enabled backend: {}");
        assert!(
            none.contains("mesa-vulkan-drivers") && !none.contains("{}"),
            "{none}"
        );
        assert_eq!(sentence("Odd: {}"), "Odd");
    }
}
