//! Shortcuts in words.

use egui::{Key, KeyboardShortcut};

/// Text of a shortcut, as on the keys of the keyboard.
pub(crate) fn key_text(shortcut: &KeyboardShortcut) -> String {
    let is_mac = cfg!(target_os = "macos");
    let names = match is_mac {
        true => egui::ModifierNames::SYMBOLS,
        false => egui::ModifierNames::NAMES,
    };
    let mut text = names.format(&shortcut.modifiers, is_mac);
    if !text.is_empty() && !is_mac {
        text.push('+');
    }
    text.push_str(match shortcut.logical_key {
        Key::Escape => "Esc",
        Key::Delete => "Del",
        Key::Backspace => "Back",
        Key::PageUp => "PgUp",
        Key::PageDown => "PgDn",
        Key::ArrowUp => "Up",
        Key::ArrowDown => "Down",
        Key::ArrowLeft => "Left",
        Key::ArrowRight => "Right",
        Key::OpenBracket => "[",
        Key::CloseBracket => "]",
        Key::Comma => ",",
        Key::Period => ".",
        Key::Minus => "-",
        Key::Plus => "+",
        Key::Equals => "=",
        Key::Slash => "/",
        Key::Backslash => "\\",
        Key::Semicolon => ";",
        Key::Quote => "'",
        Key::Backtick => "`",
        other => other.name(),
    });
    text
}
