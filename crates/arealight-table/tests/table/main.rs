//! Tables in files: those that are good, those that are not, and the one that is built in.

mod built_in;
mod convert;
mod draft;
mod files;
mod hostile;
mod published;
mod random_damage;
mod source;
mod textures;
