//! From the host's handles to a table on its device.

use crate::constants::{AREALIGHT_TABLE_RGBA16F, AREALIGHT_TABLE_RGBA32F};
use crate::failure::{ArealightResult, Failure, call};
use crate::options::specular_lobes_of;
use crate::types::{ArealightHost, ArealightMemory, ArealightTable, ArealightUpload};
use crate::{AREALIGHT_ABI_VERSION, arguments, handles, loader};
use arealight::LightTable;
use arealight::table::LobeHorizon;
use arealight_table::TableFile;
use arealight_vk::ash::vk::{self, Handle as _};
use arealight_vk::{Context, TableFormat, TableImage};
use std::ffi::c_void;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The library on a device of the host, with a light table.
pub struct Arealight {
    context: Context,
    format: TableFormat,
    table: LightTable,
    image: Mutex<Image>,
}

struct Image {
    table: TableImage,
    /// The memory that is bound, and where in it.
    memory: Option<(u64, u64)>,
}

impl Arealight {
    pub(crate) fn context(&self) -> &Context {
        &self.context
    }

    /// Nodes a side of the table.
    pub(crate) fn table_size(&self) -> u32 {
        self.table.size()
    }

    fn image(&self) -> MutexGuard<'_, Image> {
        // What a panic leaves behind is still the image
        self.image.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The table as a pass reads it; `None` before it has memory.
    pub(crate) fn table_resource(&self) -> Option<arealight_vk::Resource> {
        let image = self.image();
        image.memory.map(|_| image.table.resource())
    }
}

/// Makes the library's view of a device. `table` may be null: GGX in 32-bit floats. `*out` is the host's to
/// destroy.
///
/// # Safety
/// Pointers are null or valid. The host's handles are valid and belong together; they outlive what is made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_create(
    host: *const ArealightHost,
    table: *const ArealightTable,
    out: *mut *mut Arealight,
) -> ArealightResult {
    call(|| {
        // SAFETY: the caller vouches for the pointers, here and below.
        unsafe { arguments::write(out, std::ptr::null_mut(), "out") }?;
        // The version comes first in every version
        // SAFETY: as above.
        let version = *unsafe { arguments::read(host.cast::<u32>(), "host") }?;
        if version != AREALIGHT_ABI_VERSION {
            let message = format!(
                "host.abi_version: {version}, but this library has {AREALIGHT_ABI_VERSION}; compile the host \
                with the \
                 header that came with the library"
            );
            return Err(Failure::new(ArealightResult::ErrorAbiVersion, message));
        }
        // SAFETY: as above.
        let (host, (table, format)) = unsafe { (arguments::read(host, "host")?, read_table(table)?) };
        if host.api_version < vk::API_VERSION_1_1 {
            let message = format!(
                "host.api_version: {}.{}, but every kernel needs Vulkan 1.1: set \
                VkApplicationInfo.apiVersion",
                vk::api_version_major(host.api_version),
                vk::api_version_minor(host.api_version)
            );
            return Err(Failure::new(ArealightResult::ErrorMissingFeature, message));
        }

        // SAFETY: the caller vouches for the handles; the device outlives what is made.
        let arealight = unsafe {
            let (instance, device) = loader::load(host)?;
            let physical_device = vk::PhysicalDevice::from_raw(host.physical_device as u64);
            let context = Context::new(&instance, physical_device, &device)?
                .with_pipeline_cache(vk::PipelineCache::from_raw(host.pipeline_cache));
            let image = Image { table: TableImage::new(&context, &table, format)?, memory: None };
            Arealight { context, format, table, image: Mutex::new(image) }
        };
        // SAFETY: as above.
        unsafe { arguments::write(out, handles::give(arealight), "out") }
    })
}

