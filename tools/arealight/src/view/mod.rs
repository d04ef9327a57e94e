//! The viewer: what a person does to a scene, and what is drawn of it. A window, or a recording without one,
//! gives the events and shows the frames: `state` knows no device, `viewer` no event.

mod lamps;
mod orbit;
mod paint;
mod script;
mod state;
mod viewer;
#[cfg(feature = "view")]
mod window;

pub use paint::paint;
pub use script::Script;
pub use state::{Mode, State};
pub use viewer::{Engines, Shown, Viewer};
#[cfg(feature = "view")]
pub use window::show;
