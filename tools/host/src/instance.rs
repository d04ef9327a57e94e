//! The Vulkan instance, with validation where it is asked for.

use crate::error::{HostError, NameCall as _};
use crate::validation::{LAYER, MessageLog, Switch, Validation};
use ash::vk;
use std::ffi::CStr;
use std::sync::Arc;

/// An instance that destroys itself, its messenger and what the messenger said.
pub(crate) struct Instance {
    pub(crate) raw: ash::Instance,
    pub(crate) messages: Arc<MessageLog>,
    messenger: Option<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// Keeps the loader's library open.
    pub(crate) entry: ash::Entry,
}

impl Instance {
    /// For applications of the loader's version of Vulkan, from 1.1 to 1.3.
    pub(crate) fn new(validation: Validation) -> Result<Self, HostError> {
        Self::with(vk::API_VERSION_1_3, validation, &[])
    }

    /// The same up to `newest`, with extensions of a window's: nothing that came later may be used, and the
    /// validation layer says so.
    pub(crate) fn with(newest: u32, validation: Validation, of_window: &[&CStr]) -> Result<Self, HostError> {
        // SAFETY: The loader's library has initialisers that are safe to run.
        let entry = unsafe { ash::Entry::load() }.map_err(HostError::LoaderMissing)?;
        let api_version = application_version(&entry, newest)?;
        let application = vk::ApplicationInfo::default()
            .application_name(c"arealight")
            .engine_name(c"arealight")
            .api_version(api_version);

        // Ask for what the loader offers of what is useful
        let offered = extensions_of(&entry, None)?;
        let mut extensions = of_window.to_vec();
        let mut flags = vk::InstanceCreateFlags::empty();
        if offered.contains(&vk::KHR_PORTABILITY_ENUMERATION_NAME) {
            extensions.push(vk::KHR_PORTABILITY_ENUMERATION_NAME);
            flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
        }

        // Load the validation layer and choose how to tell it what to look at
        let mut layers = vec![];
        let mut switch = Switch::Default;
        if validation != Validation::Off {
            if !has_validation_layer(&entry)? {
                return Err(HostError::ValidationLayerMissing);
            }
            switch = Switch::choose(validation, &extensions_of(&entry, Some(LAYER))?)?;
            layers.push(LAYER.as_ptr());
            extensions.push(vk::EXT_DEBUG_UTILS_NAME);
            extensions.extend(switch.extension());
        }

        // Chain the messenger, so that it hears about the instance itself too
        let messages = Arc::new(MessageLog::default());
        let mut messenger_info = messages.messenger();
        let mut features =
            vk::ValidationFeaturesEXT::default().enabled_validation_features(validation.features());
        let on = vk::TRUE;
        let settings: Vec<_> = validation.setting().iter().map(|name| switched_on(name, &on)).collect();
        let mut settings = vk::LayerSettingsCreateInfoEXT::default().settings(&settings);
        let extension_names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
        let mut info = vk::InstanceCreateInfo::default()
            .flags(flags)
            .application_info(&application)
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extension_names);
        if validation != Validation::Off {
            info = info.push_next(&mut messenger_info);
        }
        info = match switch {
            Switch::Default => info,
            Switch::Features => info.push_next(&mut features),
            Switch::Settings => info.push_next(&mut settings),
        };

