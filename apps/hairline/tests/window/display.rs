//! An X display without a screen: its server, mouse, keyboard and what is on it.

use std::cell::RefCell;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use egui::{Pos2, Rect};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    self, AtomEnum, ConnectionExt as _, ImageFormat, InputFocus, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// After each movement of a hand: a program that draws by software needs its time to see it.
const REST: Duration = Duration::from_millis(120);

pub struct Display {
    server: Child,
    name: String,
    connection: RustConnection,
    root: Window,
    size_px: [u16; 2],
    /// Keysyms of each keycode from the first.
    keys: (u8, u8, Vec<u32>),
    at: RefCell<Pos2>,
}

impl Display {
    /// None where there is no Xvfb.
    pub fn start(size_px: [u16; 2]) -> Option<Self> {
        let [width, height] = size_px;
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0"])
            .arg(format!("{width}x{height}x24"))
            .arg("-nolisten")
            .arg("tcp")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        // It says its number when it is ready.
        let mut line = String::new();
        BufReader::new(server.stdout.as_mut()?)
            .read_line(&mut line)
            .ok()?;
        let name = format!(":{}", line.trim());
        let Ok((connection, screen)) = x11rb::connect(Some(&name)) else {
            let _ = server.kill();
            return None;
        };
        let setup = connection.setup();
        let root = setup.roots[screen].root;
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let mapping = connection.get_keyboard_mapping(first, last - first + 1);
        let mapping = mapping.unwrap().reply().unwrap();
        Some(Self {
            server,
            name,
            root,
            size_px,
            keys: (first, mapping.keysyms_per_keycode, mapping.keysyms),
            connection,
            at: RefCell::new(Pos2::ZERO),
        })
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// The one window that is large.
    fn window(&self) -> Option<Window> {
        let children = self.connection.query_tree(self.root).ok()?.reply().ok()?;
        children.children.into_iter().find(|&window| {
            let geometry = self.connection.get_geometry(window).ok();
            let geometry = geometry.and_then(|cookie| cookie.reply().ok());
            geometry.is_some_and(|geometry| geometry.width > 300)
        })
    }

    pub fn title(&self) -> Option<String> {
        let name = self.connection.intern_atom(false, b"_NET_WM_NAME").ok()?;
        let name = name.reply().ok()?.atom;
        let property = self
            .connection
            .get_property(false, self.window()?, name, AtomEnum::ANY, 0, 1024)
            .ok()?;
        String::from_utf8(property.reply().ok()?.value).ok()
    }

    /// Puts the window into the upper left corner, as large as the screen, and gives it the keyboard: there is no window
    /// manager to do it.
    pub fn focus(&self) {
        let window = self.window().unwrap();
        let [width, height] = self.size_px.map(u32::from);
        let place = xproto::ConfigureWindowAux::new()
            .x(0)
            .y(0)
            .width(width)
            .height(height);
        self.connection.configure_window(window, &place).unwrap();
        self.connection
            .set_input_focus(InputFocus::POINTER_ROOT, window, x11rb::CURRENT_TIME)
            .unwrap();
        self.connection.flush().unwrap();
        self.rest();
        self.rest();
    }

    fn rest(&self) {
        self.connection.flush().unwrap();
        std::thread::sleep(REST);
    }

    fn fake(&self, kind: u8, detail: u8, at: Pos2) {
        let (x, y) = (at.x.round() as i16, at.y.round() as i16);
        self.connection
            .xtest_fake_input(kind, detail, x11rb::CURRENT_TIME, self.root, x, y, 0)
            .unwrap();
        self.rest();
    }

    pub fn move_to(&self, to: Pos2) {
        *self.at.borrow_mut() = to;
        self.fake(xproto::MOTION_NOTIFY_EVENT, 0, to);
        self.rest();
    }

    fn press(&self) {
        self.fake(xproto::BUTTON_PRESS_EVENT, 1, *self.at.borrow());
    }

    fn release(&self) {
        self.fake(xproto::BUTTON_RELEASE_EVENT, 1, *self.at.borrow());
    }

    pub fn click(&self, at: Pos2) {
        self.move_to(at);
        self.press();
        self.release();
        self.rest();
    }

    pub fn double_click(&self, at: Pos2) {
        self.move_to(at);
        for _ in 0..2 {
            // Without the rests: the second click must come soon.
            for kind in [xproto::BUTTON_PRESS_EVENT, xproto::BUTTON_RELEASE_EVENT] {
                let (x, y) = (at.x.round() as i16, at.y.round() as i16);
                self.connection
                    .xtest_fake_input(kind, 1, x11rb::CURRENT_TIME, self.root, x, y, 0)
                    .unwrap();
                self.connection.flush().unwrap();
                std::thread::sleep(Duration::from_millis(40));
            }
        }
        self.rest();
    }

    /// With the left button held, some steps between each two places.
    pub fn drag(&self, way: &[Pos2]) {
        self.move_to(way[0]);
        self.press();
        for pair in way.windows(2) {
            for step in 1..=6 {
                *self.at.borrow_mut() = pair[0].lerp(pair[1], step as f32 / 6.0);
                self.fake(xproto::MOTION_NOTIFY_EVENT, 0, *self.at.borrow());
            }
        }
        self.release();
        self.rest();
    }

    fn keycode(&self, name: &str) -> u8 {
        let keysym = match name {
            "Control_L" => 0xffe3,
            "Return" => 0xff0d,
            "Escape" => 0xff1b,
            // Latin letters, digits and stops are their own.
            letter => u32::from(letter.chars().next().unwrap()),
        };
        let (first, each, keysyms) = &self.keys;
        let at = keysyms
            .chunks(usize::from(*each))
            .position(|of_key| of_key.first() == Some(&keysym));
        first + at.unwrap_or_else(|| panic!("no key for {name:?}")) as u8
    }

    /// Pressed one after the other and let go in the opposite order.
    pub fn keys(&self, names: &[&str]) {
        let at = *self.at.borrow();
        for name in names {
            self.fake(xproto::KEY_PRESS_EVENT, self.keycode(name), at);
        }
        for name in names.iter().rev() {
            self.fake(xproto::KEY_RELEASE_EVENT, self.keycode(name), at);
        }
        self.rest();
    }

    pub fn type_text(&self, text: &str) {
        for letter in text.chars() {
            self.keys(&[&letter.to_string()]);
        }
    }

    /// All of it.
    pub fn screen(&self) -> Picture {
        let [width, height] = self.size_px.map(f32::from);
        self.screenshot(Rect::from_min_size(Pos2::ZERO, egui::vec2(width, height)))
    }

    pub fn screenshot(&self, part: Rect) -> Picture {
        let (x, y) = (part.min.x as i16, part.min.y as i16);
        let (width, height) = (part.width() as u16, part.height() as u16);
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, self.root, x, y, width, height, !0)
            .unwrap()
            .reply()
            .unwrap();
        // Blue, green, red and nothing.
        let rgb = image
            .data
            .chunks_exact(4)
            .map(|pixel| [pixel[2], pixel[1], pixel[0]])
            .collect();
        Picture {
            size_px: [width.into(), height.into()],
            rgb,
        }
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// What is on a part of the screen.
pub struct Picture {
    size_px: [u32; 2],
    rgb: Vec<[u8; 3]>,
}

impl Picture {
    pub fn pixels(&self) -> usize {
        self.rgb.len()
    }

    /// Pixels that differ by more than dither does.
    pub fn differing(&self, other: &Self) -> usize {
        let differs = |(a, b): &(&[u8; 3], &[u8; 3])| {
            std::iter::zip(a.iter(), b.iter()).any(|(a, b)| a.abs_diff(*b) > 8)
        };
        std::iter::zip(&self.rgb, &other.rgb)
            .filter(differs)
            .count()
    }

    pub fn brightest(&self) -> u8 {
        self.rgb.iter().flatten().copied().max().unwrap_or(0)
    }

    pub fn write(&self, path: &Path) {
        let [width, height] = self.size_px;
        let bytes = self.rgb.as_flattened().to_vec();
        let image = image::RgbImage::from_raw(width, height, bytes).unwrap();
        image.save(path).unwrap();
    }
}
