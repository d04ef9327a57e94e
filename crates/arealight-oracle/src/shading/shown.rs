//! An image in space: what shows where, and its pieces between which it does not bend.

use crate::cubature::Region;
use crate::frame::SurfaceFrame;
use crate::texture::Texture;
use arealight::TextureMap;
use glam::{DMat3, DVec2, DVec3};
use std::sync::Arc;

/// The image that a light shows, relative to a shading point.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownImage {
    /// The image, which multiplies the radiance.
    pub texture: Arc<Texture>,
    /// Where it is.
    pub map: TextureMap,
}

impl ShownImage {
    /// The same in the surface frame.
    pub(crate) fn in_frame(&self, frame: &SurfaceFrame) -> Self {
        let TextureMap { corner, axis_u, axis_v, low, size } = self.map;
        let [corner, axis_u, axis_v] = [corner, axis_u, axis_v].map(|vector| frame.to_surface(vector));
        Self { texture: Arc::clone(&self.texture), map: TextureMap { corner, axis_u, axis_v, low, size } }
    }
}

/// A map behind a linear transform.
pub(crate) fn transformed(map: &TextureMap, matrix: &DMat3) -> TextureMap {
    let TextureMap { corner, axis_u, axis_v, low, size } = *map;
    TextureMap { corner: *matrix * corner, axis_u: *matrix * axis_u, axis_v: *matrix * axis_v, low, size }
}

/// The point at box coordinates.
pub(crate) fn point(map: &TextureMap, place: DVec2) -> DVec3 {
    map.corner + map.axis_u * place.x + map.axis_v * place.y
}

/// The box coordinates of a point of the image's plane. Not finite for an image without area.
pub(crate) fn box_coordinate(map: &TextureMap, point: DVec3) -> DVec2 {
    let normal = map.axis_u.cross(map.axis_v);
    let offset = point - map.corner;
    let along = DVec2::new(offset.cross(map.axis_v).dot(normal), map.axis_u.cross(offset).dot(normal));
    along / normal.length_squared()
}

impl ShownImage {
    /// The image in a direction from the shading point.
    pub(crate) fn color(&self, direction: DVec3) -> DVec3 {
        let normal = self.map.axis_u.cross(self.map.axis_v);
        let time = normal.dot(self.map.corner) / normal.dot(direction);
        let place = box_coordinate(&self.map, direction * time);
        self.texture.sample(self.map.low + self.map.size * place)
    }

    /// The outline of a light, in parts on which the image does not bend: an integrand that holds it is
    /// smooth there. An image of more texels than `most` is left whole.
    pub(crate) fn region(&self, vertices: &[DVec3], most: usize) -> Region {
        let outline: Vec<DVec2> = vertices.iter().map(|vertex| box_coordinate(&self.map, *vertex)).collect();
        let texels = self.texture.width() * self.texture.height();
        if texels > most || !outline.iter().all(|place| place.is_finite()) {
            return Region::polygon(vertices);
        }
        let mut region = Region::default();
        for_each_piece(self, &outline, |_, part, sign| {
            let mut corners: Vec<DVec3> = part.iter().map(|place| point(&self.map, *place)).collect();
            if sign < 0.0 {
                corners.reverse();
            }
            region.extend(&corners);
        });
        region
    }
}

/// A rectangle in box coordinates on which a texture is bilinear.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece {
    pub low: DVec2,
    pub high: DVec2,
    /// At the corners (low, low), (high, low), (low, high), (high, high).
    values: [DVec3; 4],
}

impl Piece {
    /// The texture inside.
    pub fn color(&self, place: DVec2) -> DVec3 {
        let share = (place - self.low) / (self.high - self.low);
        let [a, b, c, d] = self.values;
        a.lerp(b, share.x).lerp(c.lerp(d, share.x), share.y)
    }

