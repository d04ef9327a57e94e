//! The viewer in a window of X11 or Wayland. Pictures come from the device through memory: whatever it is, it
//! need not present.

use super::interface::Interface;
use super::look::Look;
use super::paint;
use super::script::Script;
use super::state::{Event, Key, State};
use super::viewer::Viewer;
use crate::failure::Failure;
use crate::gpu;
use crate::output::print;
use softbuffer::{Context, Surface};
use std::fmt::Display;
use std::num::NonZeroU32;
use std::path::Path;
use std::process::ExitCode;
use std::rc::Rc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, OwnedDisplayHandle};
use winit::keyboard::{Key as WindowKey, NamedKey};
use winit::window::{Window, WindowId};

/// Shows a scene until its window is closed, or the script is over.
///
/// # Errors
/// [`Failure`] where there is no window, or the device fails.
pub fn show(
    viewer: Viewer<'_>,
    state: State,
    size: [u32; 2],
    samples: u32,
    script: Option<&Script>,
    scene: &Path,
) -> Result<ExitCode, Failure> {
    let events = events()?;
    let context = Context::new(events.owned_display_handle()).map_err(|error| no_window(&error))?;
    let mut desk = Desk {
        viewer,
        state,
        interface: Interface::new(1.0),
        coarse: 3,
        drawn: None,
        rest: Instant::now(),
        size,
        samples,
        script,
        scene,
        context,
        window: None,
        pointer: [0.5; 2],
        last: Instant::now(),
        before: -1.0,
        frames: 0,
        failure: None,
    };
    events.run_app(&mut desk).map_err(|error| no_window(&error))?;
    match desk.failure {
        Some(failure) => Err(failure),
        None => print(&format!("{} frames were shown\n", desk.frames)),
    }
}

/// A window system's events. Where one of its libraries is missing winit panics.
fn events() -> Result<EventLoop<()>, Failure> {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let made = std::panic::catch_unwind(EventLoop::new);
    std::panic::set_hook(hook);
    let missing = "one of X11's libraries is missing: see tools/setup.sh";
    made.map_err(|_| no_window(&missing))?.map_err(|error| no_window(&error))
}

fn no_window(why: &dyn Display) -> Failure {
    // winit's text begins with the place in its source
    let why = why.to_string();
    let why =
        why.rsplit_once(".rs:").and_then(|(_, rest)| rest.split_once(": ")).map_or(&*why, |(_, why)| why);
    Failure::Device(format!("no window can be opened ({why}); view --record needs none"))
}

/// A pixel's step of a touchpad, in steps of a wheel.
const PIXELS_A_STEP: f64 = 40.0;

/// A window's pixels.
type Pixels = Surface<OwnedDisplayHandle, Rc<Window>>;

/// What winit calls back.
struct Desk<'a> {
    viewer: Viewer<'a>,
    state: State,
    interface: Interface,
    /// How many pixels of the window are one of the picture on each axis while what is seen changes.
    coarse: u32,
    /// What was drawn last, and by how many pixels.
    drawn: Option<(State, [u32; 2])>,
    /// When what is seen will have rested long enough for every pixel.
    rest: Instant,
    /// Of the picture, and so of the window, in pixels.
    size: [u32; 2],
    samples: u32,
    script: Option<&'a Script>,
    /// For messages.
    scene: &'a Path,
    context: Context<OwnedDisplayHandle>,
    window: Option<(Rc<Window>, Pixels)>,
    /// Where the pointer is, in parts of the picture.
    pointer: [f64; 2],
    /// When the last frame began, and the one of the script in its seconds.
    last: Instant,
    before: f64,
    frames: u32,
    failure: Option<Failure>,
}

/// The most seconds of a script from frame to frame.
const MOST_STEP: f64 = 0.25;

/// What a frame may take while what is seen changes, so that ten are shown a second.
const MOST_FRAME: Duration = Duration::from_millis(100);

/// The fewest pixels: so many of the window on each axis are one.
const MOST_COARSE: u32 = 6;

