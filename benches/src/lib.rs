//! Cost, and the error at that cost.
