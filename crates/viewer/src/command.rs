//! All commands of menus, buttons and keys in one table, from which the menus, the toolbar and the help are made.

mod key_text;

use egui::{Key, KeyboardShortcut, Modifiers};
use hairline_document::navigate::Viewpoint;

use crate::free_view::ViewCommand;
use crate::overlays::Overlay;
use crate::platform::{HAS_DISK, HAS_PAGE, HAS_THREADS};
use crate::reading::{ReadCommand, Shows};
use crate::tools::Tool;

pub(crate) use key_text::key_text;

/// A command of the artist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Command {
    New,
    Gallery,
    Open,
    Save,
    SaveAs,
    CopyLink,
    Reload,
    Revert,
    AddModel,
    SetEnvironment,
    Screenshot,
    Turntable,
    ExportModel,
    SaveList,
    Compare,
    TakeSnapshot,
    FlipSnapshot,
    KeepLook,
    NextLook,
    Quit,
    Undo,
    Redo,
    Rename,
    Duplicate,
    Delete,
    MoveUp,
    MoveDown,
    ToggleHidden,
    ToggleSolo,
    LightForScratches,
    SavePreset,
    FrameAll,
    FrameSelection,
    FocusHere,
    FullScreen,
    ToggleList,
    ToggleInspector,
    Look(Viewpoint),
    Pick(Tool),
    BrushSmaller,
    BrushLarger,
    EngraveText,
    EngraveDrawing,
    AddList,
    Deselect,
    Help,
    ListScratches,
    Read(ReadCommand),
    View(ViewCommand),
    Overlay(Overlay),
    Overlays,
    Shadows,
    Pause,
    WholePicture,
    HighContrast,
}

hairline_image::listed! {
    /// Menu where a command is found.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(crate) enum Group {
        File = "File";
        Edit = "Edit";
        View = "View";
        Inspect = "Inspect";
        Tools = "Tools";
        Help = "Help";
    }
    fn name;
}

impl Group {
    /// Key that opens its menu, with Alt: the first letter of its name.
    pub fn key(self) -> Key {
        Key::from_name(&self.name()[..1]).expect("a menu begins with a letter")
    }
}

