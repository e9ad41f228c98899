//! Writes to the device, counted by array and texture.

use wgpu::{TextureFormat, TextureUsages};

use crate::device::Gpu;
use crate::error::Error;

/// Bytes that an upload wrote to one of a scene's arrays or textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Written {
    /// Name of the array or texture.
    pub what: &'static str,
    /// Number of bytes that were written.
    pub bytes: u64,
}

/// One upload.
pub(crate) struct Transfer<'a> {
    pub gpu: &'a Gpu,
    written: Vec<Written>,
}

/// Position in a texture.
#[derive(Clone, Copy, Default)]
pub(crate) struct TexturePosition {
    pub level: u32,
    pub layer: u32,
    pub row: u32,
}

impl<'a> Transfer<'a> {
    pub(crate) fn new(gpu: &'a Gpu) -> Self {
        let written = Vec::new();
        Self { gpu, written }
    }

    /// Ends the transfer, and returns what was written.
    pub(crate) fn end(self) -> Vec<Written> {
        self.written
    }

    fn count(&mut self, what: &'static str, bytes: usize) {
        let bytes = bytes as u64;
        match self.written.iter_mut().find(|w| w.what == what) {
            Some(written) => written.bytes += bytes,
            None => self.written.push(Written { what, bytes }),
        }
    }

    pub(crate) fn write_buffer(
        &mut self,
        what: &'static str,
        buffer: &wgpu::Buffer,
        at: u64,
        bytes: &[u8],
    ) {
        self.gpu.queue.write_buffer(buffer, at, bytes);
        self.count(what, bytes.len());
    }

    /// A texture that is written once.
    pub(crate) async fn texture(
        &self,
        what: &str,
        [width, height]: [u32; 2],
        layers: u32,
        levels: u32,
        format: TextureFormat,
    ) -> Result<wgpu::Texture, Error> {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let descriptor = wgpu::TextureDescriptor {
            label: Some(what),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: layers,
            },
            mip_level_count: levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        };
        self.gpu.texture(what, &descriptor).await
    }

    pub(crate) fn write_texture(
        &mut self,
        what: &'static str,
        texture: &wgpu::Texture,
        place: TexturePosition,
        [width, height]: [u32; 2],
        texels: &[u8],
    ) {
        let destination = wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: place.level,
            origin: wgpu::Origin3d {
                x: 0,
                y: place.row,
                z: place.layer,
            },
            aspect: wgpu::TextureAspect::All,
        };
        let rows = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some((texels.len() / height as usize) as u32),
            rows_per_image: None,
        };
        let extent = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        self.gpu
            .queue
            .write_texture(destination, texels, rows, extent);
        self.count(what, texels.len());
    }
}
