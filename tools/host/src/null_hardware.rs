//! The compiler of a real GPU on a machine that has none: Mesa's RADV with null hardware.
//!
//! With `RADV_FORCE_FAMILY` the driver offers a device of that family that compiles pipelines and runs
//! nothing: a submission to it crashes. [`Compiler`] makes compute pipelines on it and reads what
//! `VK_KHR_pipeline_executable_properties` says of them. The loader and the driver read the variables when
//! they start, so a process must be started with them ([`set_environment`]).

use crate::device::{Candidate, candidates, choose};
use crate::error::{HostError, NameCall as _};
use crate::instance::Instance;
use crate::listing::driver;
use crate::validation::Validation;
use ash::vk;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Whether a device of that name is null hardware.
pub fn is_null_hardware(device: &str) -> bool {
    device.contains("Null hardware")
}

/// The file by which the Vulkan loader finds RADV: one that `VK_DRIVER_FILES` or `VK_ICD_FILENAMES` names,
/// else one of the loader's folders, whatever those variables name. `None` where RADV is not installed.
pub fn driver_file() -> Option<PathBuf> {
    let named = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].into_iter().filter_map(std::env::var_os);
    let mut named = named.flat_map(|files| std::env::split_paths(&files).collect::<Vec<_>>());
    if let Some(file) = named.find(|file| is_radv(file) && file.is_file()) {
        return Some(file);
    }
    let data = std::env::var("XDG_DATA_DIRS").unwrap_or_else(|_| "/usr/local/share:/usr/share".to_owned());
    let folders =
        ["/etc"].into_iter().chain(data.split(':')).map(|folder| Path::new(folder).join("vulkan/icd.d"));
    let entries = folders.filter_map(|folder| std::fs::read_dir(folder).ok()).flatten();
    let mut files: Vec<PathBuf> =
        entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|file| is_radv(file)).collect();
    // Debian names the architecture in the file: the driver of this one comes first
    files.sort_by_key(|file| (!file.to_string_lossy().contains(std::env::consts::ARCH), file.clone()));
    files.into_iter().next()
}

fn is_radv(file: &Path) -> bool {
    file.file_name().is_some_and(|name| name.to_string_lossy().starts_with("radeon_icd"))
}

/// Lets a process see nothing but null hardware of `family` (`navi21`, `vega10`), by the driver that
/// [`driver_file`] found.
pub fn set_environment(command: &mut Command, driver: &Path, family: &str) {
    command
        .env("RADV_FORCE_FAMILY", family)
        .env("VK_DRIVER_FILES", driver)
        .env("VK_ICD_FILENAMES", driver)
        .env("MESA_SHADER_CACHE_DISABLE", "true")
        .env("MESA_GLSL_CACHE_DISABLE", "true");
    // What would change the driver's list of devices, or what its compiler makes
    for name in ["VK_ADD_DRIVER_FILES", "VK_INSTANCE_LAYERS", "RADV_DEBUG", "RADV_PERFTEST", "ACO_DEBUG"] {
        command.env_remove(name);
    }
}

/// A compute shader, as a pipeline is made of it.
#[derive(Debug, Clone)]
pub struct ComputeShader {
    /// SPIR-V with the entry point `main`.
    pub words: Vec<u32>,
    /// Pairs of specialisation constant id and value.
    pub specialization: Vec<(u32, u32)>,
    /// Kind and number of descriptors of each binding of set 0, in order. Combined image samplers have an
    /// immutable sampler: trilinear, clamped to the edge.
    pub bindings: Vec<(u32, vk::DescriptorType, u32)>,
    /// Size of the push constants in bytes.
    pub push_constant_size: u32,
}

