//! Everything that a menu, a button or a key can ask for: one table, which the menus, the toolbar and the help read.

mod run;

use egui::{Key, KeyboardShortcut, Modifiers};
use hairline_editor::navigate::Viewpoint;

use crate::platform::{HAS_FILES, HAS_THREADS};
use crate::tools::Tool;

/// A wish of the artist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Command {
    New,
    Open,
    Save,
    SaveAs,
    AddModel,
    SetEnvironment,
    Screenshot,
    Turntable,
    Compare,
    Quit,
    Undo,
    Redo,
    Duplicate,
    Delete,
    MoveUp,
    MoveDown,
    ToggleHidden,
    ToggleSolo,
    FrameAll,
    FrameSelection,
    Look(Viewpoint),
    Pick(Tool),
    BrushSmaller,
    BrushLarger,
    Deselect,
    Help,
}

/// Where a command is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Group {
    File,
    Edit,
    View,
    Tools,
    Help,
}

impl Group {
    pub const ALL: [Self; 5] = [Self::File, Self::Edit, Self::View, Self::Tools, Self::Help];

    pub fn name(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Edit => "Edit",
            Self::View => "View",
            Self::Tools => "Tools",
            Self::Help => "Help",
        }
    }
}

/// One line of the table.
pub(crate) struct Entry {
    pub command: Command,
    pub group: Group,
    /// What menus call it.
    pub label: &'static str,
    pub shortcut: Option<KeyboardShortcut>,
}

const fn entry(
    command: Command,
    group: Group,
    label: &'static str,
    shortcut: Option<(Modifiers, Key)>,
) -> Entry {
    let shortcut = match shortcut {
        Some((modifiers, key)) => Some(KeyboardShortcut::new(modifiers, key)),
        None => None,
    };
    Entry {
        command,
        group,
        label,
        shortcut,
    }
}

const COMMAND: Modifiers = Modifiers::COMMAND;
const COMMAND_SHIFT: Modifiers = Modifiers {
    shift: true,
    ..Modifiers::COMMAND
};
const PLAIN: Modifiers = Modifiers::NONE;

