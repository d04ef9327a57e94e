//! Fits linearly transformed cosines.