/// What the compiler says of a shader. Nothing ran.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// Invocations a wave.
    pub subgroup_size: u32,
    /// Vector registers an invocation.
    pub vgprs: u64,
    /// Scalar registers a wave.
    pub sgprs: u64,
    /// Vector registers that did not fit and went to memory.
    pub spilled_vgprs: u64,
    /// Scalar registers that did not fit and went to lanes of vector registers.
    pub spilled_sgprs: u64,
    /// Memory of its own a wave, in bytes: spills, and arrays that are indexed dynamically.
    pub scratch: u64,
    /// How many waves a SIMD holds at a time.
    pub waves: u64,
    /// Instructions.
    pub instructions: u64,
    /// Branches among them.
    pub branches: u64,
    /// Machine code in bytes.
    pub code_size: u64,
    /// The compiler's estimate of the cycles from a wave's start to its end.
    pub latency: u64,
    /// The compiler's estimate of the cycles that a wave keeps a SIMD's units busy.
    pub inverse_throughput: u64,
    /// Processor time that making the pipeline took, in seconds; `None` where the system does not tell.
    pub seconds: Option<f64>,
}

/// What a driver says of a shader, in its own words.
#[derive(Debug, Clone, PartialEq)]
pub struct Said {
    /// Invocations a wave.
    pub subgroup_size: u32,
    /// Names with values, in the driver's order.
    pub numbers: Vec<(String, u64)>,
    /// Processor time that making the pipeline took, in seconds; `None` where the system does not tell.
    pub seconds: Option<f64>,
}

/// A device that compiles and is submitted nothing to: of null hardware, or any that gives statistics.
pub struct Compiler {
    executables: ash::khr::pipeline_executable_properties::Device,
    device: ash::Device,
    name: String,
    driver: String,
    /// Goes after the device.
    _instance: Instance,
}

impl Compiler {
    /// Opens the null hardware that [`set_environment`] lets this process see.
    ///
    /// # Errors
    /// [`HostError::NoNullHardware`] where there is none, [`HostError::MissingFeature`] where it gives no
    /// statistics.
    pub fn new() -> Result<Self, HostError> {
        let instance = Instance::new(Validation::Off)?;
        let found = candidates(&instance, vk::QueueFlags::COMPUTE, None)?;
        let names = found.iter().map(|one| one.name.clone()).collect();
        let Some(null) = found.into_iter().find(|one| is_null_hardware(&one.name)) else {
            return Err(HostError::NoNullHardware { found: names });
        };
        Self::of(instance, null)
    }

    /// Opens the device that is asked for as [`crate::HostOptions::device`] does.
    ///
    /// # Errors
    /// [`HostError::NoDevice`] and its like where there is none, [`HostError::MissingFeature`] where it gives
    /// no statistics.
    pub fn of_device(wanted: Option<&str>) -> Result<Self, HostError> {
        let instance = Instance::new(Validation::Off)?;
        let found = choose(candidates(&instance, vk::QueueFlags::COMPUTE, None)?, wanted)?;
        Self::of(instance, found)
    }

