//! Frames by one pass that do not wait for each other: of several sizes, as of a window that is resized, and
//! recorded on several threads.

use arealight_engine::Kept;
use arealight_engine::host::DescriptorPool;
use arealight_tests::prelude::*;

const CAMERA: Vec3 = Vec3::new(0.0, -1.0, 1.0);

/// What a host makes anew when its window has another size, with a floor in the G-buffer.
struct Images {
    size: [u32; 2],
    radiance: Image,
    _planes: Planes<Option<Image>>,
    set: vk::DescriptorSet,
    _pool: DescriptorPool,
}

impl Images {
    fn new(engine: &TestEngine, pass: &ShadePass, lights: &LightBuffers, size: [u32; 2]) -> Self {
        let planes = planes(engine, size, &|plane, [x, y]| match plane {
            Plane::Position => Some(Vec4::new(0.1 * x as f32 - 0.4, 0.1 * y as f32 - 0.4, 0.0, 1.0)),
            Plane::Normal => Some(Vec4::new(0.0, 0.0, 1.0, 0.5)),
            Plane::BaseColor => Some(Vec4::new(0.8, 0.6, 0.4, 0.25)),
            _ => None,
        });
        let radiance = radiance(engine, size, BEFORE);
        let resources =
            ShadeResources { planes: reads(&planes), radiance: store(&radiance), ..lights.resources(engine) };
        let pool = engine.host().descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
        // SAFETY: the set is new; tests wait before the images go.
        let set = unsafe {
            let set = pool.allocate(pass.set_layout()).unwrap();
            pass.write_set(set, &resources).unwrap();
            set
        };
        Self { size, radiance, _planes: planes, set, _pool: pool }
    }

    fn picture(&self) -> Vec<[f32; 4]> {
        self.radiance.download(Usage::COMPUTE_WRITE).unwrap()
    }
}

/// Command buffers that are submitted without waiting, each with a fence.
struct InFlight<'a> {
    engine: &'a TestEngine,
    pool: vk::CommandPool,
    fences: Vec<vk::Fence>,
}

impl<'a> InFlight<'a> {
    fn new(engine: &'a TestEngine) -> Self {
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(engine.host().queue_family());
        // SAFETY: the device is alive.
        let pool = unsafe { engine.host().device().create_command_pool(&info, None) }.unwrap();
        Self { engine, pool, fences: vec![] }
    }

    fn submit(&mut self, record: impl FnOnce(vk::CommandBuffer)) {
        let (host, device) = (self.engine.host(), self.engine.host().device());
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        // SAFETY: the commands are new, and end with their pool, which waits.
        unsafe {
            let commands = device.allocate_command_buffers(&info).unwrap();
            device.begin_command_buffer(commands[0], &vk::CommandBufferBeginInfo::default()).unwrap();
            record(commands[0]);
            device.end_command_buffer(commands[0]).unwrap();
            let fence = device.create_fence(&vk::FenceCreateInfo::default(), None).unwrap();
            self.fences.push(fence);
            let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
            device.queue_submit(*host.queue(), &submit, fence).unwrap();
        }
    }

    /// Which are done.
    fn done(&self) -> Vec<bool> {
        let device = self.engine.host().device();
        // SAFETY: the fences are ours.
        self.fences.iter().map(|fence| unsafe { device.get_fence_status(*fence) }.unwrap()).collect()
    }

    fn wait(&self) {
        // SAFETY: as above.
        unsafe { self.engine.host().device().wait_for_fences(&self.fences, true, u64::MAX) }.unwrap();
    }
}

impl Drop for InFlight<'_> {
    fn drop(&mut self) {
        self.wait();
        let device = self.engine.host().device();
        // SAFETY: nothing is pending.
        unsafe {
            self.fences.iter().for_each(|fence| device.destroy_fence(*fence, None));
            device.destroy_command_pool(self.pool, None);
        }
    }
}

