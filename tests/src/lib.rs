//! What the GPU tests share.
