//! An X display without a screen: its server, mouse, keyboard and contents.

use std::cell::RefCell;
use std::io::{BufRead, BufReader, IoSlice};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use egui::{Pos2, Rect};
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    self, Atom, AtomEnum, ChangeWindowAttributesAux, ClientMessageEvent, ConnectionExt as _,
    EventMask, ImageFormat, InputFocus, Window,
};
use x11rb::rust_connection::RustConnection;

use crate::PATIENCE;

pub struct Display {
    server: Child,
    name: String,
    connection: RustConnection,
    root: Window,
    /// Opcode of XTEST, the extension for input by programs.
    xtest: u8,
    size_px: [u16; 2],
    /// Keysyms of each keycode from the first.
    keys: (u8, u8, Vec<u32>),
    at: RefCell<Pos2>,
}

impl Display {
    /// Starts a display; none where there is no Xvfb.
    pub fn start(size_px: [u16; 2]) -> Option<Self> {
        let [width, height] = size_px;
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0"])
            .arg(format!("{width}x{height}x24"))
            .args(["-nolisten", "tcp"])
            // A key held while a slow program draws is pressed once.
            .arg("-r")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        // The server prints its number when it is ready.
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
        let xtest = connection.query_extension(b"XTEST").unwrap();
        let xtest = xtest.reply().unwrap().major_opcode;
        // Answers to pings come to who watches the root.
        let watching = ChangeWindowAttributesAux::new().event_mask(EventMask::SUBSTRUCTURE_NOTIFY);
        connection
            .change_window_attributes(root, &watching)
            .unwrap();
        Some(Self {
            server,
            name,
            root,
            xtest,
            size_px,
            keys: (first, mapping.keysyms_per_keycode, mapping.keysyms),
            connection,
            at: RefCell::new(Pos2::ZERO),
        })
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub fn size_px(&self) -> [u16; 2] {
        self.size_px
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

    fn atom(&self, name: &str) -> Atom {
        let cookie = self.connection.intern_atom(false, name.as_bytes()).unwrap();
        cookie.reply().unwrap().atom
    }

    pub fn title(&self) -> Option<String> {
        let property = self
            .connection
            .get_property(
                false,
                self.window()?,
                self.atom("_NET_WM_NAME"),
                AtomEnum::ANY,
                0,
                1024,
            )
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
        self.rest();
    }

    /// Waits until the program has handled all events and has drawn their effect: a fixed time would be too short on some machine.
    /// The program answers a ping once it has handled the events before, then draws, so the next answer but one comes after a
    /// frame.
    fn rest(&self) {
        for _ in 0..3 {
            self.ping();
        }
    }

    /// Asks the program whether it is alive, as a window manager does. A program that has quit need not answer.
    fn ping(&self) {
        let Some(window) = self.window() else { return };
        let (protocols, ping) = (self.atom("WM_PROTOCOLS"), self.atom("_NET_WM_PING"));
        let message = ClientMessageEvent::new(32, window, protocols, [ping, 0, window, 0, 0]);
        self.connection
            .send_event(false, window, EventMask::NO_EVENT, message)
            .unwrap();
        self.connection.flush().unwrap();
        let start = Instant::now();
        loop {
            while let Some(event) = self.connection.poll_for_event().unwrap() {
                if matches!(event, Event::ClientMessage(answer) if answer.data.as_data32()[0] == ping)
                {
                    return;
                }
            }
            if self.window().is_none() {
                return;
            }
            assert!(start.elapsed() < PATIENCE, "the program does not answer");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    fn send(&self, kind: u8, detail: u8) {
        let at = *self.at.borrow();
        let (x, y) = (at.x.round() as i16, at.y.round() as i16);
        // XTEST's FakeInput, by hand: x11rb's own is a feature that the program has not, for which all of the window would be compiled
        // twice. Its length is in words; after the time (now) and the root come 8 bytes of padding.
        const FAKE_INPUT: u8 = 2;
        const WORDS: u16 = 9;
        let mut request = vec![self.xtest, FAKE_INPUT];
        request.extend(WORDS.to_ne_bytes());
        request.extend([kind, detail, 0, 0]);
        request.extend(x11rb::CURRENT_TIME.to_ne_bytes());
        request.extend(self.root.to_ne_bytes());
        request.extend([0; 8]);
        request.extend(x.to_ne_bytes());
        request.extend(y.to_ne_bytes());
        request.resize(4 * usize::from(WORDS), 0);
        self.connection
            .send_request_without_reply(&[IoSlice::new(&request)], Vec::new())
            .unwrap();
        self.connection.flush().unwrap();
    }

    pub fn move_to(&self, to: Pos2) {
        *self.at.borrow_mut() = to;
        self.send(xproto::MOTION_NOTIFY_EVENT, 0);
        self.rest();
    }

    /// Let go at once: a button that is held for long does not click.
    pub fn click(&self, at: Pos2) {
        self.move_to(at);
        self.send(xproto::BUTTON_PRESS_EVENT, 1);
        self.send(xproto::BUTTON_RELEASE_EVENT, 1);
        self.rest();
    }

    /// Presses the left button and holds it. This and the next two functions do not wait for the program.
    pub fn press(&self, at: Pos2) {
        self.hurry_to(at);
        self.send(xproto::BUTTON_PRESS_EVENT, 1);
    }

    /// Moves as a hand does, which does not wait for the program either.
    pub fn hurry_to(&self, to: Pos2) {
        *self.at.borrow_mut() = to;
        self.send(xproto::MOTION_NOTIFY_EVENT, 0);
    }

    /// Lets the left button go.
    pub fn release(&self) {
        self.send(xproto::BUTTON_RELEASE_EVENT, 1);
    }

    /// Drags with the left button held, with some steps between each two places.
    pub fn drag(&self, path: &[Pos2]) {
        self.move_to(path[0]);
        self.send(xproto::BUTTON_PRESS_EVENT, 1);
        self.rest();
        for pair in path.windows(2) {
            for step in 1..=3 {
                self.move_to(pair[0].lerp(pair[1], step as f32 / 3.0));
            }
        }
        self.send(xproto::BUTTON_RELEASE_EVENT, 1);
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

    /// Presses the keys one after the other, and releases them in the opposite order.
    pub fn keys(&self, names: &[&str]) {
        for name in names {
            self.send(xproto::KEY_PRESS_EVENT, self.keycode(name));
        }
        for name in names.iter().rev() {
            self.send(xproto::KEY_RELEASE_EVENT, self.keycode(name));
        }
        self.rest();
    }

    pub fn type_text(&self, text: &str) {
        for letter in text.chars() {
            self.keys(&[&letter.to_string()]);
        }
    }

    /// Picture of the whole screen.
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

/// Picture of a part of the screen.
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
