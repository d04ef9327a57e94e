//! The light table on the device, with its memory.

use crate::EngineError;
use arealight::LightTable;
use arealight_host::{Host, Location};
use arealight_vk::{Context, Resource, TableFormat, TableImage};
use ash::vk;
use gpu_allocator::vulkan::Allocation;

/// A table image and the memory that it lies in.
pub struct UploadedTable {
    // Both are `Some` until dropped; the image goes before its memory
    image: Option<TableImage>,
    memory: Option<Allocation>,
    host: Host,
}

impl UploadedTable {
    pub fn new(
        host: &Host,
        context: &Context,
        table: &LightTable,
        format: TableFormat,
    ) -> Result<Self, EngineError> {
        // SAFETY: Dropped with this value, which holds the host and waits for its submissions.
        let mut image = unsafe { TableImage::new(context, table, format) }?;
        // SAFETY: Called once, with an allocator of the same device.
        let memory = host.with_allocator(|allocator| unsafe { image.allocate(allocator) })?;
        let uploaded = Self { image: Some(image), memory: Some(memory), host: host.clone() };

        let bytes = format.bytes(table);
        let staging = host.buffer(
            "light table, staged",
            bytes.len() as u64,
            vk::BufferUsageFlags::TRANSFER_SRC,
            Location::Upload,
        )?;
        staging.upload(&bytes)?;
        if let Some(image) = &uploaded.image {
            // SAFETY: The staging buffer holds the table's bytes and lives until the submission was waited for.
            host.submit(|commands| unsafe { image.record_upload(commands, staging.handle(), 0) })?;
        }
        Ok(uploaded)
    }

    pub fn resource(&self) -> Resource {
        let image = self.image.as_ref();
        image.map_or(
            Resource::SampledImage { view: vk::ImageView::null(), layout: vk::ImageLayout::UNDEFINED },
            TableImage::resource,
        )
    }
}

impl Drop for UploadedTable {
    fn drop(&mut self) {
        drop(self.image.take());
        if let Some(memory) = self.memory.take() {
            // Freeing fails only for a foreign allocation
            let _ = self.host.with_allocator(|allocator| allocator.free(memory));
        }
    }
}
