//! What a lobe sees of an image by a few lookups in its pyramid: the float64 twins of `footprint.glsl`, and
//! the filter of Heitz et al. 2016 as a yardstick.

use super::shown::box_coordinate;
use crate::polygon::vector_form_factor;
use arealight::{Footprint, TextureMap};
use glam::{DVec2, DVec3};

/// How an image is looked up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filter {
    /// Heitz et al. 2016: once, at the foot of the perpendicular to the image's plane, with the plane's
    /// distance `r` as the only measure of the blur, `r / sqrt(2 A)`.
    Article,
    /// A quality level.
    Level(Footprint),
}

/// A textured light, in the cosine space of a lobe.
#[derive(Debug, Clone, PartialEq)]
pub struct LobeSpaceLight {
    /// The outline, not clipped.
    pub vertices: Vec<DVec3>,
    /// The middle of its area.
    pub center: DVec3,
    /// Where the image is.
    pub map: TextureMap,
    /// Texels of the light's box in both directions: the content's times the box's extent.
    pub texels: DVec2,
    /// Normals of half spaces that limit what is seen, in addition to the lobe's.
    pub horizons: Vec<DVec3>,
    /// Whether the outline is a convex quad (`LightShape::is_convex_quad`); others are split into triangles.
    pub convex_quad: bool,
}

/// The lobe's integral of the image over the light, signed as form factors are. `lookup` gives the image at a
/// texture coordinate, blurred by a standard deviation in units of the root of the box's area, in a metric in
/// which texels are as long in both directions: [`crate::texture::Pyramid::blurred`].
pub fn filtered(filter: Filter, light: &LobeSpaceLight, lookup: impl Fn(DVec2, f64) -> DVec3) -> DVec3 {
    let whole = Part { low: DVec2::ZERO, high: DVec2::ONE, parts: 1.0 };
    let lookup = |place: DVec2, sigma: f64| lookup(light.map.low + light.map.size * place, sigma);
    match filter {
        Filter::Article => {
            let (form_factor, _) = light.seen(&light.vertices);
            let normal = light.normal();
            let foot = normal * (normal.dot(light.map.corner) / normal.length_squared());
            let sigma = foot.length() / (2.0 * normal.length()).sqrt();
            lookup(whole.clamp(box_coordinate(&light.map, foot)), sigma) * form_factor
        }
        Filter::Level(Footprint::Round) => {
            let (form_factor, hit) = light.seen(&light.vertices);
            let square = hit.length_squared();
            let sigma = (square / (WHOLE.bump * light.normal().length() + WHOLE.end * square)).sqrt();
            lookup(whole.clamp(box_coordinate(&light.map, hit)), sigma) * form_factor
        }
        Filter::Level(Footprint::Ellipse) => {
            let taps = [-1.363, -0.378, 0.378, 1.363];
            light.part(&light.vertices, &whole, &taps, &lookup)
        }
        Filter::Level(Footprint::Split) => light.parts(4, &lookup),
    }
}

/// The constants of a footprint. Found by search over `shading::poses`, through the pyramid.
struct Shape {
    /// The lobe's bump: its variance is the squared distance to the point seen, over this.
    bump: f64,
    /// Where the light or its part ends: the inverse of the largest variance, in its size. That of an even
    /// spread is 12; a whole light's image is mirrored at its ends, so that a wider blur is more even.
    end: f64,
    /// How much blurrier taps are than they are apart.
    overlap: f64,
}

/// Of a whole light.
const WHOLE: Shape = Shape { bump: 1.5, end: 6.0, overlap: 1.15 };

/// Of one of the parts, which mostly see a slope of the bump.
const SPLIT: Shape = Shape { bump: 2.0, end: 10.0, overlap: 1.5 };

/// The end of parts far away: Gaussians of half their distance add up to an even blur to a hundredth.
const SPLIT_AFAR: f64 = 4.0;

/// A part of a light in box coordinates, one of `parts` a side.
struct Part {
    low: DVec2,
    high: DVec2,
    parts: f64,
}

impl Part {
    /// The nearest place; `low` for NaN.
    fn clamp(&self, place: DVec2) -> DVec2 {
        let clamp = |x: f64, low: f64, high: f64| if x > low { x.min(high) } else { low };
        DVec2::new(clamp(place.x, self.low.x, self.high.x), clamp(place.y, self.low.y, self.high.y))
    }

    /// The place where one beyond an end is mirrored there, as images are.
    fn mirror(&self, place: DVec2) -> DVec2 {
        let from_low = self.low + (place - self.low).abs();
        self.clamp(self.high - (self.high - from_low).abs())
    }
}

impl LobeSpaceLight {
    fn normal(&self) -> DVec3 {
        self.map.axis_u.cross(self.map.axis_v)
    }