/// In the order of the menus. Of two shortcuts where one's modifiers include the other's, the larger comes first.
#[rustfmt::skip]
const TABLE: &[Entry] = &[
    entry(Command::New, Group::File, "New from the built-in scene", Some((COMMAND, Key::N))),
    entry(Command::Open, Group::File, "Open…", Some((COMMAND, Key::O))),
    entry(Command::SaveAs, Group::File, "Save as…", Some((COMMAND_SHIFT, Key::S))),
    entry(Command::Save, Group::File, "Save", Some((COMMAND, Key::S))),
    entry(Command::AddModel, Group::File, "Add a model (glTF)…", Some((COMMAND, Key::I))),
    entry(Command::SetEnvironment, Group::File, "Set the environment (HDR, EXR)…", None),
    entry(Command::Screenshot, Group::File, "Save a picture…", Some((COMMAND, Key::P))),
    entry(Command::Turntable, Group::File, "Export a turntable…", None),
    entry(Command::Quit, Group::File, "Quit", Some((COMMAND, Key::Q))),
    entry(Command::Redo, Group::Edit, "Redo", Some((COMMAND_SHIFT, Key::Z))),
    entry(Command::Undo, Group::Edit, "Undo", Some((COMMAND, Key::Z))),
    entry(Command::Duplicate, Group::Edit, "Duplicate", Some((COMMAND, Key::D))),
    entry(Command::Delete, Group::Edit, "Delete", Some((PLAIN, Key::Delete))),
    entry(Command::MoveUp, Group::Edit, "Move up", Some((Modifiers::ALT, Key::ArrowUp))),
    entry(Command::MoveDown, Group::Edit, "Move down", Some((Modifiers::ALT, Key::ArrowDown))),
    entry(Command::ToggleSolo, Group::Edit, "Solo, or all", Some((Modifiers::SHIFT, Key::H))),
    entry(Command::ToggleHidden, Group::Edit, "Hide or show", Some((PLAIN, Key::H))),
    entry(Command::Deselect, Group::Edit, "Select nothing", Some((PLAIN, Key::Escape))),
    entry(Command::FrameAll, Group::View, "Frame all", Some((PLAIN, Key::A))),
    entry(Command::FrameSelection, Group::View, "Frame the selection", Some((PLAIN, Key::F))),
    entry(Command::Look(Viewpoint::Front), Group::View, "From the front", Some((PLAIN, Key::Num1))),
    entry(Command::Look(Viewpoint::Back), Group::View, "From the back", Some((PLAIN, Key::Num2))),
    entry(Command::Look(Viewpoint::Left), Group::View, "From the left", Some((PLAIN, Key::Num3))),
    entry(Command::Look(Viewpoint::Right), Group::View, "From the right", Some((PLAIN, Key::Num4))),
    entry(Command::Look(Viewpoint::Top), Group::View, "From above", Some((PLAIN, Key::Num5))),
    entry(Command::Look(Viewpoint::Bottom), Group::View, "From below", Some((PLAIN, Key::Num6))),
    entry(Command::Look(Viewpoint::ThreeQuarter), Group::View, "Three quarters", Some((PLAIN, Key::Num7))),
    entry(Command::Compare, Group::View, "Compare with the reference", Some((PLAIN, Key::C))),
    entry(Command::Pick(Tool::Select), Group::Tools, "Select", Some((PLAIN, Key::V))),
    entry(Command::Pick(Tool::Brush), Group::Tools, "Brush", Some((PLAIN, Key::B))),
    entry(Command::Pick(Tool::Eraser), Group::Tools, "Eraser", Some((PLAIN, Key::E))),
    entry(Command::Pick(Tool::PlaceLight), Group::Tools, "Place light", Some((PLAIN, Key::L))),
    entry(Command::BrushSmaller, Group::Tools, "Smaller brush", Some((PLAIN, Key::OpenBracket))),
    entry(Command::BrushLarger, Group::Tools, "Larger brush", Some((PLAIN, Key::CloseBracket))),
    entry(Command::Help, Group::Help, "Keys and mouse", Some((PLAIN, Key::F1))),
];

/// The commands that are here, in the order of the menus.
pub(crate) fn entries() -> impl Iterator<Item = &'static Entry> {
    TABLE.iter().filter(|entry| entry.command.is_here())
}

impl Command {
    fn entry(self) -> Option<&'static Entry> {
        TABLE.iter().find(|entry| entry.command == self)
    }

    /// Whether this platform has what it needs: then it is in the menus and has its key.
    pub fn is_here(self) -> bool {
        match self {
            Self::Open
            | Self::Save
            | Self::SaveAs
            | Self::AddModel
            | Self::SetEnvironment
            | Self::Screenshot
            | Self::Turntable
            | Self::Quit => HAS_FILES,
            Self::Compare => HAS_THREADS,
            _ => true,
        }
    }

    /// What menus and screen readers call it.
    pub fn label(self) -> &'static str {
        self.entry().map_or("", |entry| entry.label)
    }

    pub fn shortcut(self) -> Option<KeyboardShortcut> {
        self.entry()?.shortcut
    }

    /// The commands whose keys were pressed. None while a text is being edited, but for those with the command key.
    pub fn pressed(ctx: &egui::Context) -> Vec<Self> {
        let is_typing = ctx.text_edit_focused();
        let wanted = |entry: &&Entry| {
            let shortcut = entry.shortcut?;
            if is_typing && !shortcut.modifiers.command {
                return None;
            }
            ctx.input_mut(|input| input.consume_shortcut(&shortcut))
                .then_some(entry.command)
        };
        entries().filter_map(|entry| wanted(&entry)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_commands_share_a_key_or_a_name() {
        for (i, a) in TABLE.iter().enumerate() {
            for b in &TABLE[i + 1..] {
                assert_ne!(a.label, b.label);
                assert!(
                    a.shortcut.is_none() || a.shortcut != b.shortcut,
                    "{} {}",
                    a.label,
                    b.label
                );
                assert_ne!(a.command, b.command);
            }
        }
    }
}
