//! The descriptors of a frame's commands.

use super::ShadeResources;
use super::resources::needed;
use crate::error::Error;
use crate::layouts::Layouts;
use arealight::LightSummary;
use ash::vk;

/// The descriptors of a frame: sets, or resources to push.
#[derive(Debug, Clone, Copy)]
pub enum Bound<'a> {
    /// A descriptor set that the pass's `write_set` wrote.
    Set(vk::DescriptorSet),
    /// Such a set, and the host's set 1 of a pass with a `host_set`.
    Sets([vk::DescriptorSet; 2]),
    /// Resources that are pushed: [`Descriptors::Pushed`](crate::Descriptors::Pushed). They outlive the
    /// recorded work.
    Pushed {
        /// Those of the pass.
        resources: &'a ShadeResources,
        /// The host's set 1.
        host_set: Option<vk::DescriptorSet>,
    },
}

impl From<vk::DescriptorSet> for Bound<'_> {
    fn from(set: vk::DescriptorSet) -> Self {
        Self::Set(set)
    }
}

impl Bound<'_> {
    pub(crate) fn host_set(&self) -> Option<vk::DescriptorSet> {
        match *self {
            Self::Set(_) => None,
            Self::Sets([_, host_set]) => Some(host_set),
            Self::Pushed { host_set, .. } => host_set,
        }
    }

    /// The sets, of a pass that takes nothing else, checked: they have what the lights need.
    pub(crate) fn sets(
        &self,
        layouts: &Layouts,
        lights: LightSummary,
    ) -> Result<Vec<vk::DescriptorSet>, Error> {
        layouts.check_host_set(self.host_set())?;
        let sets = match *self {
            Self::Set(set) => vec![set],
            Self::Sets(sets) => sets.to_vec(),
            Self::Pushed { .. } => {
                let message = "are given, but passes of shadows and media take sets".into();
                return Err(Error::InvalidArgument { field: "resources", message });
            }
        };
        layouts.check_present(sets[0], &needed(lights))?;
        layouts.check_set(sets[0])?;
        Ok(sets)
    }
}