/// One line of the table.
pub(crate) struct Entry {
    pub command: Command,
    pub group: Group,
    /// Name in menus.
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

/// All commands in the order of the menus.
#[rustfmt::skip]
const TABLE: &[Entry] = &[
    entry(Command::New, Group::File, "New empty studio", Some((COMMAND, Key::N))),
    entry(Command::Gallery, Group::File, "Examples…", Some((COMMAND_SHIFT, Key::O))),
    entry(Command::Open, Group::File, "Open…", Some((COMMAND, Key::O))),
    entry(Command::Save, Group::File, "Save", Some((COMMAND, Key::S))),
    entry(Command::SaveAs, Group::File, "Save as…", Some((COMMAND_SHIFT, Key::S))),
    entry(Command::CopyLink, Group::File, "Copy a link to the scene", Some((Modifiers::SHIFT, Key::L))),
    entry(Command::Reload, Group::File, "Reload from the file", Some((COMMAND, Key::R))),
    entry(Command::Revert, Group::File, "Revert to what was saved", None),
    entry(Command::AddModel, Group::File, "Add a model…", Some((COMMAND, Key::I))),
    entry(Command::SetEnvironment, Group::File, "Set the environment (HDR, EXR)…", None),
    entry(Command::Screenshot, Group::File, "Save a picture…", Some((COMMAND, Key::P))),
    entry(Command::Turntable, Group::File, "Export a turntable…", None),
    entry(Command::ExportModel, Group::File, "Export model…", Some((COMMAND_SHIFT, Key::E))),
    entry(Command::SaveList, Group::File, "Save the list of scratches…", None),
    entry(Command::Quit, Group::File, "Quit", Some((COMMAND, Key::Q))),
    entry(Command::Undo, Group::Edit, "Undo", Some((COMMAND, Key::Z))),
    entry(Command::Redo, Group::Edit, "Redo", Some((COMMAND_SHIFT, Key::Z))),
    entry(Command::Rename, Group::Edit, "Rename", Some((PLAIN, Key::F2))),
    entry(Command::Duplicate, Group::Edit, "Duplicate", Some((COMMAND, Key::D))),
    entry(Command::Delete, Group::Edit, "Delete", Some((PLAIN, Key::Delete))),
    entry(Command::MoveUp, Group::Edit, "Move up", Some((Modifiers::ALT, Key::ArrowUp))),
    entry(Command::MoveDown, Group::Edit, "Move down", Some((Modifiers::ALT, Key::ArrowDown))),
    entry(Command::ToggleSolo, Group::Edit, "Solo, or all", Some((Modifiers::SHIFT, Key::H))),
    entry(Command::ToggleHidden, Group::Edit, "Hide or show", Some((PLAIN, Key::H))),
    entry(Command::LightForScratches, Group::Edit, "Light for the scratches", None),
    entry(Command::SavePreset, Group::Edit, "Save as a preset…", Some((COMMAND_SHIFT, Key::P))),
    entry(Command::KeepLook, Group::Edit, "Keep this look", Some((COMMAND, Key::L))),
    entry(Command::NextLook, Group::Edit, "Take the next look", Some((Modifiers::SHIFT, Key::PageDown))),
    entry(Command::Deselect, Group::Edit, "Select nothing", Some((PLAIN, Key::Escape))),
    entry(Command::FrameAll, Group::View, "Frame all", Some((PLAIN, Key::A))),
    entry(Command::FrameSelection, Group::View, "Frame the selection", Some((PLAIN, Key::F))),
    entry(Command::FocusHere, Group::View, "Focus here", Some((Modifiers::SHIFT, Key::F))),
    entry(Command::Look(Viewpoint::Front), Group::View, "From the front", Some((PLAIN, Key::Num1))),
    entry(Command::Look(Viewpoint::Back), Group::View, "From the back", Some((PLAIN, Key::Num2))),
    entry(Command::Look(Viewpoint::Left), Group::View, "From the left", Some((PLAIN, Key::Num3))),
    entry(Command::Look(Viewpoint::Right), Group::View, "From the right", Some((PLAIN, Key::Num4))),
    entry(Command::Look(Viewpoint::Top), Group::View, "From above", Some((PLAIN, Key::Num5))),
    entry(Command::Look(Viewpoint::Bottom), Group::View, "From below", Some((PLAIN, Key::Num6))),
    entry(Command::Look(Viewpoint::ThreeQuarter), Group::View, "Three quarters", Some((PLAIN, Key::Num7))),
    entry(Command::View(ViewCommand::LookThroughCamera), Group::View, "Look through the camera", Some((PLAIN, Key::Num0))),
    entry(Command::View(ViewCommand::SetCameraToView), Group::View, "Set the camera to the view", Some((PLAIN, Key::K))),
    entry(Command::View(ViewCommand::MoveCamera), Group::View, "Move the camera with the view", None),
    entry(Command::View(ViewCommand::Bookmark), Group::View, "Keep this view", Some((COMMAND, Key::B))),
    entry(Command::View(ViewCommand::NextBookmark), Group::View, "Next kept view", Some((PLAIN, Key::PageDown))),
    entry(Command::View(ViewCommand::Turntable), Group::View, "Turntable", Some((PLAIN, Key::T))),
    entry(Command::Overlays, Group::View, "All overlays", Some((PLAIN, Key::O))),
    entry(Command::Overlay(Overlay::Directions), Group::View, "Directions of scratches", None),
    entry(Command::Overlay(Overlay::AllDirections), Group::View, "Directions of all layers", None),
    entry(Command::Overlay(Overlay::Brush), Group::View, "Outline of the brush", None),
    entry(Command::Overlay(Overlay::Lights), Group::View, "Outlines of lights", None),
    entry(Command::Overlay(Overlay::Handles), Group::View, "Handles of the selection", None),
    entry(Command::Overlay(Overlay::Names), Group::View, "Names", None),
    entry(Command::Shadows, Group::View, "Shadows", Some((Modifiers::SHIFT, Key::S))),
    entry(Command::HighContrast, Group::View, "High contrast", None),
    entry(Command::ToggleList, Group::View, "List at the left", Some((PLAIN, Key::F9))),
    entry(Command::ToggleInspector, Group::View, "Panel at the right", Some((PLAIN, Key::F10))),
    entry(Command::FullScreen, Group::View, "Full screen", Some((PLAIN, Key::F11))),
    entry(Command::Compare, Group::View, "Compare with the reference", Some((PLAIN, Key::C))),
    entry(Command::TakeSnapshot, Group::View, "Take a snapshot", Some((PLAIN, Key::S))),
    entry(Command::FlipSnapshot, Group::View, "Flip to the snapshot and back", Some((PLAIN, Key::J))),
    entry(Command::Read(ReadCommand::Probe), Group::Inspect, "Probe a pixel", Some((PLAIN, Key::I))),
    entry(Command::Read(ReadCommand::Histogram), Group::Inspect, "Histogram", Some((PLAIN, Key::G))),
    entry(Command::Read(ReadCommand::FalseColor), Group::Inspect, "False colour, or the picture", Some((PLAIN, Key::X))),
    entry(Command::Read(ReadCommand::NextView), Group::Inspect, "Next layer view", Some((PLAIN, Key::N))),
    entry(Command::Read(ReadCommand::Show(Shows::Beauty)), Group::Inspect, "Show the picture", None),
    entry(Command::Read(ReadCommand::Show(Shows::Base)), Group::Inspect, "Show the base", None),
    entry(Command::Read(ReadCommand::Show(Shows::Scratches)), Group::Inspect, "Show the scratches", None),
    entry(Command::Read(ReadCommand::Show(Shows::Density)), Group::Inspect, "Show the density of scratches", None),
    entry(Command::Read(ReadCommand::Show(Shows::Normal)), Group::Inspect, "Show normals", None),
    entry(Command::Read(ReadCommand::Show(Shows::Depth)), Group::Inspect, "Show depths", None),
    entry(Command::Read(ReadCommand::ResetExposure), Group::Inspect, "As bright as the camera says", Some((Modifiers::SHIFT, Key::Comma))),
    entry(Command::Read(ReadCommand::Brighter), Group::Inspect, "Brighter in the window", Some((PLAIN, Key::Period))),
    entry(Command::Read(ReadCommand::Darker), Group::Inspect, "Darker in the window", Some((PLAIN, Key::Comma))),
    entry(Command::ListScratches, Group::Inspect, "List of scratches", Some((Modifiers::SHIFT, Key::M))),
    entry(Command::Overlay(Overlay::Numbers), Group::Inspect, "Numbers of scratches", None),
    entry(Command::Pick(Tool::Select), Group::Tools, "Select", Some((PLAIN, Key::V))),
    entry(Command::Pick(Tool::Brush), Group::Tools, "Brush", Some((PLAIN, Key::B))),
    entry(Command::Pick(Tool::Eraser), Group::Tools, "Eraser", Some((PLAIN, Key::E))),
    entry(Command::Pick(Tool::Pen), Group::Tools, "Pen", Some((PLAIN, Key::D))),
    entry(Command::Pick(Tool::PlaceLight), Group::Tools, "Place light", Some((PLAIN, Key::L))),
    entry(Command::Pick(Tool::PickPart), Group::Tools, "Pick part", Some((PLAIN, Key::P))),
    entry(Command::Pick(Tool::Region), Group::Tools, "Render region", Some((PLAIN, Key::R))),
    entry(Command::WholePicture, Group::Tools, "Render all of the picture alike", Some((Modifiers::SHIFT, Key::R))),
    entry(Command::Pause, Group::Tools, "Pause the rendering", Some((Modifiers::SHIFT, Key::P))),
    entry(Command::Pick(Tool::Measure), Group::Tools, "Measure", Some((PLAIN, Key::M))),
    entry(Command::BrushSmaller, Group::Tools, "Smaller brush", Some((PLAIN, Key::OpenBracket))),
    entry(Command::BrushLarger, Group::Tools, "Larger brush", Some((PLAIN, Key::CloseBracket))),
    entry(Command::EngraveText, Group::Tools, "Engrave a text", None),
    entry(Command::EngraveDrawing, Group::Tools, "Engrave a drawing (SVG)…", None),
    entry(Command::AddList, Group::Tools, "Scratches from a list (CSV)…", None),
    entry(Command::Help, Group::Help, "Keys and mouse", Some((PLAIN, Key::F1))),
];

/// Further keys, which other programs have taught.
const ALSO: &[(Command, KeyboardShortcut)] = &[
    (Command::Redo, KeyboardShortcut::new(COMMAND, Key::Y)),
    (
        Command::Delete,
        KeyboardShortcut::new(PLAIN, Key::Backspace),
    ),
];

/// Commands before which a menu draws a line.
const SECTIONS: &[Command] = &[
    Command::Save,
    Command::AddModel,
    Command::Screenshot,
    Command::Quit,
    Command::Rename,
    Command::MoveUp,
    Command::ToggleSolo,
    Command::LightForScratches,
    Command::Deselect,
    Command::Look(Viewpoint::Front),
    Command::Shadows,
    Command::HighContrast,
    Command::Compare,
    Command::Pick(Tool::Region),
    Command::BrushSmaller,
    Command::EngraveText,
    Command::ListScratches,
];

/// The commands that are here, in the order of the menus.
pub(crate) fn entries() -> impl Iterator<Item = &'static Entry> {
    TABLE.iter().filter(|entry| entry.command.is_here())
}