    /// In the order of an outline.
    pub fn corners(&self) -> [DVec2; 4] {
        let (low, high) = (self.low, self.high);
        [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
    }
}

/// Calls `visit` with each part of an outline, in box coordinates, that one piece of the texture covers: the
/// piece, the part's convex outline, and 1 or -1. The outline is a sum of signed triangles, so that concave
/// ones need no care.
pub(crate) fn for_each_piece(
    image: &ShownImage,
    outline: &[DVec2],
    mut visit: impl FnMut(&Piece, &[DVec2], f64),
) {
    let (texture, map) = (&*image.texture, &image.map);
    let cuts = |low: f64, size: f64, count: usize| -> Vec<f64> {
        // Where the texture bends: at the texels' centres
        let centers = (0..count).map(|i| ((i as f64 + 0.5) / count as f64 - low) / size);
        let inside = centers.filter(|place| *place > 0.0 && *place < 1.0);
        std::iter::once(0.0).chain(inside).chain(std::iter::once(1.0)).collect()
    };
    let columns = cuts(map.low.x, map.size.x, texture.width());
    let rows = cuts(map.low.y, map.size.y, texture.height());
    let parts = parts_of(outline);
    let mut clipped = Vec::new();
    for row in rows.windows(2) {
        for column in columns.windows(2) {
            let (low, high) = (DVec2::new(column[0], row[0]), DVec2::new(column[1], row[1]));
            let corners = [low, DVec2::new(high.x, low.y), DVec2::new(low.x, high.y), high];
            let piece =
                Piece { low, high, values: corners.map(|place| texture.sample(map.low + map.size * place)) };
            for part in &parts {
                clipped.clear();
                clipped.extend(piece.corners());
                for side in &part.sides {
                    clip(&mut clipped, *side);
                }
                if clipped.len() >= 3 {
                    visit(&piece, &clipped, part.sign);
                }
            }
        }
    }
}

/// A convex part of an outline: `sides` are `a x + b y + c >= 0`.
struct Part {
    sides: Vec<DVec3>,
    sign: f64,
}

impl Part {
    /// The inside of a convex outline, whose doubled area has this sign.
    fn new(corners: &[DVec2], sign: f64) -> Self {
        let side = |(from, to): (&DVec2, &DVec2)| {
            let along = (*to - *from) * sign;
            // along x (place - from) >= 0
            DVec3::new(-along.y, along.x, along.y * from.x - along.x * from.y)
        };
        Self { sides: corners.iter().zip(corners.iter().cycle().skip(1)).map(side).collect(), sign }
    }
}

/// The box itself where the outline is it, or the whole of a convex outline; else the triangles of a fan.
fn parts_of(outline: &[DVec2]) -> Vec<Part> {
    let is_corner = |place: &DVec2| {
        [place.x, place.y].iter().all(|x| x.abs().min((x - 1.0).abs()) < BOX) // no rounding makes a sliver
    };
    let doubled_area: f64 =
        outline.iter().zip(outline.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum();
    if outline.len() == 4 && outline.iter().all(is_corner) && (doubled_area.abs() - 2.0).abs() < 1e-6 {
        return vec![Part { sides: Vec::new(), sign: doubled_area.signum() }];
    }
    let whole = Part::new(outline, doubled_area.signum());
    let inside = |place: &DVec2| whole.sides.iter().all(|side| side.dot(place.extend(1.0)) >= -BOX);
    if doubled_area != 0.0 && outline.iter().all(inside) {
        return vec![whole];
    }
    let triangle = |pair: &[DVec2]| {
        let corners = [outline[0], pair[0], pair[1]];
        let doubled_area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
        if doubled_area == 0.0 {
            return None;
        }
        Some(Part::new(&corners, doubled_area.signum()))
    };
    outline.get(1..).unwrap_or_default().windows(2).filter_map(triangle).collect()
}

/// How far a vertex may be off a corner of the box, in its size.
const BOX: f64 = 1e-9;

/// Keeps what is on the positive side of `side`: the x and y coefficient, and the constant.
pub(crate) fn clip(corners: &mut Vec<DVec2>, side: DVec3) {
    let height = |place: DVec2| side.x * place.x + side.y * place.y + side.z;
    // Mostly nothing is cut
    let above = corners.iter().filter(|place| height(**place) >= 0.0).count();
    if above == corners.len() {
        return;
    }
    let whole = std::mem::take(corners);
    if above == 0 {
        return;
    }
    for (i, &a) in whole.iter().enumerate() {
        let b = whole[(i + 1) % whole.len()];
        let (h_a, h_b) = (height(a), height(b));
        if h_a >= 0.0 {
            corners.push(a);
        }
        if (h_a > 0.0 && h_b < 0.0) || (h_a < 0.0 && h_b > 0.0) {
            corners.push(a.lerp(b, h_a / (h_a - h_b)));
        }
    }
}
