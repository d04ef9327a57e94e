//! What a SPIR-V module says of itself: bindings, constants, group size.

use super::binding::{Access, Binding, BindingKind, content};
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

// The SPIR-V specification, 3: instructions, decorations, storage classes
const HEADER: usize = 5;
const NAME: u32 = 5;
const MEMBER_NAME: u32 = 6;
const EXECUTION_MODE: u32 = 16;
const TYPE_INT: u32 = 21;
const TYPE_FLOAT: u32 = 22;
const TYPE_VECTOR: u32 = 23;
const TYPE_MATRIX: u32 = 24;
const TYPE_IMAGE: u32 = 25;
const TYPE_SAMPLED_IMAGE: u32 = 27;
const TYPE_ARRAY: u32 = 28;
const TYPE_STRUCT: u32 = 30;
const TYPE_POINTER: u32 = 32;
const CONSTANT: u32 = 43;
const FUNCTION: u32 = 54;
const VARIABLE: u32 = 59;
const DECORATE: u32 = 71;
const MEMBER_DECORATE: u32 = 72;
const LOCAL_SIZE: u32 = 17;
const SPEC_ID: u32 = 1;
const ARRAY_STRIDE: u32 = 6;
const NON_WRITABLE: u32 = 24;
const NON_READABLE: u32 = 25;
const BINDING: u32 = 33;
const DESCRIPTOR_SET: u32 = 34;
const OFFSET: u32 = 35;
const PUSH_CONSTANT: u32 = 9;
const SAMPLED: u32 = 1;

/// What a kernel's module says; nothing of what a module lacks.
#[derive(Debug, Default)]
pub(super) struct Reflection {
    pub(super) local_size: [u32; 3],
    pub(super) push_constant_size: u32,
    /// Of set 0, by number.
    pub(super) bindings: Vec<Binding>,
    /// Ids, from the least on.
    pub(super) constants: Vec<u32>,
}

impl Reflection {
    pub(super) fn of(spirv: &'static [u8]) -> Self {
        let module = Module::read(spirv);
        let mut found = Self { local_size: module.local_size, ..Self::default() };
        let mut bindings = BTreeMap::new();
        for &(id, pointer) in &module.variables {
            let Some(&[TYPE_POINTER, _, class, pointee]) = module.types.get(&pointer).map(Vec::as_slice)
            else {
                continue;
            };
            if class == PUSH_CONSTANT {
                found.push_constant_size = module.size(pointee);
            } else if let Some(&number) = module.decorations.get(&(id, BINDING))
                && module.decorations.get(&(id, DESCRIPTOR_SET)) == Some(&0)
                && let Some(binding) = module.binding(number, id, pointee)
            {
                bindings.insert(number, binding);
            }
        }
        found.bindings = bindings.into_values().collect();
        let ids = module.decorations.iter().filter(|((_, decoration), _)| *decoration == SPEC_ID);
        found.constants = ids.map(|(_, id)| *id).collect();
        found.constants.sort_unstable();
        found
    }
}

/// The declarations of a module.
#[derive(Default)]
struct Module {
    local_size: [u32; 3],
    /// Of variables by id, and of each structure's first member.
    names: HashMap<u32, &'static str>,
    member_names: HashMap<u32, &'static str>,
    /// By id and decoration: its literal, or 0.
    decorations: HashMap<(u32, u32), u32>,
    /// By structure, decoration and member.
    member_decorations: BTreeMap<(u32, u32, u32), u32>,
    /// Types and constants by id: the opcode, then the words after the first.
    types: HashMap<u32, Vec<u32>>,
    /// With the pointers to their types.
    variables: Vec<(u32, u32)>,
}

impl Module {
    fn read(spirv: &'static [u8]) -> Self {
        let words: Vec<u32> =
            spirv.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        let mut module = Self::default();
        let mut at = HEADER;
        while let Some(&first) = words.get(at) {
            let end = (at + (first >> 16).max(1) as usize).min(words.len());
            if first & 0xffff == FUNCTION {
                break;
            }
            module.add(first & 0xffff, &words[at + 1..end], |from| text(spirv, at + 1 + from..end));
            at = end;
        }
        module
    }

