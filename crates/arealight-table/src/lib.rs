//! Light tables to and from files.