    fn of(instance: Instance, found: Candidate) -> Result<Self, HostError> {
        let extensions = [vk::KHR_PIPELINE_EXECUTABLE_PROPERTIES_NAME.as_ptr()];
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(found.queue_family)
            .queue_priorities(&[1.0])];
        let mut statistics = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
            .pipeline_executable_info(true);
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .push_next(&mut statistics);
        // SAFETY: What the info points to lives until the call returns, and the instance as long as the
        // device.
        let device = unsafe { instance.raw.create_device(found.physical_device, &info, None) };
        let device = device.map_err(|result| match result {
            vk::Result::ERROR_EXTENSION_NOT_PRESENT | vk::Result::ERROR_FEATURE_NOT_PRESENT => {
                HostError::MissingFeature("VK_KHR_pipeline_executable_properties")
            }
            result => HostError::Vulkan { call: "vkCreateDevice", result },
        })?;
        let executables = ash::khr::pipeline_executable_properties::Device::new(&instance.raw, &device);
        Ok(Self {
            executables,
            device,
            driver: driver(&instance, &found),
            name: found.name,
            _instance: instance,
        })
    }

    /// The device's name.
    pub fn device_name(&self) -> &str {
        &self.name
    }

    /// The driver's name and version.
    pub fn driver(&self) -> &str {
        &self.driver
    }

    /// Makes a pipeline of a shader, and reads what the compiler says of it.
    ///
    /// # Errors
    /// [`HostError::Vulkan`] where the pipeline cannot be made.
    pub fn said(&self, shader: &ComputeShader) -> Result<Said, HostError> {
        let mut made = Made::none(&self.device);
        made.make_layout(shader)?;
        let before = thread_seconds();
        made.make_pipeline(shader)?;
        let seconds = before.and_then(|before| Some(thread_seconds()? - before));

        let info = vk::PipelineInfoKHR::default().pipeline(made.pipeline);
        // SAFETY: The pipeline is of this device and alive.
        let properties = unsafe { self.executables.get_pipeline_executable_properties(&info) };
        let properties = properties.named("vkGetPipelineExecutablePropertiesKHR")?;
        let subgroup_size = properties.first().map_or(0, |one| one.subgroup_size);

        let info = vk::PipelineExecutableInfoKHR::default().pipeline(made.pipeline).executable_index(0);
        // SAFETY: Likewise, and it was made to be asked for its statistics; a compute pipeline has one
        // executable.
        let said = unsafe { self.executables.get_pipeline_executable_statistics(&info) };
        let said = said.named("vkGetPipelineExecutableStatisticsKHR")?;
        let name = |one: &vk::PipelineExecutableStatisticKHR<'_>| {
            one.name_as_c_str().unwrap_or_default().to_string_lossy().into_owned()
        };
        let numbers = said.iter().filter_map(|one| Some((name(one), value(one)?))).collect();
        Ok(Said { subgroup_size, numbers, seconds })
    }

    /// What RADV says of a shader.
    ///
    /// # Errors
    /// As [`Self::said`], and [`HostError::MissingStatistic`] where the driver does not say all of
    /// [`Statistics`].
    pub fn statistics(&self, shader: &ComputeShader) -> Result<Statistics, HostError> {
        let Said { subgroup_size, numbers, seconds } = self.said(shader)?;
        let number = |name: &'static str| {
            let one = numbers.iter().find(|(said, _)| said == name);
            one.map(|(_, value)| *value).ok_or(HostError::MissingStatistic(name))
        };
        Ok(Statistics {
            subgroup_size,
            vgprs: number("VGPRs")?,
            sgprs: number("SGPRs")?,
            spilled_vgprs: number("Spilled VGPRs")?,
            spilled_sgprs: number("Spilled SGPRs")?,
            scratch: number("Scratch size")?,
            waves: number("Subgroups per SIMD")?,
            instructions: number("Instructions")?,
            branches: number("Branches")?,
            code_size: number("Code size")?,
            latency: number("Latency")?,
            inverse_throughput: number("Inverse Throughput")?,
            seconds,
        })
    }
}

impl Drop for Compiler {
    fn drop(&mut self) {
        // SAFETY: Pipelines are gone with the call that made them, and nothing was submitted. The instance
        // goes after.
        unsafe { self.device.destroy_device(None) };
    }
}

impl std::fmt::Debug for Compiler {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Compiler").field("device", &self.name).finish_non_exhaustive()
    }
}

/// A statistic's value, where it is an integer.
fn value(statistic: &vk::PipelineExecutableStatisticKHR<'_>) -> Option<u64> {
    // SAFETY: The format says which field of the union the driver wrote; for both reads.
    unsafe {
        match statistic.format {
            vk::PipelineExecutableStatisticFormatKHR::UINT64 => Some(statistic.value.u64),
            vk::PipelineExecutableStatisticFormatKHR::INT64 => u64::try_from(statistic.value.i64).ok(),
            _ => None,
        }
    }
}

/// What is made of a shader; null handles are ignored when it is dropped.
struct Made<'a> {
    device: &'a ash::Device,
    sampler: vk::Sampler,
    set_layout: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    module: vk::ShaderModule,
    pipeline: vk::Pipeline,
}

