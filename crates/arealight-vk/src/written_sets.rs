//! What descriptor sets were written with: a set that points at nothing where a frame reads is an error that
//! names it, and in debug builds one that points at a destroyed image of ours. In release builds a set takes
//! one entry in a map, without memory of its own unless something is absent.

use crate::error::Error;
use crate::resource::Resource;
use arealight::kernels::Binding;
use ash::vk;
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The sets that passes of one context have written.
#[derive(Clone, Default)]
pub(crate) struct WrittenSets(Arc<Mutex<Sets>>);

/// How many sets are kept. Some hosts take new ones for every frame, and do not say when they free them.
const MOST: usize = 4096;

#[derive(Default)]
struct Sets {
    written: HashMap<vk::DescriptorSet, Written>,
    /// From the one that was kept first to the one that was kept last.
    order: VecDeque<vk::DescriptorSet>,
}

impl Sets {
    /// Keeps a set; of too many, the one goes that was kept first.
    fn keep(&mut self, set: vk::DescriptorSet, written: Written) {
        if self.written.insert(set, written).is_none() {
            self.order.push_back(set);
        }
        if self.order.len() > MOST
            && let Some(first) = self.order.pop_front()
        {
            self.written.remove(&first);
        }
    }
}

/// The last contents of a set.
struct Written {
    /// Views, and the bindings that they are at; in debug builds.
    views: Vec<(vk::ImageView, &'static str)>,
    /// The first binding whose image was destroyed since.
    destroyed: Option<&'static str>,
    /// The bindings that it was written without.
    absent: Vec<&'static str>,
}

impl WrittenSets {
    /// Notes that `set` points at `resources` now, and at nothing of the host's for the bindings `absent`.
    pub(crate) fn write(
        &self,
        set: vk::DescriptorSet,
        bindings: &[Binding],
        resources: &[Resource],
        absent: &[&'static str],
    ) {
        let views = bindings.iter().zip(resources).filter(|_| cfg!(debug_assertions));
        let views = views.filter_map(|(binding, resource)| Some((resource.view()?, binding.name))).collect();
        self.lock().keep(set, Written { views, destroyed: None, absent: absent.to_vec() });
    }

    /// Notes that a view of ours is destroyed. The driver may give its handle to another then, so that the
    /// sets are marked, not the handle.
    pub(crate) fn destroy(&self, view: vk::ImageView) {
        if !cfg!(debug_assertions) {
            return;
        }
        for written in self.lock().written.values_mut() {
            let found = written.views.iter().find(|(pointed_at, _)| *pointed_at == view);
            written.destroyed = written.destroyed.or(found.map(|(_, binding)| *binding));
        }
    }

    /// Checks that all is there that a set points at.
    pub(crate) fn check(&self, set: vk::DescriptorSet) -> Result<(), Error> {
        if !cfg!(debug_assertions) {
            return Ok(());
        }
        match self.lock().written.get(&set).and_then(|written| written.destroyed) {
            Some(field) => Err(Error::Destroyed { field }),
            None => Ok(()),
        }
    }

    /// Checks that a set was written with what is needed.
    pub(crate) fn check_present(&self, set: vk::DescriptorSet, needed: &[&'static str]) -> Result<(), Error> {
        if needed.is_empty() {
            return Ok(());
        }
        let sets = self.lock();
        let Some(written) = sets.written.get(&set) else { return Ok(()) };
        match needed.iter().find(|binding| written.absent.contains(binding)) {
            Some(field) => {
                let message =
                    "is missing: the frame's lights need it, but the set was written without".into();
                Err(Error::InvalidArgument { field, message })
            }
            None => Ok(()),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Sets> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::kernels::TEXTURE_MIP;
    use ash::vk::Handle as _;

    fn written(view: u64) -> [Resource; 2] {
        let layout = vk::ImageLayout::GENERAL;
        [
            Resource::SampledImage { view: vk::ImageView::from_raw(view), layout },
            Resource::StorageImage { view: vk::ImageView::from_raw(9) },
        ]
    }

    #[test]
    fn no_more_sets_are_kept_than_a_host_has_in_flight() {
        let sets = WrittenSets::default();
        for number in 1..=MOST as u64 + 10 {
            sets.write(vk::DescriptorSet::from_raw(number), TEXTURE_MIP.bindings(), &written(5), &[]);
            // One that is written again stands where it stood
            sets.write(vk::DescriptorSet::from_raw(number), TEXTURE_MIP.bindings(), &written(5), &[]);
        }
        let counts = {
            let sets = sets.lock();
            (sets.written.len(), sets.order.len())
        };
        assert_eq!(counts, (MOST, MOST));
        sets.destroy(vk::ImageView::from_raw(5));
        // The first is forgotten, the last is not
        assert_eq!(sets.check(vk::DescriptorSet::from_raw(1)), Ok(()));
        let last = sets.check(vk::DescriptorSet::from_raw(MOST as u64 + 10));
        assert_eq!(last.is_err(), cfg!(debug_assertions));
    }

    #[test]
    fn a_set_is_refused_from_the_image_s_end_until_it_is_written_again() {
        let (sets, set) = (WrittenSets::default(), vk::DescriptorSet::from_raw(1));
        assert_eq!(sets.check(set), Ok(()));
        sets.write(set, TEXTURE_MIP.bindings(), &written(5), &[]);
        sets.destroy(vk::ImageView::from_raw(6));
        assert_eq!(sets.check(set), Ok(()));
        sets.destroy(vk::ImageView::from_raw(5));
        let expected =
            if cfg!(debug_assertions) { Err(Error::Destroyed { field: "finer_level" }) } else { Ok(()) };
        assert_eq!(sets.check(set), expected);
        // The driver gives the handle to a new view
        sets.write(set, TEXTURE_MIP.bindings(), &written(5), &[]);
        assert_eq!(sets.check(set), Ok(()));
    }

    #[test]
    fn a_set_is_refused_by_frames_that_need_what_it_was_written_without() {
        let (sets, set) = (WrittenSets::default(), vk::DescriptorSet::from_raw(1));
        assert_eq!(sets.check_present(set, &["shapes"]), Ok(()), "nobody knows of it");
        sets.write(set, TEXTURE_MIP.bindings(), &written(5), &["shapes"]);
        assert_eq!(sets.check_present(set, &["light_textures"]), Ok(()));
        let refused = sets.check_present(set, &["light_textures", "shapes"]);
        assert!(matches!(refused, Err(Error::InvalidArgument { field: "shapes", .. })), "{refused:?}");
        // The twin: written with them
        sets.write(set, TEXTURE_MIP.bindings(), &written(5), &[]);
        assert_eq!(sets.check_present(set, &["light_textures", "shapes"]), Ok(()));
    }
}
