//! The ways to compute a form factor that are compared: the library's, and the yardsticks, which are what
//! others do.

use crate::school::School;
use arealight_cases::hard::HardCase;

/// A way to compute a form factor.
#[derive(Debug, Clone, Copy)]
pub struct Method {
    /// A short name, for tables and arguments.
    pub name: &'static str,
    /// What it is.
    pub description: &'static str,
    /// It is no way of ours: that it breaks promises is expected.
    pub is_yardstick: bool,
    /// It takes convex polygons of up to four vertices only.
    quads_only: bool,
    /// The kernel's `METHOD`.
    pub(crate) id: u32,
}

/// The library's way in, as the kernel numbers it.
#[derive(Clone, Copy)]
#[repr(u32)]
enum Shape {
    Polygon = 0,
    Quad = 8,
}

/// The first of the kernel's yardsticks, `METHOD_YARDSTICK`.
const YARDSTICK: u32 = 32;

impl Method {
    const fn exact(name: &'static str, description: &'static str, shape: Shape) -> Self {
        Self {
            name,
            description,
            is_yardstick: false,
            quads_only: matches!(shape, Shape::Quad),
            id: shape as u32,
        }
    }

    const fn yardstick(name: &'static str, description: &'static str, id: u32) -> Self {
        Self { name, description, is_yardstick: true, quads_only: false, id }
    }

    const fn school(name: &'static str, school: School) -> Self {
        let quads_only = matches!(school, School::ClipByCases);
        Self { quads_only, ..Self::yardstick(name, school.description(), YARDSTICK + school as u32) }
    }

    /// The method of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        METHODS.iter().find(|method| method.name == name)
    }

    /// Whether the method is for such polygons. (The flat families' polygons of four vertices are convex. Of
    /// what is no polygon at all, any four vertices will do.)
    pub fn takes(&self, case: &HardCase) -> bool {
        let largest = case.offsets.iter().flatten().chain(&case.anchor).fold(0.0_f32, |m, c| m.max(c.abs()));
        let is_wild = !case.is_finite() || largest > 1e30;
        !self.quads_only || (case.offsets.len() <= 4 && (case.flat || is_wild))
    }
}

/// Every method, the yardsticks last.
pub static METHODS: &[Method] = &[
    Method::exact("polygon-exact", "any outline, exact", Shape::Polygon),
    Method::exact("quad-exact", "convex, exact", Shape::Quad),
    Method::school("sphere-horizon", School::SphereHorizon),
    Method::school("clipless", School::Clipless),
    Method::school("clip-by-cases", School::ClipByCases),
    Method::yardstick(
        "clip-and-acos",
        "any outline clipped; acos(clamp(x, -.9999, .9999)), normalised cross products (the first listing of \
        Heitz et al. 2016)",
        35,
    ),
];
