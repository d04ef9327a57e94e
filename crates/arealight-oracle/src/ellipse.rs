//! The clamped cosine integrated over a flat ellipse, in closed form: the *form factor* of a disk light, and
//! of what a linear transform makes of one.
//!
//! The twin of `shaders/include/arealight/form_factor/ellipse.glsl` and `elliptic_arc.glsl`, step by step;
//! where float64 allows, the same in fewer words. [`contour_form_factor`] is the same integral by another
//! way.
//!
//! # Accuracy
//! [`form_factor`]: 1e-14 where the point is not closer to the rim than a thousandth of the ellipse's size,
//! 1e-9 in contact at a millionth, relative to the ellipse as given; for far ellipses 1e-12 of what one that
//! faces the origin sends. [`contour_form_factor`] 1e-12, where its subdivision suffices (rims down to 1e-6
//! of the size away).

use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

/// The longer axis over the distance below which what crosses the horizon is summed over its area. There the
/// contour's terms would lose four digits; the rules' error is below 1e-13.
const SMALL: f64 = 1.0 / 64.0;

/// The points `center + cos(t) axis_u + sin(t) axis_v`, as seen from the origin, in a space whose z axis is
/// the normal.
///
/// The axes are any two conjugate ones. The front is where t runs counter-clockwise, so `axis_u x axis_v`
/// points to where it shines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// The center, from the shading point.
    pub center: DVec3,
    /// From the center to the outline at t = 0.
    pub axis_u: DVec3,
    /// From the center to the outline at t = pi / 2.
    pub axis_v: DVec3,
}

/// An ellipse in its principal frame, the normal pointing away from the point.
struct Principal {
    frame: DMat3,
    center: DVec3,
    major: f64,
    minor: f64,
}

/// A cone of directions (a cos t, b sin t, c) in its frame.
struct Cone {
    frame: DMat3,
    a: f64,
    b: f64,
    c: f64,
}

impl Ellipse {
    /// A disk of a radius, its front facing along `normal`, which must be a unit vector.
    pub fn disk(center: DVec3, normal: DVec3, radius: f64) -> Self {
        let (axis_u, axis_v) = normal.any_orthonormal_pair();
        // glam's pair makes a right-handed frame with the normal last
        Self { center, axis_u: axis_u * radius, axis_v: axis_v * radius }
    }

    /// The ellipse under a linear transform. One that mirrors turns front to back.
    #[must_use]
    pub fn transformed(&self, matrix: &DMat3) -> Self {
        Self { center: *matrix * self.center, axis_u: *matrix * self.axis_u, axis_v: *matrix * self.axis_v }
    }

    /// A point of the outline.
    pub fn point(&self, t: f64) -> DVec3 {
        self.center + self.axis_u * t.cos() + self.axis_v * t.sin()
    }

    /// Whether the origin is before the front.
    pub fn shows_front(&self) -> bool {
        self.axis_u.cross(self.axis_v).dot(self.center) < 0.0
    }

    /// The inscribed polygon of `count` vertices.
    pub fn polygon(&self, count: usize) -> Vec<DVec3> {
        (0..count).map(|i| self.point(TAU * i as f64 / count as f64)).collect()
    }

    fn principal(&self) -> Principal {
        let difference = self.axis_v.length_squared() - self.axis_u.length_squared();
        let twice = 2.0 * self.axis_u.dot(self.axis_v);
        let tangent = twice / (difference.abs() + difference.hypot(twice)).max(f64::MIN_POSITIVE);
        let cosine = 1.0 / 1.0_f64.hypot(tangent);
        let sine = cosine * tangent;
        let (longer, shorter) =
            if difference > 0.0 { (self.axis_v, self.axis_u) } else { (self.axis_u, self.axis_v) };
        let major = longer * cosine + shorter * sine;
        let minor = shorter * cosine - longer * sine;
        let unit_major = major.try_normalize().unwrap_or(DVec3::X);
        let minor = minor - unit_major * unit_major.dot(minor);
        let unit_minor = minor.try_normalize().unwrap_or_else(|| unit_major.any_orthonormal_vector());
        let normal = unit_major.cross(unit_minor);
        let normal = if normal.dot(self.center) < 0.0 { -normal } else { normal };
        let frame = DMat3::from_cols(unit_major, unit_minor, normal);
        let center = frame.transpose() * self.center;
        // On the plane of the ellipse the integral jumps: as in GLSL, it is seen from a little before it
        let center = center.with_z(center.z.max(1e-30 * (self.center.length() + major.length())));
        Principal { frame, center, major: major.length(), minor: minor.length() }
    }
}