#[test]
fn frames_of_other_sizes_are_recorded_while_one_is_in_flight() {
    let Some(engine) = TestEngine::new() else { return };
    let (host, device) = (engine.host(), engine.host().device());
    let pass: &Kept<ShadePass> = &engine.shade_pass(ShadeOptions::default()).unwrap();
    let lights = LightBuffers::new(&engine, &[lamp()], DVec3::ZERO);
    let images = |size| Images::new(&engine, pass, &lights, size);
    let record = |commands: vk::CommandBuffer, images: &Images, size: [u32; 2]| {
        let frame = lights.frame(size, CAMERA);
        // SAFETY: the commands are being recorded, with a set of images of at least this size.
        unsafe { pass.record(commands, images.set, &frame) }.unwrap();
    };

    // Each size by itself
    let sizes = [[8, 8], [16, 4], [3, 5], [8, 8]];
    let alone = sizes.map(|size| {
        let images = images(size);
        host.submit(|commands| record(commands, &images, size)).unwrap();
        images.picture()
    });
    assert!(alone[0].iter().all(|texel| texel[0] > 0.05) && alone[0][0] != alone[0][63]);

    // All of them, while the first waits for the CPU: images are made, sets written and frames recorded
    // meanwhile
    let made = sizes.map(images);
    // SAFETY: the event is destroyed when nothing is pending.
    let event = unsafe { device.create_event(&vk::EventCreateInfo::default(), None) }.unwrap();
    // This way of validating waits for each submission by itself, and refuses what would wait for the CPU
    let layer_waits = std::env::var("AREALIGHT_VALIDATION").is_ok_and(|way| way == "gpu-assisted");
    {
        let mut in_flight = InFlight::new(&engine);
        in_flight.submit(|commands| {
            let (set, waits) = (vk::PipelineStageFlags::HOST, vk::PipelineStageFlags::COMPUTE_SHADER);
            if !layer_waits {
                // SAFETY: the commands are being recorded.
                unsafe { device.cmd_wait_events(commands, &[event], set, waits, &[], &[], &[]) };
            }
            record(commands, &made[0], sizes[0]);
        });
        for (images, size) in made.iter().zip(sizes).skip(1) {
            in_flight.submit(|commands| record(commands, images, size));
        }
        assert!(layer_waits || !in_flight.done()[0], "the first still waits");
        // SAFETY: the event is this test's.
        unsafe { device.set_event(event) }.unwrap();
        in_flight.wait();
        assert_eq!(in_flight.done(), [true; 4]);
    }
    // SAFETY: nothing is pending.
    unsafe { device.destroy_event(event, None) };
    for (images, alone) in made.iter().zip(&alone) {
        assert_eq!(images.picture(), *alone, "{:?}", images.size);
    }

    // The twin: a frame that is told another size leaves the rest as it was
    let wider = images([16, 4]);
    host.submit(|commands| record(commands, &wider, [8, 4])).unwrap();
    let picture = wider.picture();
    assert_eq!((picture[7], picture[8]), (alone[1][7], BEFORE.to_array()));
}

/// Command buffers of a thread's own, recorded and not yet submitted.
struct Recorded<'a> {
    device: &'a ash::Device,
    pool: vk::CommandPool,
    commands: Vec<vk::CommandBuffer>,
}

impl<'a> Recorded<'a> {
    fn new(
        device: &'a ash::Device,
        family: u32,
        count: u32,
        record: impl Fn(u32, vk::CommandBuffer),
    ) -> Self {
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(family);
        // SAFETY: the device is alive, and the pool is this thread's alone until it is given away.
        unsafe {
            let pool = device.create_command_pool(&info, None).unwrap();
            let info =
                vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(count);
            let commands = device.allocate_command_buffers(&info).unwrap();
            for (index, commands) in (0..).zip(&commands) {
                device.begin_command_buffer(*commands, &vk::CommandBufferBeginInfo::default()).unwrap();
                record(index, *commands);
                device.end_command_buffer(*commands).unwrap();
            }
            Self { device, pool, commands }
        }
    }
}

impl Drop for Recorded<'_> {
    fn drop(&mut self) {
        // SAFETY: the test waited for what was submitted.
        unsafe { self.device.destroy_command_pool(self.pool, None) };
    }
}

#[test]
fn threads_record_with_one_pass_and_make_its_pipelines_at_once() {
    const FRAMES: u32 = 30;
    let Some(engine) = TestEngine::new() else { return };
    let (host, device) = (engine.host(), engine.host().device());
    let lights = LightBuffers::new(&engine, &[lamp()], DVec3::ZERO);
    // Each thread asks for the pipelines of three sets of effects, in an order of its own: the first to ask
    // makes them
    let added = [Effects::empty(), Effects::TWO_SIDED, Effects::POLYGON];
    let frame_of = |size, index: u32| {
        let mut frame = lights.frame(size, CAMERA);
        frame.lights.effects |= added[index as usize % added.len()];
        frame
    };
    let sizes = [[8, 8], [16, 4], [3, 5], [9, 2]];
    let kept = engine.shade_pass(ShadeOptions::default()).unwrap();
    let alone = sizes.map(|size| {
        let images = Images::new(&engine, &kept, &lights, size);
        // SAFETY: the commands are being recorded, with a set of images of this size.
        host.submit(|commands| unsafe { kept.record(commands, images.set, &frame_of(size, 0)) }.unwrap())
            .unwrap();
        images.picture()
    });

    let pass = &engine.pass(ShadeOptions::default()).unwrap();
    let made = sizes.map(|size| Images::new(&engine, pass, &lights, size));
    let sets = made.each_ref().map(|images| (images.set, images.size));
    let (family, frame_of) = (host.queue_family(), &frame_of);
    let recorded: Vec<Recorded<'_>> = std::thread::scope(|scope| {
        let threads = sets.map(|(set, size)| {
            scope.spawn(move || {
                Recorded::new(device, family, FRAMES, |index, commands| {
                    // SAFETY: the commands are this thread's, and being recorded, with a set of its own.
                    unsafe { pass.record(commands, set, &frame_of(size, index + size[0])) }.unwrap();
                })
            })
        });
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    // One frame after the other of each thread
    for index in 0..FRAMES as usize {
        let commands: Vec<vk::CommandBuffer> =
            recorded.iter().map(|recorded| recorded.commands[index]).collect();
        // SAFETY: the commands are complete, and the queue is held; it is idle before anything goes.
        unsafe {
            let queue = host.queue();
            let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
            device.queue_submit(*queue, &submit, vk::Fence::null()).unwrap();
            device.queue_wait_idle(*queue).unwrap();
        }
    }
    for (images, alone) in made.iter().zip(&alone) {
        assert_eq!(images.picture(), *alone, "{:?}", images.size);
        // The twin: before, there was something else
        assert_ne!(alone[0], BEFORE.to_array());
    }
}
