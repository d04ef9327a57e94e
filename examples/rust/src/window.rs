//! The deferred engine in a window: lights swing, and what they light is free of noise in every frame.

use crate::Result;
use crate::command_line::FRAME_RATE;
use crate::deferred::Deferred;
use crate::tone_map::ToneMap;
use arealight_host::{Host, HostError, Swapchain};
use ash::vk;
use std::fmt::Display;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::platform::pump_events::EventLoopExtPumpEvents as _;
use winit::raw_window_handle::{HasDisplayHandle as _, HasWindowHandle as _};
use winit::window::{Window, WindowId};

/// What came of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Shown {
    /// So many frames were shown.
    Frames(u32),
    /// There is no window to show them in, and why.
    Nowhere(String),
}

/// Opens a window of `size` pixels and shows the scene in it as time passes, until it is closed; or so many
/// `frames`, each a thirtieth of a second after the other whatever the clock says.
pub fn show(size: [u32; 2], frames: Option<u32>) -> Result<Shown> {
    let nowhere = |why: &dyn Display| Ok(Shown::Nowhere(why.to_string()));

    // A window, where there is a display
    let Ok(mut events) = EventLoop::new() else {
        return nowhere(&"no display is open; of Linux's it is X11's, which DISPLAY names");
    };
    let mut desk = Desk { size, window: None, closed: false };
    events.pump_app_events(Some(Duration::ZERO), &mut desk);
    let window = match desk.window.take() {
        Some(Ok(window)) => window,
        Some(Err(error)) => return nowhere(&error),
        None => return nowhere(&"the display gives none"),
    };
    let (display, handle) = (window.display_handle()?.as_raw(), window.window_handle()?.as_raw());

    // A device that presents to it
    // SAFETY: the handles are of the window, which outlives the host and all that is made of it.
    let host = match unsafe { Host::for_window(crate::host_options(), display, handle) } {
        Ok(host) => host,
        Err(error) => return nowhere(&error),
    };

    // Frame by frame, at the size that the window has then
    let mut engine = Deferred::new(&host, size)?;
    let mut view: Option<View> = None;
    let (start, mut drawn) = (Instant::now(), 0);
    while frames.is_none_or(|frames| drawn < frames) {
        let patience = if view.is_none() { Duration::from_millis(20) } else { Duration::ZERO };
        events.pump_app_events(Some(patience), &mut desk);
        if desk.closed {
            break;
        }
        view = view.filter(|view| view.wanted == desk.size);
        if view.is_none() {
            view = View::new(&host, desk.size, &mut engine)?;
        }
        let seconds = frames.map_or_else(|| start.elapsed().as_secs_f64(), |_| f64::from(drawn) / FRAME_RATE);
        let Some(shown) = &view else { continue }; // minimised
        match shown.frame(&mut engine, seconds) {
            Ok(fits) => {
                drawn += 1;
                view = view.filter(|_| fits);
            }
            Err(error) if is_out_of_date(&*error) => view = None,
            Err(error) => return Err(error),
        }
    }
    Ok(Shown::Frames(drawn))
}

/// Whether the window is no longer as it was when the swapchain was made.
fn is_out_of_date(error: &(dyn std::error::Error + 'static)) -> bool {
    let result = vk::Result::ERROR_OUT_OF_DATE_KHR;
    matches!(error.downcast_ref(), Some(HostError::Vulkan { result: found, .. }) if *found == result)
}

/// The window's images, and how the engine's become them. The swapchain is dropped first, and waits.
struct View {
    swapchain: Swapchain,
    tone_map: ToneMap,
    /// The size of the window that it was made for.
    wanted: [u32; 2],
}

impl View {
    /// Makes both, and the engine's images as large. `None` where the window has no area.
    fn new(host: &Host, wanted: [u32; 2], engine: &mut Deferred) -> Result<Option<Self>> {
        // SAFETY: the view before was dropped, and its swapchain with it.
        let Some(swapchain) = (unsafe { Swapchain::new(host, wanted) })? else { return Ok(None) };
        engine.resize(swapchain.size)?;
        // SAFETY: the image stays until the engine is resized, when no view is left; the swapchain waits
        // before this goes.
        let tone_map = unsafe { ToneMap::new(host, &engine.g_buffer.radiance, swapchain.size) }?;
        Ok(Some(Self { swapchain, tone_map, wanted }))
    }

    /// Draws a frame and shows it. Whether its size still fits the window.
    fn frame(&self, engine: &mut Deferred, seconds: f64) -> Result<bool> {
        let Self { swapchain, tone_map, .. } = self;
        // doc: frame
        // Acquire an image, before anything is recorded that would not be submitted without; behind the
        // frame's own commands bring the radiance to it; then show it
        let mut shown = 0;
        // SAFETY: the place's last frame is over.
        let acquire = |place| Ok(unsafe { swapchain.acquire(place) }?);
        engine.frame(seconds, acquire, |(image, index, semaphores), commands| {
            shown = index;
            // SAFETY: the commands are being recorded, and wait for the image at TRANSFER.
            unsafe { tone_map.record(commands, image, vk::ImageLayout::PRESENT_SRC_KHR) };
            semaphores
        })?;
        // SAFETY: the frame was submitted, and leaves the image in that layout.
        Ok(unsafe { swapchain.present(shown) }?)
        // doc end
    }
}

/// What winit calls back.
struct Desk {
    /// The window's, in pixels.
    size: [u32; 2],
    window: Option<std::result::Result<Window, winit::error::OsError>>,
    closed: bool,
}

impl ApplicationHandler for Desk {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        let size = PhysicalSize::<u32>::from(self.size);
        let attributes = Window::default_attributes().with_title("Arealight").with_inner_size(size);
        self.window = Some(events.create_window(attributes));
    }

    fn window_event(&mut self, _: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::Resized(size) => self.size = size.into(),
            WindowEvent::CloseRequested | WindowEvent::Destroyed => self.closed = true,
            _ => {}
        }
    }
}