    /// The signed form factor of an outline, and the point of the plane that its light comes from.
    fn seen(&self, outline: &[DVec3]) -> (f64, DVec3) {
        let mut clipped = outline.to_vec();
        for horizon in &self.horizons {
            clipped = above(&clipped, *horizon);
        }
        let direction = vector_form_factor(&clipped);
        let normal = self.normal();
        let time = normal.dot(self.map.corner) / normal.dot(direction);
        (direction.z, if time.is_finite() { direction * time } else { DVec3::ZERO })
    }

    /// Taps along the longer axis of the footprint; the part's form factor times their mean.
    fn part(
        &self,
        outline: &[DVec3],
        part: &Part,
        taps: &[f64],
        lookup: &impl Fn(DVec2, f64) -> DVec3,
    ) -> DVec3 {
        let (form_factor, hit) = self.seen(outline);
        if form_factor == 0.0 {
            return DVec3::ZERO;
        }
        let place = part.clamp(box_coordinate(&self.map, hit));
        let shape = if part.parts > 1.0 { SPLIT } else { WHOLE };
        // The inverse of the covariance, in the metric of texels: of the lobe's bump, and of the part's end
        let stretch = (self.texels.x / self.texels.y).sqrt();
        let (u, v) = (self.map.axis_u / stretch, self.map.axis_v * stretch);
        let bump = shape.bump / hit.length_squared().max(f64::MIN_POSITIVE);
        // Parts that are seen from afar must add up to an even blur
        let distance = hit.length_squared() / self.normal().length();
        let far = if part.parts > 1.0 { 1.0 - 1.0 / (1.0 + distance * distance / 16.0) } else { 0.0 };
        let end = (shape.end + far * (SPLIT_AFAR - shape.end)) * part.parts * part.parts;
        let (xx, yy) =
            (bump * u.dot(u) + end / (stretch * stretch), bump * v.dot(v) + end * stretch * stretch);
        let xy = bump * u.dot(v);
        // Its eigenvalues, and the direction of the smaller one
        let (mean, skew) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let spread = skew.hypot(xy);
        let largest = mean + spread;
        let smallest = ((xx * yy - xy * xy) / largest).max(1e-6 * largest);
        let axis = if skew < 0.0 { DVec2::new(spread - skew, -xy) } else { DVec2::new(-xy, spread + skew) };
        let axis = axis.normalize_or_zero() / DVec2::new(stretch, stretch.recip());
        // Blur what one tap stands for, and lay them as far apart as makes up for the rest
        let (major, minor) = (smallest.recip(), largest.recip());
        let share = (shape.overlap / taps.len() as f64).powi(2);
        let variance = major.min(minor.max(share * major));
        let step = axis * (major - variance).sqrt();
        let tap = |offset: &f64| lookup(part.mirror(place + step * *offset), variance.sqrt());
        taps.iter().map(tap).sum::<DVec3>() * (form_factor / taps.len() as f64)
    }

    /// Two taps for each part: of a quad, or of the triangles about the center.
    fn parts(&self, parts: u32, lookup: &impl Fn(DVec2, f64) -> DVec3) -> DVec3 {
        if self.convex_quad {
            let vertex = |i: usize| self.vertices[i.min(self.vertices.len() - 1)];
            return self.quad(&[vertex(0), vertex(1), vertex(2), vertex(3)], parts, parts, lookup);
        }
        let next = self.vertices.iter().cycle().skip(1);
        let triangle =
            |(a, b): (&DVec3, &DVec3)| self.quad(&[self.center, *a, *b, *b], parts / 2, parts, lookup);
        self.vertices.iter().zip(next).map(triangle).sum()
    }

    /// A quad cut into `count` by `count`.
    fn quad(
        &self,
        quad: &[DVec3; 4],
        count: u32,
        parts: u32,
        lookup: &impl Fn(DVec2, f64) -> DVec3,
    ) -> DVec3 {
        let corner = |x: u32, y: u32| {
            let (s, t) = (f64::from(x) / f64::from(count), f64::from(y) / f64::from(count));
            quad[0].lerp(quad[1], s).lerp(quad[3].lerp(quad[2], s), t)
        };
        let mut sum = DVec3::ZERO;
        for cell in 0..count * count {
            let (x, y) = (cell % count, cell / count);
            let outline = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            let places = outline.map(|corner| box_coordinate(&self.map, corner));
            let low = places.into_iter().fold(DVec2::INFINITY, DVec2::min);
            let high = places.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
            sum += self.part(&outline, &Part { low, high, parts: f64::from(parts) }, &[-1.0, 1.0], lookup);
        }
        sum
    }
}

/// The part of a polygon on the side of `normal`.
fn above(polygon: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 2);
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (height_a, height_b) = (normal.dot(*a), normal.dot(*b));
        if height_a >= 0.0 {
            kept.push(*a);
        }
        if height_a * height_b < 0.0 {
            kept.push(a.lerp(*b, height_a / (height_a - height_b)));
        }
    }
    kept
}