/// # Safety
/// `table` is null or valid, with its bytes.
unsafe fn read_table(table: *const ArealightTable) -> Result<(LightTable, TableFormat), Failure> {
    if table.is_null() {
        return Ok((LightTable::ggx(), TableFormat::Rgba32Float));
    }
    // SAFETY: the same contract.
    let table = unsafe { arguments::read(table, "table") }?;
    arguments::refuse_reserved(table.reserved, "table.reserved")?;
    let format = match table.format {
        AREALIGHT_TABLE_RGBA32F => TableFormat::Rgba32Float,
        AREALIGHT_TABLE_RGBA16F => TableFormat::Rgba16Float,
        other => return Err(Failure::argument(format!("table.format: {other} is no AREALIGHT_TABLE_*"))),
    };
    if table.bytes.is_null() && table.size == 0 {
        return Ok((LightTable::ggx(), format));
    }
    // SAFETY: the same contract.
    let bytes = unsafe { arguments::array(table.bytes, table.size, "table.bytes") }?;
    let wrong = |error| Failure::new(ArealightResult::ErrorTable, format!("table.bytes: {error}"));
    Ok((TableFile::read(bytes).map_err(wrong)?.table, format))
}

/// What memory the table needs.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_table_memory(
    arealight: *const Arealight,
    out: *mut ArealightMemory,
) -> ArealightResult {
    call(|| {
        // SAFETY: the caller vouches for the pointers, here and below.
        let arealight = unsafe { handles::borrow(arealight, "arealight") }?;
        let needed = arealight.image().table.memory_requirements();
        let memory = ArealightMemory {
            size: needed.size,
            alignment: needed.alignment,
            staging_size: arealight.staging_size(),
            memory_type_bits: needed.memory_type_bits,
            reserved: 0,
        };
        // SAFETY: as above.
        unsafe { arguments::write(out, memory, "out") }
    })
}

impl Arealight {
    fn staging_size(&self) -> u64 {
        self.format.bytes(&self.table).len() as u64
    }
}

/// Binds memory to the table, once: `memory` is a VkDeviceMemory that has at `memory_offset` what
/// arealight_table_memory asks for, and is freed after arealight_destroy. From then on sets may be written.
/// Again with the same memory it is nothing.
///
/// # Safety
/// The pointer is null or valid, the memory is the host's, large enough, and nothing else uses that part of
/// it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_table_bind_memory(
    arealight: *mut Arealight,
    memory: u64,
    memory_offset: u64,
) -> ArealightResult {
    call(|| {
        // SAFETY: the caller vouches for the pointer.
        let arealight = unsafe { handles::borrow(arealight, "arealight")? };
        arguments::refuse_null([(memory == 0, "memory")])?;
        let mut image = arealight.image();
        let place = (memory, memory_offset);
        if image.memory.is_some_and(|bound| bound != place) {
            return Err(Failure::argument(
                "memory: the table has other memory already; make another arealight",
            ));
        }
        if image.memory.is_none() {
            // SAFETY: the caller vouches for the memory.
            unsafe { image.table.bind_memory(vk::DeviceMemory::from_raw(memory), memory_offset) }?;
            image.memory = Some(place);
        }
        Ok(())
    })
}