impl<'a> Made<'a> {
    fn none(device: &'a ash::Device) -> Self {
        Self {
            device,
            sampler: vk::Sampler::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            module: vk::ShaderModule::null(),
            pipeline: vk::Pipeline::null(),
        }
    }

    fn make_layout(&mut self, shader: &ComputeShader) -> Result<(), HostError> {
        let info = arealight_vk::filtered_image_sampler();
        // SAFETY: The device is alive; so for every call of this function, whose infos outlive them.
        self.sampler = unsafe { self.device.create_sampler(&info, None) }.named("vkCreateSampler")?;

        let count = |&(_, _, count): &(u32, vk::DescriptorType, u32)| count as usize;
        let samplers = vec![self.sampler; shader.bindings.iter().map(count).max().unwrap_or(0)];
        let binding = |&(number, kind, count): &(u32, vk::DescriptorType, u32)| {
            let layout = vk::DescriptorSetLayoutBinding::default()
                .binding(number)
                .descriptor_type(kind)
                .descriptor_count(count)
                .stage_flags(vk::ShaderStageFlags::COMPUTE);
            match kind {
                vk::DescriptorType::COMBINED_IMAGE_SAMPLER => {
                    layout.immutable_samplers(&samplers[..count as usize])
                }
                _ => layout,
            }
        };
        let bindings: Vec<_> = shader.bindings.iter().map(binding).collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: as above.
        self.set_layout = unsafe { self.device.create_descriptor_set_layout(&info, None) }
            .named("vkCreateDescriptorSetLayout")?;

        let sets = [self.set_layout];
        let constants = [vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
            .size(shader.push_constant_size)];
        let info =
            vk::PipelineLayoutCreateInfo::default().set_layouts(&sets).push_constant_ranges(&constants);
        // SAFETY: as above.
        self.layout =
            unsafe { self.device.create_pipeline_layout(&info, None) }.named("vkCreatePipelineLayout")?;
        Ok(())
    }

    fn make_pipeline(&mut self, shader: &ComputeShader) -> Result<(), HostError> {
        let info = vk::ShaderModuleCreateInfo::default().code(&shader.words);
        // SAFETY: The device is alive, and the words are SPIR-V that tests validate.
        self.module =
            unsafe { self.device.create_shader_module(&info, None) }.named("vkCreateShaderModule")?;

        let values: Vec<u32> = shader.specialization.iter().map(|&(_, value)| value).collect();
        let entry = |(place, &(id, _)): (u32, &(u32, u32))| {
            vk::SpecializationMapEntry::default().constant_id(id).offset(place * 4).size(4)
        };
        let entries: Vec<_> = (0..).zip(&shader.specialization).map(entry).collect();
        let specialization =
            vk::SpecializationInfo::default().map_entries(&entries).data(bytemuck::cast_slice(&values));
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(self.module)
            .name(c"main")
            .specialization_info(&specialization);
        let info = vk::ComputePipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR | vk::PipelineCreateFlags::DISPATCH_BASE)
            .stage(stage)
            .layout(self.layout);
        // SAFETY: Module and layout are of this device and alive, and the infos outlive the call.
        let made = unsafe { self.device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None) };
        self.pipeline = made.map_err(|(_, result)| result).named("vkCreateComputePipelines")?[0];
        Ok(())
    }
}

impl Drop for Made<'_> {
    fn drop(&mut self) {
        // SAFETY: All is of this device, and nothing was recorded with it.
        unsafe {
            self.device.destroy_pipeline(self.pipeline, None);
            self.device.destroy_shader_module(self.module, None);
            self.device.destroy_pipeline_layout(self.layout, None);
            self.device.destroy_descriptor_set_layout(self.set_layout, None);
            self.device.destroy_sampler(self.sampler, None);
        }
    }
}

/// Processor time of this thread, in seconds; `None` where the system does not tell.
fn thread_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split(' ').next()?.parse::<u64>().ok()? as f64 * 1e-9)
}
