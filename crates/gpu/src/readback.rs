//! Reads a buffer on the device to bytes on the host, without blocking: the future is done once somebody has driven
//! the device that far (an event loop, or [`Gpu::block_on`](crate::device::Gpu::block_on)).

use std::future::poll_fn;
use std::ops::Range;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};
use std::task::{Poll, Waker};

use crate::device::Gpu;
use crate::error::Error;

/// A value that a callback brings later.
struct Arrival<T>(Arc<Mutex<(Option<T>, Option<Waker>)>>);

impl<T> Clone for Arrival<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T> Arrival<T> {
    fn new() -> Self {
        Self(Arc::new(Mutex::new((None, None))))
    }

    fn bring(&self, value: T) {
        let mut slot = self
            .0
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        slot.0 = Some(value);
        if let Some(waker) = slot.1.take() {
            waker.wake();
        }
    }

    /// Waits for the value, or for the loss of the device, after which it may never come.
    async fn wait(self, gpu: &Gpu) -> Result<T, Error> {
        poll_fn(|context| {
            // First, and not under the lock: it may run the callback.
            let state = gpu.check();
            let mut slot = self
                .0
                .lock()
                .unwrap_or_else(|poisoned| poisoned.into_inner());
            match (state, slot.0.take()) {
                (Err(error), _) => Poll::Ready(Err(error)),
                (Ok(()), Some(value)) => Poll::Ready(Ok(value)),
                (Ok(()), None) => {
                    slot.1 = Some(context.waker().clone());
                    Poll::Pending
                }
            }
        })
        .await
    }
}

impl Gpu {
    /// Number of times that the host has waited for bytes of this device.
    pub fn reads(&self) -> usize {
        self.reads.load(Ordering::Relaxed)
    }

    /// Waits until all that was submitted is done.
    pub async fn finished(&self) -> Result<(), Error> {
        let arrival = Arrival::new();
        let callback = arrival.clone();
        self.queue
            .on_submitted_work_done(move || callback.bring(()));
        arrival.wait(self).await?;
        self.check()
    }

    /// The bytes of `range` in `buffer`, which must have the usage `COPY_SRC`. Submits a copy.
    pub async fn read(&self, buffer: &wgpu::Buffer, range: Range<u64>) -> Result<Vec<u8>, Error> {
        self.read_parts(&[(buffer, range)]).await
    }

    /// As [`Self::read`], of several buffers, one part after the other.
    pub(crate) async fn read_parts(
        &self,
        parts: &[(&wgpu::Buffer, Range<u64>)],
    ) -> Result<Vec<u8>, Error> {
        let size = parts.iter().map(|(_, range)| range.end - range.start).sum();
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let staging = self.buffer("the copy of a result", size, usage).await?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut at = 0;
        for (buffer, Range { start, end }) in parts {
            encoder.copy_buffer_to_buffer(buffer, *start, &staging, at, end - start);
            at += end - start;
        }
        self.queue.submit([encoder.finish()]);
        self.map(&staging, |bytes| bytes.to_vec()).await
    }

    /// The texels of a texture of one layer, level 0, four bytes each, row by row. It must have the usage `COPY_SRC`.
    /// Submits a copy.
    pub(crate) async fn read_texture(&self, texture: &wgpu::Texture) -> Result<Vec<u8>, Error> {
        let extent = texture.size();
        let row_bytes = 4 * extent.width;
        // Rows of a copy begin at multiples of 256 bytes.
        let padded = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(padded) * u64::from(extent.height);
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let staging = self.buffer("the copy of a picture", size, usage).await?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let destination = wgpu::TexelCopyBufferInfo {
            buffer: &staging,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded),
                rows_per_image: None,
            },
        };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, extent);
        self.queue.submit([encoder.finish()]);
        let unpadded = |bytes: &[u8]| {
            let rows = bytes.chunks_exact(padded as usize);
            rows.flat_map(|row| &row[..row_bytes as usize])
                .copied()
                .collect()
        };
        self.map(&staging, unpadded).await
    }

    /// Maps a buffer with the usage `MAP_READ` once the submitted work is done, and returns the result of `take` on
    /// its bytes.
    async fn map(
        &self,
        staging: &wgpu::Buffer,
        take: impl Fn(&[u8]) -> Vec<u8>,
    ) -> Result<Vec<u8>, Error> {
        self.reads.fetch_add(1, Ordering::Relaxed);
        let arrival = Arrival::new();
        let callback = arrival.clone();
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            callback.bring(result)
        });
        let mapped = arrival.wait(self).await?;
        self.check()?;
        mapped.map_err(|error| Error::Lost {
            reason: error.to_string(),
        })?;
        let view = staging.get_mapped_range(..).map_err(|error| Error::Lost {
            reason: error.to_string(),
        })?;
        let bytes = take(&view);
        drop(view);
        staging.unmap();
        Ok(bytes)
    }
}