/// The largest root l of x^2 / (a^2 + l) + y^2 / (b^2 + l) + h^2 / l = 1: Viete's formula for the root of the
/// largest size, and where that is negative the quadratic equation of the others.
fn confocal_root(ellipse: &Principal) -> f64 {
    let DVec3 { x, y, z } = ellipse.center.abs();
    let (a, b) = (ellipse.major, ellipse.minor);
    let (a2, b2, h2) = (a * a, b * b, z * z);
    let (x_room, y_room) = ((a - x) * (a + x), (b - y) * (b + y));
    let p = x_room + y_room - h2;
    let q = b2 * x_room - a2 * y * y - h2 * (a2 + b2);
    let r = a2 * b2 * h2;
    let size = p.abs();
    let radius_square = (p * p - 3.0 * q).max(0.0) / 9.0;
    let radius = radius_square.sqrt();
    let cube = (size * (2.0 * p * p - 9.0 * q) + 27.0 * if p > 0.0 { -r } else { r }) / 54.0;
    let k = (cube / (radius_square * radius).max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0);
    let angle = ((1.0 - k) * (1.0 + k)).sqrt().atan2(k);
    let largest = (2.0 * radius * (angle / 3.0).cos() + size / 3.0).max(f64::MIN_POSITIVE);
    let root = if p > 0.0 {
        let product = r / largest;
        let sum = -(q + product) / largest;
        let root = sum.hypot(2.0 * product.sqrt());
        if sum < 0.0 { 2.0 * product / (root - sum) } else { 0.5 * (root + sum) }
    } else {
        largest
    };
    root.clamp(h2, h2 + x * x + y * y)
}

/// The cone's axis in the ellipse's frame, of no particular length.
fn cone_axis(ellipse: &Principal, root: f64) -> DVec3 {
    let DVec3 { x, y, z } = ellipse.center;
    DVec3::new(x * (root / (ellipse.major.powi(2) + root)), y * (root / (ellipse.minor.powi(2) + root)), z)
}

fn vector(ellipse: &Principal, root: f64) -> DVec3 {
    let axis = cone_axis(ellipse, root);
    let across = ((ellipse.major.powi(2) + root) * (ellipse.minor.powi(2) + root)).sqrt();
    axis * (ellipse.center.z * ellipse.major * ellipse.minor / (across * axis.length_squared()))
}

fn cone(ellipse: &Principal, root: f64) -> Cone {
    let (a2, b2) = (ellipse.major.powi(2), ellipse.minor.powi(2));
    let axis = cone_axis(ellipse, root);
    let square = axis.length_squared() / root;
    let axis = axis.try_normalize().unwrap_or(DVec3::Z);
    // Two perpendiculars along which no component cancels
    let across = axis.y.hypot(axis.z);
    let first = DVec3::new(across, -axis.x * axis.y / across, -axis.x * axis.z / across);
    let second = DVec3::new(0.0, axis.z / across, -axis.y / across);
    // Between them, a sum in which nothing cancels
    let turned = DVec3::new(ellipse.center.y / (b2 + root), -ellipse.center.x / (a2 + root), 0.0);
    let form = |m: DVec3, n: DVec3| {
        square * (a2 * m.x * n.x + b2 * m.y * n.y) + a2 * b2 * turned.dot(m) * turned.dot(n)
    };
    let (m11, m12, m22) = (form(first, first), form(first, second), form(second, second));
    let difference = m22 - m11;
    let hypotenuse = difference.hypot(2.0 * m12);
    let tangent = 2.0 * m12 / (difference.abs() + hypotenuse).max(f64::MIN_POSITIVE);
    let cosine = 1.0 / 1.0_f64.hypot(tangent);
    let sine = cosine * tangent;
    let (longer, shorter) = if difference > 0.0 { (second, first) } else { (first, second) };
    let a = (0.5 * (m11 + m22 + hypotenuse)).max(f64::MIN_POSITIVE).sqrt();
    let c = root.sqrt();
    let b = (ellipse.center.z * ellipse.major * ellipse.minor / (a * c)).min(a);
    let frame = DMat3::from_cols(longer * cosine + shorter * sine, shorter * cosine - longer * sine, axis);
    Cone { frame, a, b, c }
}

