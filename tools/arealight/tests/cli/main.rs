//! The program as a user runs it, in one binary, since each links the engine.

mod command_line;
mod common;
#[cfg(target_os = "linux")]
mod compile_budget;
mod compiled;
mod eval;
mod export;
mod films;
mod hostile;
mod outputs;
mod pictures;
mod studio;
mod table;
mod view_record;
mod view_window;
