//! What a translated kernel binds, and how its buffers are laid out, for the manifest: read from the kernel
//! itself.

use super::translate::{Slot, globals, is_written};
use naga::{AddressSpace, ImageClass, Module, ScalarKind, StructMember, TypeInner};
use serde_json::{Map, Value, json};

/// A kernel's workgroup, bindings and the structs in them.
pub fn describe(module: &Module, slots: &[Slot]) -> Map<String, Value> {
    let (mut bindings, mut structs) = (vec![], Map::new());
    for (binding, variable) in globals(module) {
        let inner = &module.types[variable.ty].inner;
        let name = variable.name.as_deref().unwrap_or_default();
        let mut described = json!({
            "group": binding.group,
            "binding": binding.binding,
            "name": name_of(module, inner, name),
            "kind": kind(inner, variable.space, is_written(module, variable)),
        });
        if let Some(slot) = slots.iter().find(|slot| slot.of.as_ref() == Some(&binding)) {
            described[slot.table] = slot.index.into();
        }
        if let Some((name, layout)) = layout(module, variable.ty) {
            described["of"] = name.clone().into();
            structs.insert(name, layout);
        }
        bindings.push(described);
    }
    let mut described = Map::new();
    if let Some(entry) = module.entry_points.first() {
        described.insert("workgroup_size".into(), json!(entry.workgroup_size));
    }
    described.insert("bindings".into(), bindings.into());
    if let Some(sizes) = slots.iter().find(|slot| slot.of.is_none()) {
        described.insert(
            "sizes_of_arrays".into(),
            json!({
                "buffer": sizes.index,
                "content": "u32[]: the size in bytes of each storage buffer, in the order of bindings",
            }),
        );
    }
    described.insert("structs".into(), structs.into());
    described
}

/// A binding's name: a block's is that of its one array, as in GLSL.
fn name_of(module: &Module, inner: &TypeInner, name: &str) -> String {
    match inner {
        TypeInner::Struct { members, .. } if is_array(module, members) => {
            members[0].name.clone().unwrap_or_else(|| name.to_owned())
        }
        _ => name.to_owned(),
    }
}

/// Whether a block is nothing but an array.
fn is_array(module: &Module, members: &[StructMember]) -> bool {
    matches!(members, [one] if matches!(module.types[one.ty].inner, TypeInner::Array { .. }))
}

fn kind(inner: &TypeInner, space: AddressSpace, is_written: bool) -> String {
    match (inner, space) {
        (TypeInner::Image { arrayed, class: ImageClass::Storage { .. }, .. }, _) => {
            format!("storage texture, 2d{}, rgba32float, written", if *arrayed { " array" } else { "" })
        }
        (TypeInner::Image { arrayed, .. }, _) => {
            format!("texture, 2d{}, float", if *arrayed { " array" } else { "" })
        }
        (TypeInner::Sampler { .. }, _) => "sampler: trilinear, clamped to the edge".into(),
        (_, AddressSpace::Uniform) => "uniform buffer".into(),
        _ if is_written => "storage buffer, read and written".into(),
        _ => "storage buffer, read".into(),
    }
}

/// The name and layout of the struct that a buffer is, or is an array of.
fn layout(module: &Module, of: naga::Handle<naga::Type>) -> Option<(String, Value)> {
    let named = &module.types[of];
    match &named.inner {
        TypeInner::Array { base, .. } => layout(module, *base),
        TypeInner::Struct { members, .. } if is_array(module, members) => layout(module, members[0].ty),
        TypeInner::Struct { members, span } => {
            let fields: Vec<_> = members
                .iter()
                .map(|member| {
                    json!({ "name": member.name, "offset": member.offset,
                        "type": type_name(&module.types[member.ty].inner) })
                })
                .collect();
            Some((named.name.clone().unwrap_or_default(), json!({ "size": span, "fields": fields })))
        }
        _ => None,
    }
}

/// A type of a field, as WGSL writes it.
fn type_name(inner: &TypeInner) -> String {
    let scalar = |scalar: &naga::Scalar| match scalar.kind {
        ScalarKind::Sint => "i32",
        ScalarKind::Uint => "u32",
        _ => "f32",
    };
    match inner {
        TypeInner::Scalar(one) => scalar(one).into(),
        TypeInner::Vector { size, scalar: one } => format!("vec{}<{}>", *size as u8, scalar(one)),
        TypeInner::Matrix { columns, rows, scalar: one } => {
            format!("mat{}x{}<{}>", *columns as u8, *rows as u8, scalar(one))
        }
        _ => "other".into(),
    }
}
