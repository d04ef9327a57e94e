//! The compiler of a real GPU on a machine that has none.
//!
//! A driver that [`crate::families`] names offers a device that compiles pipelines and runs nothing: a
//! submission to it crashes, or is lost. [`Compiler`] makes compute pipelines on it and reads what
//! `VK_KHR_pipeline_executable_properties` says of them. The loader and the driver read their variables when
//! they start, so a process must be started with them ([`Driver::set_environment`]).
//!
//! [`Driver::set_environment`]: crate::families::Driver::set_environment

use crate::device::{Candidate, candidates, choose};
use crate::error::{HostError, NameCall as _};
use crate::instance::Instance;
use crate::listing::driver;
use crate::validation::Validation;
use ash::vk;
use std::collections::BTreeMap;

/// Whether a device of that name is RADV's null hardware.
pub fn is_null_hardware(device: &str) -> bool {
    device.contains("Null hardware")
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

/// What a driver says of a shader, in its own words.
#[derive(Debug, Clone, PartialEq)]
pub struct Said {
    /// Invocations a wave.
    pub subgroup_size: u32,
    /// Values by the driver's names.
    pub numbers: BTreeMap<String, u64>,
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
    /// Opens the device that the process's environment lets it see, of a [`Driver::chip`].
    ///
    /// [`Driver::chip`]: crate::families::Driver::chip
    ///
    /// # Errors
    /// [`HostError::NoDevice`] where there is none, [`HostError::MissingFeature`] where it gives no
    /// statistics.
    pub fn of_chip(chip: &str) -> Result<Self, HostError> {
        let instance = Instance::new(Validation::Off)?;
        let all = candidates(&instance, vk::QueueFlags::COMPUTE, None)?;
        let found = all.iter().map(|one| one.name.clone()).collect();
        let of_chip = all.into_iter().find(|one| one.name.to_lowercase().contains(chip));
        Self::of(instance, of_chip.ok_or(HostError::NoDevice { found })?)
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