impl Command {
    fn entry(self) -> Option<&'static Entry> {
        TABLE.iter().find(|entry| entry.command == self)
    }

    /// Whether the command works on this platform: then it is in the menus and has its key.
    pub fn is_here(self) -> bool {
        match self {
            Self::Reload | Self::Quit => HAS_DISK,
            Self::CopyLink => HAS_PAGE,
            Self::Turntable | Self::Compare | Self::Read(ReadCommand::Probe) => HAS_THREADS,
            _ => true,
        }
    }

    /// Name for menus and screen readers.
    pub fn label(self) -> &'static str {
        self.entry().map_or("", |entry| entry.label)
    }

    pub fn shortcut(self) -> Option<KeyboardShortcut> {
        self.entry()?.shortcut
    }

    /// Whether a menu draws a line before it.
    pub fn begins_section(self) -> bool {
        SECTIONS.contains(&self)
    }

    /// The next command whose key was pressed: a slow pass gathers several presses. None while a text is being edited, but for those with
    /// the command key; and not Escape where it `is_taken` by what is open.
    pub fn next_pressed(ctx: &egui::Context, escape_is_taken: bool) -> Option<Self> {
        let is_typing = ctx.text_edit_focused();
        let own = entries().filter_map(|entry| Some((entry.command, entry.shortcut?)));
        let also = ALSO
            .iter()
            .copied()
            .filter(|(command, _)| command.is_here());
        let mut keys: Vec<_> = own.chain(also).collect();
        // A shortcut comes before another one whose modifiers it includes.
        let modifiers = |keys: &Modifiers| {
            [keys.command, keys.shift, keys.alt]
                .into_iter()
                .filter(|held| *held)
                .count()
        };
        keys.sort_by_key(|(_, key)| std::cmp::Reverse(modifiers(&key.modifiers)));
        keys.retain(|(_, key)| {
            let is_taken = is_typing && !key.modifiers.command
                || escape_is_taken && key.logical_key == Key::Escape;
            !is_taken
        });
        ctx.input_mut(|input| {
            let of = |event: &egui::Event| {
                let pressed = keys.iter().find(|(_, key)| is_press(event, key));
                pressed.map(|(command, _)| *command)
            };
            let i = input.events.iter().position(|event| of(event).is_some())?;
            of(&input.events.remove(i))
        })
    }
}

