//! What a module says of itself: bindings, names, decorations and layouts, read from its SPIR-V.

use arealight::kernels::{Access, BindingKind, Kernel};
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op};
use std::collections::BTreeMap;

pub fn module(kernel: &Kernel) -> Module {
    parsed(&kernel.words())
}

pub fn parsed(words: &[u32]) -> Module {
    let mut loader = rspirv::dr::Loader::new();
    rspirv::binary::parse_words(words, &mut loader).expect("the module parses");
    loader.module()
}

pub fn literal(operand: &Operand) -> u32 {
    match operand {
        Operand::LiteralBit32(value) | Operand::IdRef(value) => *value,
        other => panic!("{other:?} is no 32-bit literal"),
    }
}

/// The operands of a decoration of `id`, if it has it.
pub fn decoration(module: &Module, id: u32, wanted: Decoration) -> Option<Vec<Operand>> {
    module.annotations.iter().find_map(|i| {
        let matches = i.class.opcode == Op::Decorate
            && i.operands[0] == Operand::IdRef(id)
            && i.operands[1] == Operand::Decoration(wanted);
        matches.then(|| i.operands[2..].to_vec())
    })
}

pub fn member_decorations(module: &Module, id: u32, wanted: Decoration) -> BTreeMap<u32, Vec<Operand>> {
    let of_type = module.annotations.iter().filter(|i| {
        i.class.opcode == Op::MemberDecorate
            && i.operands[0] == Operand::IdRef(id)
            && i.operands[2] == Operand::Decoration(wanted)
    });
    of_type.map(|i| (literal(&i.operands[1]), i.operands[3..].to_vec())).collect()
}

pub fn name(module: &Module, id: u32) -> String {
    let names = module.debug_names.iter();
    let mut named = names.filter(|i| i.class.opcode == Op::Name && i.operands[0] == Operand::IdRef(id));
    match named.next().map(|i| &i.operands[1]) {
        Some(Operand::LiteralString(text)) => text.clone(),
        _ => String::new(),
    }
}

pub fn member_name(module: &Module, id: u32, member: u32) -> String {
    let mut names = module.debug_names.iter().filter(|i| {
        i.class.opcode == Op::MemberName
            && i.operands[0] == Operand::IdRef(id)
            && literal(&i.operands[1]) == member
    });
    match names.next().map(|i| &i.operands[2]) {
        Some(Operand::LiteralString(text)) => text.clone(),
        _ => panic!("member {member} of %{id} has no name"),
    }
}

pub fn definition(module: &Module, id: u32) -> &Instruction {
    module.types_global_values.iter().find(|i| i.result_id == Some(id)).expect("ids are defined")
}

pub fn pointee<'a>(module: &'a Module, variable: &Instruction) -> &'a Instruction {
    let pointer = definition(module, variable.result_type.expect("variables are typed"));
    definition(module, literal(&pointer.operands[1]))
}

/// The variables with a binding, by binding number.
pub fn bound_variables(module: &Module) -> BTreeMap<u32, &Instruction> {
    let variables = module.types_global_values.iter().filter(|i| i.class.opcode == Op::Variable);
    variables
        .filter_map(|variable| {
            let id = variable.result_id?;
            let binding = literal(&decoration(module, id, Decoration::Binding)?[0]);
            let set = literal(&decoration(module, id, Decoration::DescriptorSet)?[0]);
            assert_eq!(set, 0, "all bindings are in set 0");
            Some((binding, variable))
        })
        .collect()
}

/// What the GLSL calls a binding, and the kind and access that its type and decorations say.
pub fn reflected(module: &Module, variable: &Instruction) -> (String, BindingKind, Access) {
    let (kind, access) = kind_and_access(module, variable);
    (binding_name(module, variable), kind, access)
}

fn kind_and_access(module: &Module, variable: &Instruction) -> (BindingKind, Access) {
    let kind = pointee(module, variable);
    let id = variable.result_id.expect("a variable has an id");
    if kind.class.opcode == Op::TypeSampledImage {
        return (BindingKind::FilteredImage, Access::Read);
    }
    if kind.class.opcode == Op::TypeImage {
        // Operand 5: 1 is sampled, 2 is storage
        if literal(&kind.operands[5]) == 1 {
            return (BindingKind::SampledImage, Access::Read);
        }
        let has = |wanted| decoration(module, id, wanted).is_some();
        let access = match (has(Decoration::NonWritable), has(Decoration::NonReadable)) {
            (true, _) => Access::Read,
            (false, true) => Access::Write,
            (false, false) => Access::ReadWrite,
        };
        return (BindingKind::StorageImage, access);
    }
    let block = kind.result_id.expect("a type has an id");
    let all = |wanted| {
        decoration(module, id, wanted).is_some()
            || member_decorations(module, block, wanted).len() == kind.operands.len()
    };
    let access = match (all(Decoration::NonWritable), all(Decoration::NonReadable)) {
        (true, false) => Access::Read,
        (false, true) => Access::Write,
        _ => Access::ReadWrite,
    };
    (BindingKind::StorageBuffer, access)
}

/// What the GLSL calls a binding: an image by its variable, a buffer by its block's only member.
fn binding_name(module: &Module, variable: &Instruction) -> String {
    let kind = pointee(module, variable);
    if matches!(kind.class.opcode, Op::TypeImage | Op::TypeSampledImage) {
        return name(module, variable.result_id.expect("a variable has an id"));
    }
    assert_eq!(kind.operands.len(), 1, "a buffer's block has one member");
    member_name(module, kind.result_id.expect("a type has an id"), 0)
}

/// Member names and offsets of the structure named `wanted`, with and without a layout being two types.
pub fn offsets(module: &Module, wanted: &str) -> Option<Vec<(String, u32)>> {
    let structs = module.types_global_values.iter().filter(|i| i.class.opcode == Op::TypeStruct);
    structs.filter_map(|i| i.result_id).filter(|&id| name(module, id) == wanted).find_map(|id| {
        let offsets = member_decorations(module, id, Decoration::Offset);
        (!offsets.is_empty())
            .then(|| offsets.iter().map(|(&m, o)| (member_name(module, id, m), literal(&o[0]))).collect())
    })
}
