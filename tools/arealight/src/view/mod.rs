//! The viewer: what a person does to a scene, and what is drawn of it. A window, or a recording without one,
//! gives the events and shows the frames: `state` knows no device, `viewer` no event.

mod costs;
mod interface;
mod lamps;
mod look;
mod orbit;
mod paint;
mod panel;
mod script;
mod state;
mod viewer;
mod window;

pub use interface::Interface;
pub use look::Look;
pub use paint::paint;
pub use script::Script;
pub use state::{Mode, State};
pub use viewer::{Engines, Shown, Viewer};
pub use window::show;
