//! What a kernel is bound to.

/// What a binding holds. All are in descriptor set 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BindingKind {
    /// A sampled image, read by texel; no sampler.
    SampledImage,
    /// A sampled image with a sampler that is part of the layout: trilinear, clamped to the edge, normalised
    /// coordinates.
    FilteredImage,
    /// A storage image.
    StorageImage,
    /// A storage buffer.
    StorageBuffer,
}

/// What a kernel does to a binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Reads only.
    Read,
    /// Writes only.
    Write,
    /// Reads and writes.
    ReadWrite,
    /// Nothing: the binding is in the descriptor set for another kernel of the pass.
    None,
}

/// A binding of descriptor set 0; its number is its place in [`Kernel::bindings`](super::Kernel::bindings).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Binding {
    /// Its name in the GLSL.
    pub name: &'static str,
    /// What it holds.
    pub kind: BindingKind,
    /// What is done to it.
    pub access: Access,
    /// Content, encoding and smallest sufficient format.
    pub content: &'static str,
}

impl Binding {
    /// The same binding of a kernel that does not use it.
    #[must_use]
    pub const fn unused(self) -> Self {
        Self { access: Access::None, ..self }
    }

    /// A storage buffer.
    pub const fn storage_buffer(name: &'static str, access: Access, content: &'static str) -> Self {
        Self { name, kind: BindingKind::StorageBuffer, access, content }
    }
}