/// How long nothing changes before every pixel is drawn.
const REST: Duration = Duration::from_millis(200);

impl Desk<'_> {
    fn open(&mut self, events: &ActiveEventLoop) -> Result<(), Failure> {
        let size = PhysicalSize::<u32>::from(self.size);
        let attributes = Window::default_attributes().with_title("Arealight").with_inner_size(size);
        let window = Rc::new(events.create_window(attributes).map_err(|error| no_window(&error))?);
        let surface = Surface::new(&self.context, Rc::clone(&window)).map_err(|error| no_window(&error))?;
        self.size = window.inner_size().into();
        self.interface = Interface::new(window.scale_factor() as f32);
        self.state.panel = self.script.is_none();
        self.window = Some((window, surface));
        self.last = Instant::now();
        self.rest = self.last + REST; // a coarse picture is there sooner
        Ok(())
    }

    fn apply(&mut self, event: Event) {
        let [width, height] = self.size.map(|side| f64::from(side.max(1)));
        if !self.interface.takes(&event, self.size) {
            self.state.apply(event, self.viewer.scene(), width / height);
        }
        if let Some((window, _)) = &self.window {
            window.request_redraw();
        }
    }

    /// Draws a frame, and shows it.
    fn draw(&mut self) -> Result<(), Failure> {
        // Minimised windows have no area
        let [Some(width), Some(height)] = self.size.map(NonZeroU32::new) else { return Ok(()) };
        // Scripts and images that move wait for slow frames
        let step = self.last.elapsed().as_secs_f64().min(MOST_STEP);
        self.last = Instant::now();
        self.state.play(self.viewer.scene(), step);
        if let Some(script) = self.script {
            // What each event does is shown
            let now = (self.before.max(0.0) + step).min(script.next_after(self.before));
            for event in script.between(self.before, now) {
                self.apply(event);
            }
            self.before = now;
            self.state.quit |= now > script.seconds();
        }
        let began = Instant::now();
        let changes = self.drawn.as_ref().is_some_and(|(before, _)| !self.state.is_seen_as(before));
        if changes {
            self.rest = began + REST;
        }
        let coarse = if began < self.rest { self.coarse } else { 1 };
        let fail = |error| gpu::failure(error, self.scene);
        let size = self.size.map(|side| side.div_ceil(coarse));
        let now = Some((self.state.clone(), size));
        // What is done in the panel shows at once: the picture converges in the next frame
        if !self.interface.is_asked() || self.drawn != now {
            self.viewer.resize(size).map_err(fail)?;
            self.viewer.draw(&self.state, self.samples).map_err(fail)?;
            self.drawn = now;
        }
        let shown = self.viewer.shown(&self.state);
        let mut frame = paint(&self.state, &shown).enlarged(self.size);
        if std::mem::take(&mut self.state.save) {
            // What was saved before stays, and what cannot be written is no reason to end
            let mut names = (self.frames..).map(|number| format!("view-{number:04}"));
            let is_free =
                |name: &String| !["png", "json"].iter().any(|it| Path::new(name).with_extension(it).exists());
            let name = names.find(is_free).unwrap_or_default();
            let saved = frame.save_png(format!("{name}.png").as_ref());
            match saved.and_then(|()| Look::of(&self.state).save(format!("{name}.json").as_ref())) {
                Ok(()) => crate::output::say(&format!("wrote {name}.png and {name}.json")),
                Err(error) => crate::output::say(&format!("error: {error}")),
            }
        }
        self.interface.draw(&mut frame, &mut self.state, &shown);
        let Some((window, surface)) = &mut self.window else { return Ok(()) };
        surface.resize(width, height).map_err(|error| no_window(&error))?;
        let mut pixels = surface.buffer_mut().map_err(|error| no_window(&error))?;
        for (pixel, rgb) in pixels.iter_mut().zip(frame.bytes().chunks_exact(3)) {
            *pixel = u32::from_be_bytes([0, rgb[0], rgb[1], rgb[2]]);
        }
        window.pre_present_notify();
        pixels.present().map_err(|error| no_window(&error))?;
        self.frames += 1;
        if changes {
            // Slow frames have fewer pixels from now on, fast ones more
            self.coarse = match began.elapsed() {
                slow if slow > MOST_FRAME => (self.coarse + 1).min(MOST_COARSE),
                fast if fast < MOST_FRAME / 3 => (self.coarse - 1).max(1),
                _ => self.coarse,
            };
            // Later where a frame of every pixel takes long: nothing is heard meanwhile
            self.rest = Instant::now() + REST.max(began.elapsed() * coarse.pow(2) / 8);
        }
        Ok(())
    }

    /// Whether the next frame differs, although nobody does anything.
    fn goes_on(&self) -> bool {
        self.script.is_some() || self.interface.goes_on() || self.viewer.goes_on(&self.state)
    }
}