        // SAFETY: What the info points to lives until the call returns, and the log until the instance is
        // gone.
        let raw = match unsafe { entry.create_instance(&info, None) } {
            // A loader without any driver says this.
            Err(vk::Result::ERROR_INCOMPATIBLE_DRIVER) => return Err(HostError::NoDevice { found: vec![] }),
            created => created.named("vkCreateInstance")?,
        };
        let mut instance = Self { raw, messages, messenger: None, entry };
        if validation != Validation::Off {
            instance.listen()?;
        }
        Ok(instance)
    }

    /// Makes the messenger for the life of the instance.
    fn listen(&mut self) -> Result<(), HostError> {
        let functions = ash::ext::debug_utils::Instance::new(&self.entry, &self.raw);
        // SAFETY: The extension is enabled, and the log outlives the messenger (see Drop).
        let messenger = unsafe { functions.create_debug_utils_messenger(&self.messages.messenger(), None) };
        self.messenger = Some((functions, messenger.named("vkCreateDebugUtilsMessengerEXT")?));
        Ok(())
    }

    /// Every device that the drivers offer, in their order.
    pub(crate) fn physical_devices(&self) -> Result<Vec<vk::PhysicalDevice>, HostError> {
        // SAFETY: The instance is alive.
        let found = unsafe { self.raw.enumerate_physical_devices() };
        match found {
            // A loader without any driver says this.
            Err(vk::Result::ERROR_INITIALIZATION_FAILED | vk::Result::ERROR_INCOMPATIBLE_DRIVER) => {
                Ok(vec![])
            }
            found => found.named("vkEnumeratePhysicalDevices"),
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: Whoever made a device of this instance holds it, so none is left; the log is a field and
        // thus outlives both calls.
        unsafe {
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

/// The version to ask for: the loader's, from 1.1 to `newest`.
fn application_version(entry: &ash::Entry, newest: u32) -> Result<u32, HostError> {
    // SAFETY: The loader is open.
    let offered = unsafe { entry.try_enumerate_instance_version() }.named("vkEnumerateInstanceVersion")?;
    let offered = offered.unwrap_or(vk::API_VERSION_1_0);
    if offered < vk::API_VERSION_1_1 {
        return Err(HostError::LoaderTooOld(version_text(offered)));
    }
    Ok(offered.min(newest))
}

/// A packed version as `major.minor.patch`.
pub(crate) fn version_text(version: u32) -> String {
    let (major, minor) = (vk::api_version_major(version), vk::api_version_minor(version));
    format!("{major}.{minor}.{}", vk::api_version_patch(version))
}

/// The extensions of the loader and drivers, or of a layer, among those that this crate uses.
fn extensions_of(entry: &ash::Entry, layer: Option<&CStr>) -> Result<Vec<&'static CStr>, HostError> {
    // SAFETY: The loader is open.
    let found = unsafe { entry.enumerate_instance_extension_properties(layer) };
    let found = found.named("vkEnumerateInstanceExtensionProperties")?;
    let useful = [
        vk::KHR_PORTABILITY_ENUMERATION_NAME,
        vk::EXT_DEBUG_UTILS_NAME,
        vk::EXT_VALIDATION_FEATURES_NAME,
        vk::EXT_LAYER_SETTINGS_NAME,
    ];
    let is_there = |name: &&CStr| found.iter().any(|one| one.extension_name_as_c_str() == Ok(*name));
    Ok(useful.into_iter().filter(is_there).collect())
}

fn has_validation_layer(entry: &ash::Entry) -> Result<bool, HostError> {
    // SAFETY: The loader is open.
    let layers = unsafe { entry.enumerate_instance_layer_properties() };
    let layers = layers.named("vkEnumerateInstanceLayerProperties")?;
    Ok(layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(LAYER)))
}

/// The validation layer's setting `name` with the value `on`.
fn switched_on<'a>(name: &'a CStr, on: &'a vk::Bool32) -> vk::LayerSettingEXT<'a> {
    // One value: the builder would count bytes.
    let mut setting = vk::LayerSettingEXT::default()
        .layer_name(LAYER)
        .setting_name(name)
        .ty(vk::LayerSettingTypeEXT::BOOL32);
    setting.value_count = 1;
    setting.p_values = std::ptr::from_ref(on).cast();
    setting
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_print_as_people_write_them() {
        assert_eq!(version_text(vk::make_api_version(0, 1, 3, 239)), "1.3.239");
    }
}