impl Cone {
    /// The integral of p x dp / |p|^2 over the outline from `middle - half` to `middle + half`, in the cone's
    /// frame.
    fn arc(&self, middle: [f64; 2], half: [f64; 2]) -> DVec3 {
        let ([cs, ss], [ch, sh], &Self { a, b, c, .. }) = (middle, half, self);
        let (p, q, e) = (c * c + a * a, c * c + b * b, (a - b) * (a + b));
        let (cos_end, cos_begin) = (cs * ch - ss * sh, cs * ch + ss * sh);
        let sin_sin = (ss * ch + cs * sh) * (ss * ch - cs * sh);
        let pq = (p * q).sqrt();
        let turn = (2.0 * sh * ch * pq).atan2(p * cos_end * cos_begin + q * sin_sin);
        let turn = if ch < 0.0 { turn + TAU } else { turn };
        let eq = (e * q).sqrt();
        let denominator = q + e * cos_end * cos_begin;
        let lean = if eq > 1e-10 * q {
            (-2.0 * ss * sh * eq).atan2(denominator) / eq
        } else {
            -2.0 * ss * sh / denominator
        };
        let sum = q + e * (cs * cs + sh * sh);
        let ratio = 2.0 * cs.abs() * sh * (e * p).sqrt() / sum;
        let ends = ((q + e * cos_end * cos_end) * (q + e * cos_begin * cos_begin)).sqrt();
        let excess = if ratio < 0.01 {
            let square = ratio * ratio;
            1.0 + square * (1.0 / 3.0 + square * (0.2 + square * (1.0 / 7.0 + square / 9.0)))
        } else {
            ((1.0 + ratio) * sum / ends).ln() / ratio
        };
        DVec3::new(-2.0 * b * c * cs * sh / sum * excess, a * c * lean, a * b * turn / pq)
    }

    /// The form factor of the part above the horizon of a unit normal in the cone's frame, where the cone
    /// crosses it.
    fn above_horizon(&self, normal: DVec3) -> f64 {
        let Self { a, b, c, .. } = *self;
        let steepness = (a * normal.x).hypot(b * normal.y).max(f64::MIN_POSITIVE);
        let [cs, ss] = [a * normal.x / steepness, b * normal.y / steepness];
        let ch = (-c * normal.z / steepness).clamp(-1.0, 1.0);
        let sh = ((1.0 - ch) * (1.0 + ch)).sqrt();
        let cos_cos = (cs * ch - ss * sh) * (cs * ch + ss * sh);
        let sin_sin = (ss * ch - cs * sh) * (ss * ch + cs * sh);
        let closing = (2.0 * a * b * c * sh / steepness).atan2(c * c + a * a * cos_cos + b * b * sin_sin);
        (normal.dot(self.arc([cs, ss], [ch, sh])) + closing) / TAU
    }
}

/// The form factor of the part above the horizon of a small ellipse that crosses it, by Gauss rules over the
/// disk to which its axes map it: all terms have one sign, where those of the contour would cancel.
fn small_segment(ellipse: &Ellipse, principal: &Principal, rise: f64) -> f64 {
    // On the disk, the height's direction and the one across it
    let [u, v] = [ellipse.axis_u.z / rise, ellipse.axis_v.z / rise];
    let along = ellipse.axis_u * u + ellipse.axis_v * v;
    let across = ellipse.axis_v * u - ellipse.axis_u * v;
    let height = ellipse.center.z;
    let half = ((rise - height) * (rise + height)).sqrt().atan2(-height);
    let strip = |angle: f64| {
        // The height cos(angle) - cos(half) as a product
        let above = 2.0 * (0.5 * (half + angle)).sin() * (0.5 * (half - angle)).sin();
        let width = angle.sin();
        let density = |w: f64| {
            let point = ellipse.center + along * angle.cos() + across * (w * width);
            point.length_squared().powi(-2)
        };
        above * width * width * gauss(&density, -1.0, 1.0)
    };
    let middle = 0.5 * half;
    let sum = gauss(&strip, 0.0, middle) + gauss(&strip, middle, half);
    principal.center.z * principal.major * principal.minor * rise * sum / PI
}

