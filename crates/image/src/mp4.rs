//! MPEG-4 video, by the program ffmpeg of the machine: frames go to it as they are made. The file is whole or not there.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use tempfile::TempPath;

use crate::Error;
use crate::disk::resolve;
use crate::temporary;

const PROGRAM: &str = "ffmpeg";

/// A video in the making.
pub(crate) struct Mp4 {
    path: PathBuf,
    target: PathBuf,
    file: TempPath,
    program: Running,
}

/// The program. Dropping it ends it.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Mp4 {
    /// Whether the file name ends in .mp4, in either case.
    pub(crate) fn is_asked_by(path: &Path) -> bool {
        path.extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("mp4"))
    }

    /// Checks that the program is there.
    ///
    /// # Errors
    /// [`Error::CannotWrite`], with what would do instead.
    pub(crate) fn check(path: &Path) -> Result<(), Error> {
        encoder(path).map(drop)
    }

    /// Starts the program for frames of that size, so many in a second.
    ///
    /// # Errors
    /// [`Error::CannotWrite`].
    pub(crate) fn begin(path: &Path, [width, height]: [u32; 2], fps: u16) -> Result<Self, Error> {
        let encoder = encoder(path)?;
        let target = resolve(path)?;
        let file = temporary::open_beside(path, &target)?.into_temp_path();
        let (size, fps) = (format!("{width}x{height}"), fps.to_string());
        let mut command = Command::new(PROGRAM);
        command.args(["-hide_banner", "-loglevel", "error", "-y"]);
        command.args(["-f", "rawvideo", "-pix_fmt", "rgb24"]);
        command.args(["-video_size", &size, "-framerate", &fps, "-i", "-"]);
        // Players know halves of the colours' pixels alone, which takes even sides.
        let filters = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv";
        command.args(["-vf", filters, "-pix_fmt", "yuv420p"]);
        command.args(["-colorspace", "bt709", "-color_primaries", "bt709"]);
        command.args(["-color_trc", "iec61966-2-1"]);
        command.args(encoder);
        command.args(["-movflags", "+faststart", "-f", "mp4"]);
        let started = command
            .arg(&file)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn();
        let program = started.map_err(|error| Error::cannot_write(path, &error))?;
        Ok(Self {
            path: path.to_owned(),
            target,
            file,
            program: Running(program),
        })
    }

    /// Adds a frame: three codes a pixel.
    ///
    /// # Errors
    /// [`Error::CannotWrite`], in the words of the program.
    pub(crate) fn add(&mut self, codes: &[u8]) -> Result<(), Error> {
        let input = self.program.0.stdin.as_mut();
        match input.map_or(Ok(()), |input| input.write_all(codes)) {
            // It has ended before, and said why.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => {
                let words = self.last_words();
                Err(refused(&self.path, &words))
            }
            written => written.map_err(|error| Error::cannot_write(&self.path, &error)),
        }
    }

    /// Waits for the program, and moves the file to its place.
    ///
    /// # Errors
    /// [`Error::CannotWrite`], in the words of the program.
    pub(crate) fn finish(mut self) -> Result<(), Error> {
        drop(self.program.0.stdin.take());
        let words = self.last_words();
        let ended = self.program.0.wait();
        match ended {
            Ok(status) if status.success() => {
                let moved = self.file.persist(&self.target);
                moved.map_err(|error| Error::cannot_write(&self.path, &error.error))
            }
            Ok(_) => Err(refused(&self.path, &words)),
            Err(error) => Err(Error::cannot_write(&self.path, &error)),
        }
    }

    /// What the program says until it ends.
    fn last_words(&mut self) -> String {
        let output = self.program.0.stderr.take();
        let words = output.map(std::io::read_to_string);
        words.and_then(Result::ok).unwrap_or_default()
    }
}

/// Arguments of the program for the encoder that it has: H.264, else its own choice.
fn encoder(path: &Path) -> Result<&'static [&'static str], Error> {
    let mut command = Command::new(PROGRAM);
    let command = command.args(["-hide_banner", "-encoders"]);
    let listed = command.stdin(Stdio::null()).stderr(Stdio::null()).output();
    let listed = listed.map_err(|error| match error.kind() {
        ErrorKind::NotFound => Error::CannotWrite {
            path: path.to_owned(),
            reason: "an .mp4 is made by the program ffmpeg, which is not on PATH: install it, or end the name in .apng".to_owned(),
        },
        _ => Error::cannot_write(path, &error),
    })?;
    let encoders = String::from_utf8_lossy(&listed.stdout);
    Ok(match encoders.contains("libx264 ") {
        true => &["-c:v", "libx264", "-crf", "16"],
        false => &["-q:v", "3"],
    })
}

fn refused(path: &Path, words: &str) -> Error {
    let words = words.lines().last().unwrap_or("it ended without a word");
    Error::CannotWrite {
        path: path.to_owned(),
        reason: format!("ffmpeg: {}", words.trim()),
    }
}