/// Whether an event is the press of a shortcut, with further modifiers or without.
fn is_press(event: &egui::Event, shortcut: &KeyboardShortcut) -> bool {
    matches!(event, egui::Event::Key { key, modifiers, pressed: true, .. }
        if *key == shortcut.logical_key
            // Alt alone opens menus.
            && modifiers.alt == shortcut.modifiers.alt
            && modifiers.matches_logically(shortcut.modifiers))
}

/// The keys of a command besides its first.
pub(crate) fn further_keys(command: Command) -> impl Iterator<Item = KeyboardShortcut> {
    let also = ALSO.iter().filter(move |(other, _)| *other == command);
    also.map(|(_, key)| *key)
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
        for (_, also) in ALSO {
            assert!(TABLE.iter().all(|entry| entry.shortcut != Some(*also)));
        }
    }

    /// Keys read as they are printed on a keyboard, without names such as "OpenBracket".
    #[test]
    fn keys_read_as_on_the_keyboard() {
        let text = |command: Command| key_text(&command.shortcut().unwrap());
        assert_eq!(text(Command::BrushSmaller), "[");
        assert_eq!(text(Command::Look(Viewpoint::Front)), "1");
        assert_eq!(text(Command::Deselect), "Esc");
        if !cfg!(target_os = "macos") {
            assert_eq!(text(Command::Redo), "Ctrl+Shift+Z");
            assert_eq!(text(Command::MoveUp), "Alt+Up");
        }
        for key in TABLE.iter().filter_map(|entry| entry.shortcut) {
            let text = key_text(&key);
            let last = text.rsplit('+').next().unwrap();
            assert!(last.len() <= 5, "{text}");
        }
    }

    /// The order is that of every other program.
    #[test]
    fn the_usual_order() {
        let at = |command: Command| TABLE.iter().position(|e| e.command == command).unwrap();
        assert!(at(Command::Save) < at(Command::SaveAs));
        assert!(at(Command::Undo) < at(Command::Redo));
        assert!(
            TABLE
                .iter()
                .all(|e| e.command != Command::Quit || e.group == Group::File)
        );
    }
}
