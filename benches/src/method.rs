//! The ways to compute a form factor that are compared: the library's rungs by each of its ways in, and the
//! yardsticks, which are what others do.

use arealight::FormFactor;
use arealight_oracle::hard::HardCase;
use arealight_oracle::hard::promise::Promises;

/// A way to compute a form factor.
#[derive(Debug, Clone, Copy)]
pub struct Method {
    /// A short name, for tables and arguments.
    pub name: &'static str,
    /// What it is.
    pub description: &'static str,
    /// What it is held to: its own promises, or for a yardstick those of the best rung.
    pub promises: Promises,
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
    Walk = 0,
    Quad = 8,
    BareQuad = 16,
    BareWalk = 24,
}

/// The bit of the one-point form, `AREALIGHT_FORM_FACTOR_ONE_POINT`.
const ONE_POINT: u32 = 4;

/// What each rung promises.
pub const fn promises(rung: FormFactor) -> Promises {
    match rung {
        FormFactor::Exact => Promises::EXACT,
        FormFactor::Fast => Promises::FAST,
        FormFactor::ExactDifference => Promises::EXACT_DIFFERENCE,
        FormFactor::FastDifference => Promises::FAST_DIFFERENCE,
    }
}

impl Method {
    const fn rung(name: &'static str, description: &'static str, shape: Shape, rung: FormFactor) -> Self {
        Self {
            name,
            description,
            promises: promises(rung),
            is_yardstick: false,
            quads_only: matches!(shape, Shape::Quad | Shape::BareQuad),
            id: shape as u32 | rung as u32,
        }
    }

    const fn yardstick(name: &'static str, description: &'static str, id: u32) -> Self {
        let promises = Promises::EXACT_DIFFERENCE;
        Self { name, description, promises, is_yardstick: true, quads_only: false, id }
    }

    const fn one_point() -> Self {
        let promises = Promises { of_form_factor: 1e-4, ..Promises::EXACT_DIFFERENCE };
        let description = "convex, exact, difference form; far lights from their centre alone";
        let rung = Self::rung("quad-one-point", description, Shape::Quad, FormFactor::ExactDifference);
        Self { promises, id: rung.id | ONE_POINT, ..rung }
    }

    /// The method of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        METHODS.iter().find(|method| method.name == name)
    }

    /// Whether the method is for such polygons. (The flat families' polygons of four vertices are convex. Of what is no
    /// polygon at all, any four vertices will do.)
    pub fn takes(&self, case: &HardCase) -> bool {
        let largest = case.offsets.iter().flatten().chain(&case.anchor).fold(0.0_f32, |m, c| m.max(c.abs()));
        let is_wild = !case.is_finite() || largest > 1e30;
        !self.quads_only || (case.offsets.len() <= 4 && (case.flat || is_wild))
    }
}

/// Every method, the yardsticks last.
pub static METHODS: &[Method] = &[
    Method::rung("walk-exact", "any outline, exact", Shape::Walk, FormFactor::Exact),
    Method::rung("walk-fast", "any outline, fast", Shape::Walk, FormFactor::Fast),
    Method::rung(
        "walk-exact-difference",
        "any outline, exact, difference form",
        Shape::Walk,
        FormFactor::ExactDifference,
    ),
    Method::rung(
        "walk-fast-difference",
        "any outline, fast, difference form",
        Shape::Walk,
        FormFactor::FastDifference,
    ),
    Method::rung("quad-exact", "convex, exact", Shape::Quad, FormFactor::Exact),
    Method::rung("quad-fast", "convex, fast", Shape::Quad, FormFactor::Fast),
    Method::rung(
        "quad-exact-difference",
        "convex, exact, difference form",
        Shape::Quad,
        FormFactor::ExactDifference,
    ),
    Method::rung(
        "quad-fast-difference",
        "convex, fast, difference form",
        Shape::Quad,
        FormFactor::FastDifference,
    ),
    Method::rung(
        "bare-quad-exact",
        "convex, exact; without clip where the library's test allows",
        Shape::BareQuad,
        FormFactor::Exact,
    ),
    Method::rung(
        "bare-quad-fast",
        "convex, fast; without clip where the library's test allows",
        Shape::BareQuad,
        FormFactor::Fast,
    ),
    Method::rung(
        "bare-walk-exact",
        "any outline, exact; without clip where the library's test allows",
        Shape::BareWalk,
        FormFactor::Exact,
    ),
    Method::rung(
        "bare-walk-fast",
        "any outline, fast; without clip where the library's test allows",
        Shape::BareWalk,
        FormFactor::Fast,
    ),
    Method::one_point(),
    Method::yardstick("textbook", "clipped, acos(clamp(x, -.9999, .9999)), normalised cross products", 32),
    Method::yardstick("practice", "rational theta / sin(theta), guarded; a sphere's horizon, no clip", 33),
];
