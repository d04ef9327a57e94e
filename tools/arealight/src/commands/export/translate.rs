//! From frozen SPIR-V to the languages of other interfaces, by naga.

use naga::back::{hlsl, msl, wgsl};
use naga::compact::{KeepUnused, compact};
use naga::front::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, Module, ResourceBinding, ShaderStage, TypeInner};

/// The interface that a kernel is translated for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Language {
    /// WGSL, for browsers, wgpu and Dawn
    Webgpu,
    /// HLSL of shader model 6.0, for Direct3D 12
    Hlsl,
    /// MSL 2.0, for Metal
    Msl,
}

impl Language {
    /// Its folder in an export.
    pub fn folder(self) -> &'static str {
        match self {
            Self::Webgpu => "webgpu",
            Self::Hlsl => "hlsl",
            Self::Msl => "msl",
        }
    }

    /// What its files end in.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Webgpu => "wgsl",
            Self::Hlsl => "hlsl",
            Self::Msl => "metal",
        }
    }
}

impl std::fmt::Display for Language {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Webgpu => "WGSL",
            Self::Hlsl => "HLSL of shader model 6.0",
            Self::Msl => "MSL 2.0",
        })
    }
}

/// A kernel in another language.
pub struct Translated {
    pub text: String,
    /// Its function's name there.
    pub entry_point: String,
    /// What it binds, and how that is laid out.
    pub module: Module,
    /// Where, in a language that counts buffers, textures and samplers apart.
    pub slots: Vec<Slot>,
}

/// A resource's place in Metal's tables of arguments.
pub struct Slot {
    pub of: Option<ResourceBinding>,
    pub table: &'static str,
    pub index: u8,
}

/// Translates a module without specialisation constants. The error says what naga refuses.
pub fn translate(spirv: &[u32], language: Language) -> Result<Translated, String> {
    // Read, leave out what nothing uses, and check
    let options = spv::Options { adjust_coordinate_space: false, ..spv::Options::default() };
    let mut module = spv::Frontend::new(spirv.iter().copied(), &options)
        .parse()
        .map_err(|error| format!("naga cannot read the kernel: {error}"))?;
    compact(&mut module, KeepUnused::No);
    // glslang's names of functions have the types of their parameters, spelled out
    for (_, function) in module.functions.iter_mut() {
        if let Some(name) = &mut function.name {
            name.truncate(name.find('(').unwrap_or(name.len()));
        }
    }
    let info = validate(&module)?;

    // Write
    let (text, entry_point, slots) = match language {
        Language::Webgpu => (to_wgsl(&module, &info)?, String::from("main"), vec![]),
        Language::Hlsl => {
            let (text, entry_point) = to_hlsl(&module, &info)?;
            (text, entry_point, vec![])
        }
        Language::Msl => to_msl(&module, &info)?,
    };
    Ok(Translated { text, entry_point, module, slots })
}

/// Checks a module by WebGPU's rules, without an optional feature.
fn validate(module: &Module) -> Result<ModuleInfo, String> {
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(module)
        .map_err(|error| format!("naga does not accept the kernel: {}", error.emit_to_string("")))
}

fn to_wgsl(module: &Module, info: &ModuleInfo) -> Result<String, String> {
    wgsl::write_string(module, info, wgsl::WriterFlags::empty())
        .map_err(|error| format!("naga cannot write WGSL: {error}"))
}

fn to_hlsl(module: &Module, info: &ModuleInfo) -> Result<(String, String), String> {
    // Every loop ends, and no index is out of bounds, as on Vulkan: nothing guards them
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V6_0,
        restrict_indexing: false,
        force_loop_bounding: false,
        ..hlsl::Options::default()
    };
    let pipeline = hlsl::PipelineOptions::default();
    let mut text = String::new();
    let reflection = hlsl::Writer::new(&mut text, &options, &pipeline)
        .write(module, info, None)
        .map_err(|error| format!("naga cannot write HLSL: {error}"))?;
    let name = reflection.entry_point_names.into_iter().next();
    let name = name
        .ok_or("the kernel has no entry point")?
        .map_err(|error| format!("naga cannot write HLSL: {error}"))?;
    Ok((text, name))
}

fn to_msl(module: &Module, info: &ModuleInfo) -> Result<(String, String, Vec<Slot>), String> {
    let (resources, slots) = metal_slots(module);
    let unchecked = BoundsCheckPolicy::Unchecked;
    let options = msl::Options {
        lang_version: (2, 0),
        per_entry_point_map: [("main".to_owned(), resources)].into(),
        fake_missing_bindings: false,
        bounds_check_policies: BoundsCheckPolicies {
            index: unchecked,
            buffer: unchecked,
            image_load: unchecked,
            binding_array: unchecked,
        },
        force_loop_bounding: false,
        ..msl::Options::default()
    };
    let pipeline = msl::PipelineOptions {
        entry_point: Some((ShaderStage::Compute, "main".into())),
        ..Default::default()
    };
    let fault = |error: &dyn std::fmt::Display| format!("naga cannot write MSL: {error}");
    let (text, translation) =
        msl::write_string(module, info, &options, &pipeline).map_err(|error| fault(&error))?;
    let name = translation.entry_point_names.into_iter().next();
    let name = name.ok_or("the kernel has no entry point")?.map_err(|error| fault(&error))?;
    Ok((text, name, slots))
}

/// Numbers buffers, textures and samplers apart, each in the order of bindings. naga wants a buffer more: the
/// sizes of arrays.
fn metal_slots(module: &Module) -> (msl::EntryPointResources, Vec<Slot>) {
    let (mut resources, mut slots) = (msl::EntryPointResources::default(), vec![]);
    let [mut buffers, mut textures, mut samplers] = [0u8; 3];
    for (binding, variable) in globals(module) {
        let mut target = msl::BindTarget::default();
        let (table, counter) = match module.types[variable.ty].inner {
            TypeInner::Image { .. } => ("texture", &mut textures),
            TypeInner::Sampler { .. } => ("sampler", &mut samplers),
            _ => ("buffer", &mut buffers),
        };
        let index = *counter;
        *counter += 1;
        match table {
            "texture" => target.texture = Some(index),
            "sampler" => target.sampler = Some(msl::BindSamplerTarget::Resource(index)),
            _ => target.buffer = Some(index),
        }
        target.mutable = is_written(module, variable);
        resources.resources.insert(binding, target);
        slots.push(Slot { of: Some(binding), table, index });
    }
    resources.sizes_buffer = Some(buffers);
    slots.push(Slot { of: None, table: "buffer", index: buffers });
    (resources, slots)
}

/// What a kernel binds, in order.
pub fn globals(module: &Module) -> Vec<(ResourceBinding, &naga::GlobalVariable)> {
    let variables = module.global_variables.iter();
    let mut globals: Vec<_> =
        variables.filter_map(|(_, variable)| Some((variable.binding?, variable))).collect();
    globals.sort_by_key(|(binding, _)| (binding.group, binding.binding));
    globals
}

/// Whether the kernel writes to a resource.
pub fn is_written(module: &Module, variable: &naga::GlobalVariable) -> bool {
    let access = match (&module.types[variable.ty].inner, variable.space) {
        (TypeInner::Image { class: naga::ImageClass::Storage { access, .. }, .. }, _) => *access,
        (_, AddressSpace::Storage { access }) => access,
        _ => return false,
    };
    access.contains(naga::StorageAccess::STORE)
}
