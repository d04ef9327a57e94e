//! From the host's handles to a table on its device.

use crate::failure::{ArealightResult, Failure, call};
use crate::lights::{check_size, copy, fill};
use crate::options::{level, specular_lobes_of};
use crate::types::{ArealightHost, ArealightMemory, ArealightTable, ArealightUpload};
use crate::{AREALIGHT_ABI_VERSION, arguments, handles, loader};
use arealight::LightTable;
use arealight_table::TableFile;
use arealight_vk::ash::vk::{self, Handle as _};
use arealight_vk::{Context, Resource, TableFormat, TableImage, ash};
use std::ffi::c_void;
use std::sync::{Mutex, MutexGuard};

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
        handles::lock(&self.image)
    }

    /// The table as a pass reads it; an error before it has memory.
    pub(crate) fn table_resource(&self) -> Result<Resource, Failure> {
        Ok(self.image().with_memory()?.resource())
    }
}

impl Image {
    fn with_memory(&self) -> Result<&TableImage, Failure> {
        self.memory.map(|_| &self.table).ok_or_else(|| {
            Failure::argument(
                "arealight: its table has no memory yet; call arealight_table_bind_memory first",
            )
        })
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
    // SAFETY: the caller vouches for pointers and handles; the device outlives what is made.
    call(|| unsafe {
        arguments::write(out, std::ptr::null_mut(), "out")?;
        let (host, (table, format)) = (read_host(host)?, read_table(table)?);
        let (.., context) = open(host)?;
        let image = Image { table: TableImage::new(&context, &table, format)?, memory: None };
        let arealight = Arealight { context, format, table, image: Mutex::new(image) };
        arguments::write(out, handles::give(arealight), "out")
    })
}

/// A host of this version.
///
/// # Safety
/// `host` is null or valid.
pub(crate) unsafe fn read_host<'a>(host: *const ArealightHost) -> Result<&'a ArealightHost, Failure> {
    // The version comes first in every version
    // SAFETY: the same contract, here and below.
    let version = *unsafe { arguments::read(host.cast::<u32>(), "host") }?;
    if version != AREALIGHT_ABI_VERSION {
        let message = format!(
            "host.abi_version: {version}, but this library has {AREALIGHT_ABI_VERSION}; compile the host \
             with the header that came with the library"
        );
        return Err(Failure::new(ArealightResult::ErrorAbiVersion, message));
    }
    // SAFETY: as above.
    let host = unsafe { arguments::read(host, "host") }?;
    if host.api_version < vk::API_VERSION_1_1 {
        let message = format!(
            "host.api_version: {}.{}, but every kernel needs Vulkan 1.1: set VkApplicationInfo.apiVersion",
            vk::api_version_major(host.api_version),
            vk::api_version_minor(host.api_version)
        );
        return Err(Failure::new(ArealightResult::ErrorMissingFeature, message));
    }
    Ok(host)
}

/// The host's device, with the functions of both.
///
/// # Safety
/// The handles are valid and belong together; the device outlives what is made.
pub(crate) unsafe fn open(
    host: &ArealightHost,
) -> Result<(ash::Instance, vk::PhysicalDevice, ash::Device, Context), Failure> {
    // SAFETY: the same contract.
    unsafe {
        let (instance, device) = loader::load(host)?;
        let physical_device = vk::PhysicalDevice::from_raw(host.physical_device as u64);
        let context = Context::new(&instance, physical_device, &device)?
            .with_pipeline_cache(vk::PipelineCache::from_raw(host.pipeline_cache));
        Ok((instance, physical_device, device, context))
    }
}

/// # Safety
/// `table` is null or valid, with its bytes.
pub(crate) unsafe fn read_table(table: *const ArealightTable) -> Result<(LightTable, TableFormat), Failure> {
    if table.is_null() {
        return Ok((LightTable::ggx(), TableFormat::Rgba32Float));
    }
    // SAFETY: the same contract.
    let table = unsafe { arguments::read(table, "table") }?;
    arguments::refuse_reserved(table.reserved, "table.reserved")?;
    let format = level(table.format, &[TableFormat::Rgba32Float, TableFormat::Rgba16Float], "table.format")?;
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
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let arealight = handles::borrow(arealight, "arealight")?;
        let staging_size = arealight.format.bytes(&arealight.table).len() as u64;
        let needed = arealight.image().table.memory_requirements();
        arguments::write(out, memory_of(needed, staging_size), "out")
    })
}

/// What an image's memory is to be.
pub(crate) fn memory_of(needed: vk::MemoryRequirements, staging_size: u64) -> ArealightMemory {
    let vk::MemoryRequirements { size, alignment, memory_type_bits } = needed;
    ArealightMemory { size, alignment, staging_size, memory_type_bits, reserved: 0 }
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
    // SAFETY: the caller vouches for the pointer and the memory.
    call(|| unsafe {
        let arealight = handles::borrow(arealight, "arealight")?;
        arguments::refuse_null([(memory == 0, "memory")])?;
        let mut image = arealight.image();
        let place = (memory, memory_offset);
        if image.memory.is_some_and(|bound| bound != place) {
            return Err(Failure::argument(
                "memory: the table has other memory already; make another arealight",
            ));
        }
        if image.memory.is_none() {
            image.table.bind_memory(vk::DeviceMemory::from_raw(memory), memory_offset)?;
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
    // SAFETY: the caller vouches for the pointers, buffer and command buffer.
    call(|| unsafe {
        let arealight = handles::borrow(arealight, "arealight")?;
        let upload = arguments::read(upload, "upload")?;
        arguments::refuse_null([
            (upload.staging_data.is_null(), "upload.staging_data"),
            (upload.staging_buffer == 0, "upload.staging_buffer"),
            (upload.command_buffer.is_null(), "upload.command_buffer"),
        ])?;
        let bytes = arealight.format.bytes(&arealight.table);
        check_size(&bytes, upload.staging_size, "upload.staging_size")?;
        if upload.staging_offset % 16 != 0 {
            let message = format!("upload.staging_offset: {} is no multiple of 16", upload.staging_offset);
            return Err(Failure::argument(message));
        }
        let image = arealight.image();
        let table = image.with_memory()?;
        copy(&bytes, upload.staging_data);
        let commands = vk::CommandBuffer::from_raw(upload.command_buffer as u64);
        let staging = vk::Buffer::from_raw(upload.staging_buffer);
        table.record_upload(commands, staging, upload.staging_offset);
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
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let arealight = handles::borrow(arealight, "arealight")?;
        let specular_lobes = specular_lobes_of(specular_lobes, "specular_lobes")?;
        if !(0.0..=1.0).contains(&roughness) {
            return Err(Failure::argument(format!("roughness: {roughness} must be from 0 to 1")));
        }
        arguments::write(out, arealight.table.lobe_density(specular_lobes, roughness), "out")
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
    // SAFETY: the caller vouches for the pointers; what is copied has room.
    call(|| unsafe {
        let arealight = handles::borrow(arealight, "arealight")?;
        let given = *arguments::read(size.cast_const(), "size")?;
        let specular_lobes = specular_lobes_of(specular_lobes, "specular_lobes")?;
        let horizons = arealight.table.lobe_horizons(specular_lobes);
        let bytes = bytemuck::cast_slice(&horizons);
        arguments::write(size, bytes.len() as u64, "size")?;
        fill([(data, given, bytes, "size")])
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
