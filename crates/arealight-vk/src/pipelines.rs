//! Pipelines of one kernel for what frames call for.

use crate::context::Context;
use crate::error::Error;
use crate::layouts::Layouts;
use crate::pass::ComputePass;
use arealight::kernels::Kernel;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::{Arc, Mutex, PoisonError};

/// The pipelines of a kernel, made when they are first needed and kept.
#[derive(Debug)]
pub(crate) struct Pipelines {
    layouts: Arc<Layouts>,
    module: Vec<u32>,
    made: Mutex<HashMap<Vec<(u32, u32)>, ComputePass>>,
}

impl Pipelines {
    /// The module is one that [`crate::pass::check_module`] found good.
    ///
    /// # Safety
    /// As [`Layouts::new`] and [`ComputePass::with_module`].
    pub(crate) unsafe fn new(
        context: &Context,
        kernel: &'static Kernel,
        module: Vec<u32>,
    ) -> Result<Self, Error> {
        // SAFETY: the same contract.
        Ok(Self { layouts: unsafe { Layouts::new(context, kernel) }?, module, made: Mutex::default() })
    }

    pub(crate) fn layouts(&self) -> &Layouts {
        &self.layouts
    }

    /// Does something with the pipeline of these specialisation constants.
    pub(crate) fn with(
        &self,
        specialization: Vec<(u32, u32)>,
        act: impl FnOnce(&ComputePass),
    ) -> Result<(), Error> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let pass = match made.entry(specialization) {
            Entry::Occupied(found) => found.into_mut(),
            Entry::Vacant(place) => {
                // SAFETY: by the contract of Pipelines::new.
                let pass = unsafe { ComputePass::of(&self.layouts, &self.module, place.key()) }?;
                place.insert(pass)
            }
        };
        act(pass);
        Ok(())
    }
}
