//! Typed arrays out of buffers. Every range is checked; a sparse accessor's values are put in place.

use crate::document::{Document, slice};
use crate::error::SceneError;
use crate::scene::MAX_TRIANGLES;
use gltf::json::accessor::{ComponentType, Type};

/// The most elements an accessor may have: the corners of as many triangles as a scene may have.
pub(crate) const MAX_ELEMENTS: u64 = 3 * MAX_TRIANGLES as u64;

/// What is made of an accessor's bytes takes so many times as much: the bytes, numbers, and others in the
/// world.
const COPIES: u64 = 4;

/// An accessor's elements, tightly packed.
struct Elements {
    bytes: Vec<u8>,
    component: ComponentType,
    normalized: bool,
}

/// Vectors of `N` floats (of 16, a matrix's columns): float components as they are, normalised integers as
/// fractions, others as whole numbers (`KHR_mesh_quantization`). None is NaN or infinite.
pub(crate) fn floats<const N: usize>(
    document: &Document,
    accessor: usize,
    field: &str,
) -> Result<Vec<[f32; N]>, SceneError> {
    let shape = match N {
        1 => Type::Scalar,
        2 => Type::Vec2,
        3 => Type::Vec3,
        4 => Type::Vec4,
        16 => Type::Mat4,
        _ => unreachable!("no accessor is read as vectors of {N}"),
    };
    let elements = elements(document, accessor, field, shape)?;
    let decode: fn(&[u8]) -> f32 = match (elements.component, elements.normalized) {
        (ComponentType::F32, _) => |b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        (ComponentType::U8, true) => |b| f32::from(b[0]) / 255.0,
        (ComponentType::U16, true) => |b| f32::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0,
        // The lowest number of two's complement stands for -1, too
        (ComponentType::I8, true) => |b| (f32::from(b[0].cast_signed()) / 127.0).max(-1.0),
        (ComponentType::I16, true) => |b| (f32::from(i16::from_le_bytes([b[0], b[1]])) / 32767.0).max(-1.0),
        (ComponentType::U8, false) => |b| f32::from(b[0]),
        (ComponentType::U16, false) => |b| f32::from(u16::from_le_bytes([b[0], b[1]])),
        (ComponentType::I8, false) => |b| f32::from(b[0].cast_signed()),
        (ComponentType::I16, false) => |b| f32::from(i16::from_le_bytes([b[0], b[1]])),
        (component @ ComponentType::U32, _) => {
            let problem = format!("components of type {component:?} are not supported here");
            return Err(document.invalid(field, problem));
        }
    };
    let size = elements.component.size();
    let vectors = elements.bytes.chunks_exact(size * N).map(|element| {
        let mut vector = [0.0; N];
        for (value, bytes) in vector.iter_mut().zip(element.chunks_exact(size)) {
            *value = decode(bytes);
        }
        vector
    });
    let vectors: Vec<[f32; N]> = vectors.collect();
    // The bytes go, and these numbers once others are made of them
    document.budget.give(2 * elements.bytes.len() as u64);
    match vectors.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        Some(bad) => Err(document.not_finite(format!("{field}[{bad}]"), vectors[bad])),
        None => Ok(vectors),
    }
}

/// Unsigned integers.
pub(crate) fn indices(document: &Document, accessor: usize, field: &str) -> Result<Vec<u32>, SceneError> {
    let elements = elements(document, accessor, field, Type::Scalar)?;
    let decode: fn(&[u8]) -> u32 = match elements.component {
        ComponentType::U8 => |b| u32::from(b[0]),
        ComponentType::U16 => |b| u32::from(u16::from_le_bytes([b[0], b[1]])),
        ComponentType::U32 => |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        component => return Err(document.invalid(field, format!("{component:?} cannot be an index"))),
    };
    Ok(elements.bytes.chunks_exact(elements.component.size()).map(decode).collect())
}

fn elements(document: &Document, index: usize, field: &str, expected: Type) -> Result<Elements, SceneError> {
    use gltf::json::validation::Checked::Valid;
    let accessor = document.root.accessors.get(index);
    let accessor = accessor.ok_or_else(|| document.invalid(field, "its accessor does not exist"))?;
    let (Valid(component), Valid(shape)) = (accessor.component_type, accessor.type_) else {
        return Err(document.invalid(format!("accessors[{index}]"), "has an unknown type"));
    };
    if shape != expected {
        let problem = format!("accessors[{index}] is {shape:?}, should be {expected:?}");
        return Err(document.invalid(field, problem));
    }
    let count = accessor.count.0;
    if count > MAX_ELEMENTS {
        return Err(document.too_large(format!("accessors[{index}].count"), count, MAX_ELEMENTS));
    }
    let size = component.0.size() * shape.multiplicity();
    document.take(format!("accessors[{index}]"), COPIES * count * size as u64)?;
    // Copy what the buffer view holds, or start from zeros
    let mut bytes = match accessor.buffer_view {
        Some(view) => {
            let offset = accessor.byte_offset.unwrap_or_default().0;
            packed(document, view.value(), offset, count, size, &format!("accessors[{index}]"))?
        }
        None => vec![0; count as usize * size],
    };
    // Put the sparse values in their places
    if let Some(sparse) = &accessor.sparse {
        let field = format!("accessors[{index}].sparse");
        let Valid(place) = sparse.indices.component_type else {
            return Err(document.invalid(field, "its indices have an unknown type"));
        };
        if sparse.count.0 > count {
            return Err(document.invalid(field, format!("has {} values for {count}", sparse.count.0)));
        }
        let view = |view: usize, offset: u64, size: usize, what: &str| {
            packed(document, view, offset, sparse.count.0, size, &format!("{field}.{what}"))
        };
        let width = place.0.size();
        let places =
            view(sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, width, "indices")?;
        let values = view(sparse.values.buffer_view.value(), sparse.values.byte_offset.0, size, "values")?;
        let mut least = 0;
        for (place, value) in places.chunks_exact(width).zip(values.chunks_exact(size)) {
            let place = place.iter().rev().fold(0_usize, |sum, byte| sum << 8 | usize::from(*byte));
            if place < least {
                return Err(document.invalid(field, format!("index {place} is not above the one before it")));
            }
            least = place + 1;
            let target = bytes.get_mut(place * size..(place + 1) * size);
            let target =
                target.ok_or_else(|| document.invalid(&field, format!("index {place} of {count}")))?;
            target.copy_from_slice(value);
        }
    }
    Ok(Elements { bytes, component: component.0, normalized: accessor.normalized })
}

/// `count` elements of `size` bytes from `offset` of a buffer view on, its stride removed.
fn packed(
    document: &Document,
    view: usize,
    offset: u64,
    count: u64,
    size: usize,
    field: &str,
) -> Result<Vec<u8>, SceneError> {
    if count == 0 {
        return Ok(Vec::new());
    }
    let (bytes, stride) = document.view(view)?;
    let stride = stride.unwrap_or(size) as u64;
    if stride < size as u64 {
        return Err(document.invalid(field, format!("a stride of {stride} for elements of {size} bytes")));
    }
    let length = stride.checked_mul(count - 1).and_then(|length| length.checked_add(size as u64));
    let range = length.and_then(|length| slice(bytes, offset, length)).ok_or_else(|| {
        let problem = format!("{count} elements from byte {offset} on do not fit bufferViews[{view}]");
        document.invalid(field, problem)
    })?;
    Ok(range.chunks(stride as usize).flat_map(|element| &element[..size]).copied().collect())
}
