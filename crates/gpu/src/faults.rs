//! Errors of a device that no call returns.

use std::sync::{Arc, Mutex, OnceLock};

use crate::error::Error;

/// Errors that no scope caught, kept until they are taken. Without a handler the graphics library would panic.
#[derive(Clone, Default)]
pub(crate) struct Faults {
    first: Arc<Mutex<Option<Error>>>,
    /// Listener that is told at once when the device is lost.
    pub on_lost: Arc<OnceLock<LossListener>>,
}

pub(crate) type LossListener = Box<dyn Fn(&str) + Send + Sync>;

impl Faults {
    pub(crate) fn watch(&self, device: &wgpu::Device, adapter: &str) {
        let (faults, adapter) = (self.clone(), adapter.to_owned());
        device.on_uncaptured_error(Arc::new(move |error| {
            faults.record(match error {
                wgpu::Error::OutOfMemory { .. } => Error::OutOfMemory {
                    adapter: adapter.clone(),
                    what: "a command".to_owned(),
                    needed_bytes: 0,
                },
                wgpu::Error::Validation { description, .. }
                | wgpu::Error::Internal { description, .. } => Error::Validation { description },
            });
        }));
        let faults = self.clone();
        device.set_device_lost_callback(move |reason, message| {
            let reason = if message.is_empty() {
                format!("{reason:?}").to_lowercase()
            } else {
                message
            };
            if let Some(tell) = faults.on_lost.get() {
                tell(&reason);
            }
            faults.record(Error::Lost { reason });
        });
    }

    /// The first error is the cause, later ones follow from it; but a lost device explains everything.
    pub(crate) fn record(&self, error: Error) {
        let mut slot = self
            .first
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        if slot.is_none() || matches!(error, Error::Lost { .. }) {
            *slot = Some(error);
        }
    }

    pub(crate) fn take(&self) -> Result<(), Error> {
        let mut slot = self
            .first
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        let Some(error) = slot.take() else {
            return Ok(());
        };
        // A lost device stays lost.
        if matches!(error, Error::Lost { .. }) {
            *slot = Some(error.clone());
        }
        Err(error)
    }
}