    /// Takes up an instruction with its operands; `text` reads a string from an operand on.
    fn add(&mut self, code: u32, operands: &[u32], text: impl Fn(usize) -> &'static str) {
        match (code, operands) {
            (NAME, [id, ..]) => _ = self.names.insert(*id, text(1)),
            (MEMBER_NAME, [id, 0, ..]) => _ = self.member_names.insert(*id, text(2)),
            (EXECUTION_MODE, [_, LOCAL_SIZE, x, y, z]) => self.local_size = [*x, *y, *z],
            (DECORATE, [id, decoration, rest @ ..]) => {
                self.decorations.insert((*id, *decoration), rest.first().copied().unwrap_or(0));
            }
            (MEMBER_DECORATE, [id, member, decoration, rest @ ..]) => {
                let literal = rest.first().copied().unwrap_or(0);
                self.member_decorations.insert((*id, *decoration, *member), literal);
            }
            (CONSTANT, [_, id, ..]) | (TYPE_INT..=TYPE_POINTER, [id, ..]) => {
                self.types.insert(*id, [&[code], operands].concat());
            }
            (VARIABLE, [pointer, id, ..]) => self.variables.push((*id, *pointer)),
            _ => {}
        }
    }

    /// A variable of this type; none where it is no binding that a kernel may have.
    fn binding(&self, number: u32, id: u32, pointee: u32) -> Option<Binding> {
        let types = self.types.get(&pointee)?;
        let has = |decoration| self.decorations.contains_key(&(id, decoration));
        let (kind, name, [is_read_only, is_write_only]) = match types.as_slice() {
            [TYPE_SAMPLED_IMAGE, ..] => (BindingKind::FilteredImage, self.names.get(&id), [true, false]),
            [TYPE_IMAGE, _, _, _, _, _, _, SAMPLED, ..] => {
                (BindingKind::SampledImage, self.names.get(&id), [true, false])
            }
            [TYPE_IMAGE, ..] => {
                (BindingKind::StorageImage, self.names.get(&id), [NON_WRITABLE, NON_READABLE].map(has))
            }
            [TYPE_STRUCT, _, members @ ..] => {
                let all = |decoration| {
                    has(decoration) || self.of_members(pointee, decoration).count() == members.len()
                };
                let access = [NON_WRITABLE, NON_READABLE].map(all);
                (BindingKind::StorageBuffer, self.member_names.get(&pointee), access)
            }
            _ => return None,
        };
        let access = match (is_read_only, is_write_only) {
            (true, false) => Access::Read,
            (false, true) => Access::Write,
            _ => Access::ReadWrite,
        };
        let name = name.copied().unwrap_or_default();
        Some(Binding { number, name, kind, access, content: content(name) })
    }

    /// The members of a structure that have a decoration, with its literal.
    fn of_members(&self, id: u32, decoration: u32) -> impl Iterator<Item = (u32, u32)> {
        let range = self.member_decorations.range((id, decoration, 0)..=(id, decoration, u32::MAX));
        range.map(|((_, _, member), literal)| (*member, *literal))
    }

    /// The size in bytes of a type in a block.
    fn size(&self, id: u32) -> u32 {
        let Some(words) = self.types.get(&id) else { return 0 };
        match words.as_slice() {
            [TYPE_INT | TYPE_FLOAT, _, bits, ..] => bits / 8,
            [TYPE_VECTOR | TYPE_MATRIX, _, part, count] => self.size(*part) * count,
            [TYPE_ARRAY, array, _, count] => {
                let count = self.types.get(count).and_then(|words| words.get(3));
                let stride = self.decorations.get(&(*array, ARRAY_STRIDE));
                stride.copied().unwrap_or(0) * count.copied().unwrap_or(0)
            }
            [TYPE_STRUCT, structure, members @ ..] => self
                .of_members(*structure, OFFSET)
                .filter_map(|(member, offset)| Some(offset + self.size(*members.get(member as usize)?)))
                .max()
                .unwrap_or(0),
            _ => 0,
        }
    }
}

/// The string in these words; empty where there is none.
fn text(spirv: &'static [u8], words: Range<usize>) -> &'static str {
    let bytes = spirv.get(4 * words.start..4 * words.end).unwrap_or_default();
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    std::str::from_utf8(&bytes[..end]).unwrap_or_default()
}
