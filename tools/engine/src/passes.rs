//! Passes on a host: pipelines, and descriptor sets for them.

use crate::host::{Buffer, DescriptorPool, Host};
use crate::{EngineError, Kept};
use arealight::kernels::Kernel;
use arealight_vk::{ComputePass, Context, Resource};
use ash::vk;
use bytemuck::Pod;
use rayon::prelude::*;
use std::cell::RefCell;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::marker::PhantomData;
use std::rc::Rc;
use std::time::{Duration, Instant};

/// A kernel's name, with the values of its specialisation constants.
type Specialized = (&'static str, Vec<(u32, u32)>);

/// A pipeline that its users share.
pub type SharedPass = Rc<Kept<ComputePass>>;

/// A host, with the recorder's context on it to make passes from. Pipelines are made on demand and kept.
pub struct Passes {
    // Go before the device
    made: RefCell<HashMap<Specialized, SharedPass>>,
    context: Context,
    host: Host,
}

impl Passes {
    /// On the device of `host`.
    pub fn new(host: Host) -> Result<Self, EngineError> {
        // SAFETY: The handles belong together and are kept alive by `host`, which this drops last.
        let context = unsafe { Context::new(host.instance(), host.physical_device(), host.device()) }?;
        Ok(Self { made: RefCell::default(), context, host })
    }

    /// With modules as they are: [`Context::with_whole_modules`]. Before any pass is made.
    pub(crate) fn with_whole_modules(mut self) -> Self {
        self.context = self.context.with_whole_modules();
        self
    }

    /// The device.
    pub fn host(&self) -> &Host {
        &self.host
    }

    /// The recorder's context.
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// The pipeline of `kernel`, whose name no other kernel has.
    pub fn pass(
        &self,
        kernel: &'static Kernel,
        specialization: &[(u32, u32)],
    ) -> Result<SharedPass, EngineError> {
        let mut made = self.made.borrow_mut();
        match made.entry((kernel.name, specialization.to_vec())) {
            Entry::Occupied(found) => Ok(Rc::clone(found.get())),
            Entry::Vacant(place) => {
                // SAFETY: Submissions are waited for, so no use is pending when the pass is dropped; where
                // one timed out it is leaked. The host, which `Kept` holds, outlives it.
                let pass = unsafe { ComputePass::new(&self.context, kernel, specialization) }?;
                Ok(Rc::clone(place.insert(Rc::new(Kept::new(&self.host, pass)))))
            }
        }
    }

    /// Makes all of these pipelines that are not made yet, on every processor. `progress` is called for each,
    /// from any thread.
    pub fn make_all(
        &self,
        wanted: &[(&'static Kernel, Vec<(u32, u32)>)],
        progress: &(dyn Fn() + Sync),
    ) -> Result<(), EngineError> {
        let mut made = self.made.borrow_mut();
        let mut keys: Vec<Specialized> = vec![];
        let missing = wanted.iter().filter(|(kernel, specialization)| {
            let key = (kernel.name, specialization.clone());
            let is_missing = !made.contains_key(&key) && !keys.contains(&key);
            if is_missing {
                keys.push(key);
            } else {
                progress();
            }
            is_missing
        });
        let missing: Vec<_> = missing.collect();
        let context = &self.context;
        let make = |(kernel, specialization): &&(&'static Kernel, Vec<(u32, u32)>)| {
            // SAFETY: As in Passes::pass; there is no pipeline cache that threads would share.
            let pass = unsafe { ComputePass::new(context, kernel, specialization) };
            progress();
            pass
        };
        let passes = missing.par_iter().map(make).collect::<Vec<_>>();
        for (key, pass) in keys.into_iter().zip(passes) {
            made.insert(key, Rc::new(Kept::new(&self.host, pass?)));
        }
        Ok(())
    }

    /// A descriptor set for `pass` that points at `resources`.
    ///
    /// # Errors
    /// [`EngineError`] where a resource does not fit its binding, or memory is out.
    ///
    /// # Safety
    /// The resources live until the last submission that uses the set was waited for; the pass is of this
    /// host.
    pub unsafe fn bind(&self, pass: &ComputePass, resources: &[Resource]) -> Result<BoundSet, EngineError> {
        let pool = self.host.descriptor_pool(1, &pass.pool_sizes(1))?;
        // SAFETY: The layout is the pass's, and alive.
        let set = unsafe { pool.allocate(pass.set_layout()) }?;
        // SAFETY: The set is new, and the caller keeps the resources.
        unsafe { pass.write_set(set, resources) }?;
        Ok(BoundSet { set, _pool: pool })
    }
}

impl Passes {
    /// A kernel over a list: `count` invocations, with `inputs` bound in turn and a result each at the last
    /// binding, which stays NaN where nothing is written.
    ///
    /// # Errors
    /// As [`Passes::pass`] and [`Passes::bind`].
    ///
    /// # Safety
    /// The inputs live until the last run.
    pub unsafe fn over_list<R: Pod, C: Pod>(
        &self,
        (kernel, specialization): (&'static Kernel, &[(u32, u32)]),
        inputs: &[Resource],
        constants: C,
        count: usize,
    ) -> Result<ListPass<R, C>, EngineError> {
        let pass = self.pass(kernel, specialization)?;
        let results = self.host.storage_buffer("results", &vec![u32::MAX; count * size_of::<R>() / 4])?;
        // SAFETY: The caller keeps the inputs, and the list the results.
        let set = unsafe { self.bind(&pass, &[inputs, &[Resource::buffer(results.handle())]].concat()) }?;
        let (host, of) = (self.host.clone(), PhantomData);
        Ok(ListPass { pass, set, results, host, constants, count: count as u32, of })
    }
}

/// A kernel over a list: [`Passes::over_list`].
pub struct ListPass<R, C> {
    pass: SharedPass,
    set: BoundSet,
    results: Buffer,
    host: Host,
    constants: C,
    count: u32,
    of: PhantomData<R>,
}

impl<R: Pod, C: Pod> ListPass<R, C> {
    /// Runs it, and waits: GPU time, or wall time where the queue has no timestamps.
    pub fn run(&self) -> Result<Duration, EngineError> {
        let start = Instant::now();
        let took = self.host.try_submit_timed(|commands| {
            // SAFETY: `commands` is being recorded, outside a render pass.
            unsafe { self.set.record(&self.pass, commands, &self.constants, [self.count, 1, 1]) }
        })?;
        Ok(took.unwrap_or_else(|| start.elapsed()))
    }

    /// What the last run wrote.
    pub fn results(&self) -> Result<Vec<R>, EngineError> {
        Ok(self.results.download()?)
    }
}

/// A written descriptor set.
pub struct BoundSet {
    set: vk::DescriptorSet,
    _pool: DescriptorPool,
}

impl BoundSet {
    /// Records `pass`, for which the set was written, over `items`.
    ///
    /// # Errors
    /// [`EngineError`] where the constants or the groups are not what the kernel or the device takes.
    ///
    /// # Safety
    /// `commands` is being recorded for the pass's host, outside a render pass.
    pub unsafe fn record(
        &self,
        pass: &ComputePass,
        commands: vk::CommandBuffer,
        constants: &impl Pod,
        items: [u32; 3],
    ) -> Result<(), EngineError> {
        let groups = pass.kernel().groups_for(items);
        // SAFETY: The set was written for the pass; the commands are the caller's.
        unsafe { pass.record(commands, self.set, bytemuck::bytes_of(constants), groups) }?;
        Ok(())
    }
}
