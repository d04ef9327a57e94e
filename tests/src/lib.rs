//! The GPU against the oracle.
