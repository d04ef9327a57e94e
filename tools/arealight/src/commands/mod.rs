//! One module a command: its arguments, and what it does.

pub mod bench;
pub mod compare;
pub mod devices;
pub mod effects;
pub mod eval;
pub mod export;
pub mod fit;
pub mod inspect;
pub mod render;
pub mod shell;
pub mod table;
pub mod view;