/// The integral of the direction over pi, over the directions that the whole ellipse covers: of whatever side
/// is seen.
pub fn vector_form_factor(ellipse: &Ellipse) -> DVec3 {
    let principal = ellipse.principal();
    principal.frame * vector(&principal, confocal_root(&principal))
}

/// The signed integral of the clamped cosine `max(0, cos) / pi` over an ellipse, in [-1, 1]: positive where
/// its front faces the origin. What lies below z = 0 is clipped. An ellipse that is not finite gives 0.
pub fn form_factor(ellipse: &Ellipse) -> f64 {
    let rise = ellipse.axis_u.z.hypot(ellipse.axis_v.z);
    let finite = ellipse.center.is_finite() && ellipse.axis_u.is_finite() && ellipse.axis_v.is_finite();
    if !finite || ellipse.center.z <= -rise {
        return 0.0;
    }
    let principal = ellipse.principal();
    let root = confocal_root(&principal);
    let up = principal.frame.row(2);
    let value = if ellipse.center.z >= rise {
        vector(&principal, root).dot(up)
    } else if principal.major < SMALL * principal.center.length() {
        small_segment(ellipse, &principal, rise)
    } else {
        let cone = cone(&principal, root);
        cone.above_horizon(cone.frame.transpose() * up)
    };
    let sign = if ellipse.shows_front() { 1.0 } else { -1.0 };
    if value.is_finite() { sign * value.clamp(0.0, 1.0) } else { 0.0 }
}

/// As [`form_factor`], by adaptive quadrature of Lambert's contour integral over the outline above the
/// horizon, and the angle that closes it there.
pub fn contour_form_factor(ellipse: &Ellipse) -> f64 {
    let rise = ellipse.axis_u.z.hypot(ellipse.axis_v.z);
    if ellipse.center.z <= -rise {
        return 0.0;
    }
    let whole = ellipse.center.z >= rise;
    let middle = ellipse.axis_v.z.atan2(ellipse.axis_u.z);
    let height = ellipse.center.z;
    let half = if whole { PI } else { ((rise - height) * (rise + height)).sqrt().atan2(-height) };
    let integrand = |t: f64| {
        let p = ellipse.point(t);
        let dp = ellipse.axis_v * t.cos() - ellipse.axis_u * t.sin();
        p.cross(dp).z / p.length_squared()
    };
    let mut sum = adaptive(&integrand, middle - half, middle + half, 1e-13);
    if !whole {
        let (from, to) = (ellipse.point(middle + half), ellipse.point(middle - half));
        sum += (from.x * to.y - from.y * to.x).atan2(from.x * to.x + from.y * to.y);
    }
    // Counter-clockwise from the front is clockwise about the direction to the light
    -sum / TAU
}

/// The integral of a smooth function from `low` to `high`, halving intervals until an eight-point and two
/// eight-point Gauss rules agree to `tolerance` or to 1e-13 of the value.
pub(crate) fn adaptive(f: &impl Fn(f64) -> f64, low: f64, high: f64, tolerance: f64) -> f64 {
    const PIECES: usize = 8;
    let edge = |i: usize| low + (high - low) * i as f64 / PIECES as f64;
    (0..PIECES).map(|i| refined(f, edge(i), edge(i + 1), gauss(f, edge(i), edge(i + 1)), tolerance, 48)).sum()
}

fn refined(f: &impl Fn(f64) -> f64, low: f64, high: f64, whole: f64, tolerance: f64, depth: u32) -> f64 {
    let middle = 0.5 * (low + high);
    let halves = [gauss(f, low, middle), gauss(f, middle, high)];
    let sum = halves[0] + halves[1];
    let allowed = tolerance.max(1e-13 * sum.abs());
    if depth == 0 || (sum - whole).abs() <= allowed {
        return sum;
    }
    refined(f, low, middle, halves[0], tolerance, depth - 1)
        + refined(f, middle, high, halves[1], tolerance, depth - 1)
}

/// The eight-point Gauss-Legendre rule.
fn gauss(f: &impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    const NODES: [[f64; 2]; 4] = [
        [0.183_434_642_495_649_8, 0.362_683_783_378_362],
        [0.525_532_409_916_329, 0.313_706_645_877_887_3],
        [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
        [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
    ];
    let (center, half) = (0.5 * (low + high), 0.5 * (high - low));
    half * NODES.iter().map(|[x, w]| w * (f(center - half * x) + f(center + half * x))).sum::<f64>()
}
