//! Failures of a command, and the exit codes for the caller.

use std::fmt;
use std::process::ExitCode;

use anyhow::anyhow;

/// The two ways to fail, by who can help.
#[derive(Debug)]
pub enum Failure {
    /// The command line or the scene is wrong: the same command will fail again.
    Input(anyhow::Error),
    /// The work failed: no room, no permission, no device.
    Work(anyhow::Error),
}

impl Failure {
    /// 2 for wrong input, as clap does for a wrong command line; else 1.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Work(_) => ExitCode::from(1),
            Self::Input(_) => ExitCode::from(2),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Input(error) | Self::Work(error)) = self;
        write!(out, "{error:#}")
    }
}

impl From<hairline_document::Error> for Failure {
    fn from(error: hairline_document::Error) -> Self {
        Self::Input(error.into())
    }
}

impl From<hairline_gpu::Error> for Failure {
    fn from(error: hairline_gpu::Error) -> Self {
        Self::Work(anyhow!("{error}; --backend cpu needs no driver"))
    }
}

impl From<crate::Error> for Failure {
    fn from(error: crate::Error) -> Self {
        match error {
            crate::Error::Device(error) => error.into(),
            crate::Error::Picture(error) | crate::Error::Animation(error) => error.into(),
        }
    }
}

impl From<hairline_image::Error> for Failure {
    fn from(error: hairline_image::Error) -> Self {
        match error {
            hairline_image::Error::UnknownEnding { .. }
            | hairline_image::Error::NoAnimation { .. }
            | hairline_image::Error::NoSequence { .. } => Self::Input(error.into()),
            _ => Self::Work(error.into()),
        }
    }
}