/// Writes the table's texels to the staging buffer, and records the copy, with its barriers. Needed once,
/// when the table has memory; the commands run before any that shade. Commands that were never run are made
/// good by another call.
///
/// # Safety
/// Pointers are null or valid, and `upload` is as ArealightUpload says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_table_upload(
    arealight: *mut Arealight,
    upload: *const ArealightUpload,
) -> ArealightResult {
    call(|| {
        // SAFETY: the caller vouches for the pointers.
        let (arealight, upload) =
            unsafe { (handles::borrow(arealight, "arealight")?, arguments::read(upload, "upload")?) };
        arguments::refuse_null([
            (upload.staging_data.is_null(), "upload.staging_data"),
            (upload.staging_buffer == 0, "upload.staging_buffer"),
            (upload.command_buffer.is_null(), "upload.command_buffer"),
        ])?;
        let bytes = arealight.format.bytes(&arealight.table);
        if upload.staging_size < bytes.len() as u64 {
            let message =
                format!("upload.staging_size: {}, but {} are needed", upload.staging_size, bytes.len());
            return Err(Failure::new(ArealightResult::ErrorTooSmall, message));
        }
        if upload.staging_offset % 16 != 0 {
            let message = format!("upload.staging_offset: {} is no multiple of 16", upload.staging_offset);
            return Err(Failure::argument(message));
        }
        let image = arealight.image();
        if image.memory.is_none() {
            return Err(Failure::argument(
                "arealight: its table has no memory yet; call arealight_table_bind_memory first",
            ));
        }

        // SAFETY: the caller vouches for buffer and command buffer; the mapped memory is large enough.
        unsafe {
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), upload.staging_data.cast(), bytes.len());
            image.table.record_upload(
                vk::CommandBuffer::from_raw(upload.command_buffer as u64),
                vk::Buffer::from_raw(upload.staging_buffer),
                upload.staging_offset,
            );
        }
        Ok(())
    })
}

/// How dense, a steradian, the table's lobes are at most on surfaces of at least this perceptual roughness:
/// for arealight_light_reach. Ask once.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_lobe_density(
    arealight: *const Arealight,
    specular_lobes: u32,
    roughness: f64,
    out: *mut f64,
) -> ArealightResult {
    call(|| {
        // SAFETY: the caller vouches for the pointers, here and below.
        let arealight = unsafe { handles::borrow(arealight, "arealight") }?;
        let specular_lobes = specular_lobes_of(specular_lobes, "specular_lobes")?;
        if !(0.0..=1.0).contains(&roughness) {
            return Err(Failure::argument(format!("roughness: {roughness} must be from 0 to 1")));
        }
        let density = arealight.table.lobe_density(specular_lobes, roughness);
        // SAFETY: as above.
        unsafe { arguments::write(out, density, "out") }
    })
}

/// Writes where the horizons of the table's lobes are, for passes with tiles:
/// ArealightResources.lobe_horizons, which is uploaded once. `specular_lobes`: what the passes are made with,
/// one of AREALIGHT_SPECULAR_LOBES_*. `*size` comes in as the bytes at `data`, and goes out as the bytes that
/// are needed; null for `data` asks for them alone.
///
/// # Safety
/// Pointers are null or valid, with as many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_lobe_horizons(
    arealight: *const Arealight,
    specular_lobes: u32,
    data: *mut c_void,
    size: *mut u64,
) -> ArealightResult {
    call(|| {
        // SAFETY: the caller vouches for the pointers, here and below.
        let (arealight, given) = unsafe {
            (handles::borrow(arealight, "arealight")?, *arguments::read(size.cast_const(), "size")?)
        };
        let specular_lobes = specular_lobes_of(specular_lobes, "specular_lobes")?;
        let cells = u64::from(arealight.table.size() - 1).pow(2);
        let needed = cells * size_of::<LobeHorizon>() as u64;
        // SAFETY: as above.
        unsafe { arguments::write(size, needed, "size") }?;
        if data.is_null() {
            return Ok(());
        }
        if given < needed {
            let message = format!("size: {given}, but {needed} are needed");
            return Err(Failure::new(ArealightResult::ErrorTooSmall, message));
        }
        let horizons = arealight.table.lobe_horizons(specular_lobes);
        let bytes: &[u8] = bytemuck::cast_slice(&horizons);
        // SAFETY: as above, and there are as many bytes.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), data.cast(), bytes.len()) };
        Ok(())
    })
}

/// Destroys the library's view of a device, and the table's image. Passes live on, but cannot be given new
/// sets. Null is nothing.
///
/// # Safety
/// No commands that shade are pending, the device is alive, and no other thread uses the object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_destroy(arealight: *mut Arealight) -> ArealightResult {
    // SAFETY: the same contract.
    call(|| unsafe { handles::take(arealight, "arealight") }.map(drop))
}
