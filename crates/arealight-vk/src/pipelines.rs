//! Pipelines of one kernel for what frames need.

use crate::error::Error;
use crate::layouts::Layouts;
use crate::pass::ComputePass;
use arealight::kernels::Kernel;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

type Made = HashMap<Vec<(u32, u32)>, Arc<ComputePass>>;

/// The pipelines of a kernel, made when they are first needed and kept.
#[derive(Debug)]
pub(crate) struct Pipelines {
    layouts: Arc<Layouts>,
    kernel: &'static Kernel,
    module: Vec<u32>,
    made: Mutex<Made>,
}

impl Pipelines {
    /// The module is one that [`crate::module::check_module`] found good.
    ///
    /// # Safety
    /// As [`Layouts::new`] and [`ComputePass::of`].
    pub(crate) unsafe fn new(layouts: Arc<Layouts>, kernel: &'static Kernel, module: Vec<u32>) -> Self {
        Self { layouts, kernel, module, made: Mutex::default() }
    }

    pub(crate) fn layouts(&self) -> &Layouts {
        &self.layouts
    }

    /// What [`ComputePass::record`] refuses.
    pub(crate) fn check(&self, constants: &[u8], groups: [u32; 3]) -> Result<(), Error> {
        self.layouts.check(self.kernel, constants, groups)
    }

    /// Does something with the pipeline of these specialisation constants.
    pub(crate) fn with(
        &self,
        specialization: Vec<(u32, u32)>,
        act: impl FnOnce(&ComputePass),
    ) -> Result<(), Error> {
        let made = || self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let found = made().get(&specialization).cloned();
        let pass = if let Some(pass) = found {
            pass
        } else {
            // Others record meanwhile; of two threads that make the same the first one's stays
            // SAFETY: by the contract of Pipelines::new.
            let pass = unsafe { ComputePass::of(&self.layouts, self.kernel, &self.module, &specialization) }?;
            Arc::clone(made().entry(specialization).or_insert(Arc::new(pass)))
        };
        act(&pass);
        Ok(())
    }
}