/// A key as scripts name it.
fn name_of(key: &WindowKey) -> Option<String> {
    Some(match key {
        WindowKey::Character(text) => text.to_lowercase(),
        WindowKey::Named(NamedKey::Escape) => "escape".to_owned(),
        WindowKey::Named(NamedKey::Space) => "space".to_owned(),
        WindowKey::Named(NamedKey::ArrowLeft) => "left".to_owned(),
        WindowKey::Named(NamedKey::ArrowRight) => "right".to_owned(),
        WindowKey::Named(NamedKey::ArrowUp) => "up".to_owned(),
        WindowKey::Named(NamedKey::ArrowDown) => "down".to_owned(),
        _ => return None,
    })
}

impl ApplicationHandler for Desk<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.window.is_some() {
            return;
        }
        if let Err(failure) = self.open(events) {
            self.failure = Some(failure);
            events.exit();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::Resized(size) => {
                self.size = size.into();
                if let Some((window, _)) = &self.window {
                    window.request_redraw();
                }
            }
            WindowEvent::CloseRequested | WindowEvent::Destroyed => events.exit(),
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
                if self.interface.has_keyboard() {
                    let key = match &event.logical_key {
                        WindowKey::Named(NamedKey::Enter) => Some(egui::Key::Enter),
                        WindowKey::Named(NamedKey::Escape) => Some(egui::Key::Escape),
                        WindowKey::Named(NamedKey::Backspace) => Some(egui::Key::Backspace),
                        _ => None,
                    };
                    self.interface.type_in(key, event.text.as_deref());
                }
                let key = name_of(&event.logical_key).and_then(|name| name.parse::<Key>().ok());
                if let Some(key) = key {
                    self.apply(Event::Key(key));
                }
            }
            WindowEvent::CursorMoved { position, .. } => {
                let [width, height] = self.size.map(|side| f64::from(side.max(1)));
                self.pointer = [position.x / width, position.y / height];
                self.apply(Event::Move(self.pointer));
            }
            WindowEvent::MouseInput { state, button, .. } => match (state, button) {
                (ElementState::Released, _) => self.apply(Event::Release),
                (ElementState::Pressed, button) => {
                    let second = button != MouseButton::Left;
                    self.apply(Event::Press { at: self.pointer, second });
                }
            },
            WindowEvent::MouseWheel { delta, .. } => self.apply(Event::Wheel(match delta {
                MouseScrollDelta::LineDelta(_, lines) => lines.into(),
                MouseScrollDelta::PixelDelta(pixels) => pixels.y / PIXELS_A_STEP,
            })),
            WindowEvent::RedrawRequested => {
                if let Err(failure) = self.draw() {
                    self.failure = Some(failure);
                    events.exit();
                }
            }
            _ => {}
        }
        if self.state.quit {
            events.exit();
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let is_coarse = self.drawn.as_ref().is_some_and(|(_, size)| *size != self.size);
        let rests = Instant::now() >= self.rest;
        let wait = if is_coarse && !rests { ControlFlow::WaitUntil(self.rest) } else { ControlFlow::Wait };
        events.set_control_flow(wait);
        if let Some((window, _)) = self.window.as_ref().filter(|_| self.goes_on() || is_coarse && rests) {
            window.request_redraw();
        }
    }
}
