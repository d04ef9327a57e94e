//! The light table on the device, with its memory.

use crate::EngineError;
use crate::host::Memory;
use crate::host::{Host, Location};
use crate::kept::Kept;
use arealight::LightTable;
use arealight_vk::{Context, Resource, TableFormat, TableImage};
use ash::vk;

/// A table image and the memory that it lies in.
pub struct UploadedTable {
    allocated: Kept<Allocated>,
}

/// Dropped in this order: the image goes before its memory is given back.
struct Allocated {
    image: TableImage,
    _memory: Memory,
}

impl UploadedTable {
    pub(crate) fn new(
        host: &Host,
        context: &Context,
        table: &LightTable,
        format: TableFormat,
    ) -> Result<Self, EngineError> {
        // SAFETY: Dropped with this value, which holds the host and waits for its submissions.
        let mut image = unsafe { TableImage::new(context, table, format) }?;
        // SAFETY: Called once, with an allocator of the same device.
        let allocation = host.with_allocator(|allocator| unsafe { image.allocate(allocator) })?;
        let memory = Memory::new(host, allocation);
        let uploaded = Self { allocated: Kept::new(host, Allocated { image, _memory: memory }) };

        let bytes = format.bytes(table);
        let staging = host.buffer(
            "light table, staged",
            bytes.len() as u64,
            vk::BufferUsageFlags::TRANSFER_SRC,
            Location::Upload,
        )?;
        staging.upload(&bytes)?;
        let image = &uploaded.allocated.image;
        // SAFETY: The staging buffer holds the table's bytes and lives until the submission was waited for.
        host.submit(|commands| unsafe { image.record_upload(commands, staging.handle(), 0) })?;
        Ok(uploaded)
    }

    /// The image, as a pass takes it.
    pub fn resource(&self) -> Resource {
        self.allocated.image.resource()
    }

    /// As an array image with a sampler: what is bound where no light has a texture.
    pub(crate) fn filtered(&self) -> Resource {
        let (view, layout) = (self.allocated.image.view(), TableImage::LAYOUT);
        Resource::FilteredImage { view, layout }
    }
}
