//! The quality ladder: what accuracy costs is the host's choice, made for each pass.

/// How the form factor's edge weight theta / sin theta is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum FormFactor {
    /// Minimax polynomial of degree 7: relative error 5e-7 of each edge, float32's own.
    #[default]
    Exact = 0,
    /// Minimax polynomial of degree 4: relative error 1.2e-4 of each edge, fewer instructions.
    Fast = 1,
}

/// The rungs that a pass is specialised for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Quality {
    /// How edges of the polygon are integrated.
    pub form_factor: FormFactor,
}
