//! Checks a SPIR-V module before a driver sees it, since drivers trust their input.

use crate::Error;
use crate::prune::is_framed;
use arealight::kernels::{BindingKind, Kernel};
use rspirv::dr::{Instruction, Module, Operand, load_words};
use rspirv::spirv::{Decoration, ExecutionMode, ExecutionModel, Op, StorageClass, Word};
use std::collections::{HashMap, HashSet};

const MAGIC: u32 = 0x0723_0203;

/// The limits of any module: its version, 1.0 to 1.6, and how many ids it has (the SPIR-V specification,
/// 2.17).
const VERSIONS: std::ops::RangeInclusive<u32> = 0x0001_0000..=0x0001_0600;
const MOST_IDS: u32 = 4_194_303;

/// Refuses incomplete modules, undefined ids, and modules without the kernel's entry point, workgroup size
/// and bindings of set 0. Types and control flow are not looked at: a module that passes may still be
/// invalid, which a validator says.
pub(crate) fn check_module(words: &[u32], kernel: &Kernel, has_host_set: bool) -> Result<(), Error> {
    let fault = |message: String| Error::InvalidArgument { field: "module", message };
    // The header, and the lengths of instructions
    if words.first() != Some(&MAGIC) {
        return Err(fault("does not begin as SPIR-V does, in this machine's byte order".into()));
    }
    let &[_, version, _, ids, reserved, ..] = words else {
        return Err(fault(format!("{} words are no SPIR-V, whose header has five", words.len())));
    };
    if !VERSIONS.contains(&version) {
        let [_, major, minor, _] = version.to_be_bytes();
        return Err(fault(format!("is of SPIR-V {major}.{minor}; versions 1.0 to 1.6 are known")));
    }
    if !(1..=MOST_IDS).contains(&ids) || reserved != 0 {
        return Err(fault("its header is not that of a module".into()));
    }
    if !is_framed(words) {
        return Err(fault("is cut off, or the length of an instruction is wrong".into()));
    }
    let module = load_words(words).map_err(|error| fault(format!("cannot be read: {error}")))?;
    check_ids(&module, ids).map_err(fault)?;
    check_entry_point(&module, kernel).map_err(fault)?;
    check_bindings(&module, kernel, has_host_set).map_err(fault)
}

/// Refuses ids that are used and not defined, or not below the header's bound.
fn check_ids(module: &Module, bound: u32) -> Result<(), String> {
    let defined: HashSet<Word> = module.all_inst_iter().filter_map(|one| one.result_id).collect();
    if let Some(id) = defined.iter().find(|id| !(1..bound).contains(*id)) {
        return Err(format!("defines %{id}, and states that ids are below {bound}"));
    }
    let used = module
        .all_inst_iter()
        .flat_map(|one| one.operands.iter().filter_map(Operand::id_ref_any).chain(one.result_type));
    match used.into_iter().find(|id| !defined.contains(id)) {
        Some(id) => Err(format!("uses %{id}, which it does not define")),
        None => Ok(()),
    }
}

fn check_entry_point(module: &Module, kernel: &Kernel) -> Result<(), String> {
    let is_main = |entry: &&Instruction| {
        matches!(entry.operands.as_slice(),
            [Operand::ExecutionModel(ExecutionModel::GLCompute), _, Operand::LiteralString(name), ..]
                if name == "main")
    };
    let Some(main) = module.entry_points.iter().find(is_main) else {
        return Err("has no compute entry point 'main'".into());
    };
    let function = main.operands.get(1);
    let has_function =
        module.functions.iter().any(|one| one.def_id().map(Operand::IdRef).as_ref() == function);
    if !has_function {
        return Err("its entry point is no function".into());
    }
    let size = module.execution_modes.iter().find_map(|mode| match mode.operands.as_slice() {
        [
            entry,
            Operand::ExecutionMode(ExecutionMode::LocalSize),
            Operand::LiteralBit32(x),
            Operand::LiteralBit32(y),
            Operand::LiteralBit32(z),
        ] if Some(entry) == function => Some([*x, *y, *z]),
        _ => None,
    });
    if size != Some(kernel.local_size()) {
        return Err(format!(
            "its workgroups are not those of kernel '{}', {:?}",
            kernel.name,
            kernel.local_size()
        ));
    }
    Ok(())
}

fn check_bindings(module: &Module, kernel: &Kernel, has_host_set: bool) -> Result<(), String> {
    let types: HashMap<Word, &Instruction> =
        module.types_global_values.iter().filter_map(|one| Some((one.result_id?, one))).collect();
    let decorated = |wanted: Decoration| -> HashMap<Word, u32> {
        let number = |one: &Instruction| match one.operands.as_slice() {
            [Operand::IdRef(id), Operand::Decoration(decoration), Operand::LiteralBit32(number)]
                if *decoration == wanted =>
            {
                Some((*id, *number))
            }
            _ => None,
        };
        module.annotations.iter().filter_map(number).collect()
    };
    let (sets, bindings) = (decorated(Decoration::DescriptorSet), decorated(Decoration::Binding));
    for (id, number) in &bindings {
        match sets.get(id).copied().unwrap_or(0) {
            0 => {}
            1 if has_host_set => continue,
            set => return Err(format!("reads set {set}, whose layout is not given: see host_set")),
        }
        let Some(expected) = kernel.bindings().iter().find(|one| one.number == *number) else {
            return Err(format!("binds {number} of set 0, which kernel '{}' does not have", kernel.name));
        };
        let found = types.get(id).and_then(|variable| kind(variable, &types));
        let fits = match expected.kind {
            BindingKind::StorageBuffer => found == Some(Found::StorageBuffer),
            BindingKind::StorageImage => found == Some(Found::StorageImage),
            BindingKind::SampledImage | BindingKind::FilteredImage => found == Some(Found::SampledImage),
        };
        if !fits {
            return Err(format!(
                "binding {number} is no {:?}, as '{}' of kernel '{}' is",
                expected.kind, expected.name, kernel.name
            ));
        }
    }
    Ok(())
}

/// A variable's binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Found {
    StorageBuffer,
    StorageImage,
    SampledImage,
}

fn kind(variable: &Instruction, types: &HashMap<Word, &Instruction>) -> Option<Found> {
    let pointer = types.get(&variable.result_type?)?;
    let (class, mut pointee) = match pointer.operands.as_slice() {
        [Operand::StorageClass(class), Operand::IdRef(pointee)] => (*class, types.get(pointee)?),
        _ => return None,
    };
    // A module may nest no deeper than it has types
    for _ in 0..types.len() {
        let (Op::TypeArray | Op::TypeRuntimeArray) = pointee.class.opcode else { break };
        let Some(Operand::IdRef(element)) = pointee.operands.first() else { break };
        pointee = types.get(element)?;
    }
    match pointee.class.opcode {
        Op::TypeStruct if matches!(class, StorageClass::StorageBuffer | StorageClass::Uniform) => {
            Some(Found::StorageBuffer)
        }
        Op::TypeSampledImage => Some(Found::SampledImage),
        Op::TypeImage => match pointee.operands.get(5) {
            Some(Operand::LiteralBit32(2)) => Some(Found::StorageImage),
            _ => Some(Found::SampledImage),
        },
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::kernels::{ALL, SHADE, SHADOW_RAYS};

    fn refusal(words: &[u32]) -> String {
        check_module(words, &SHADE, false).unwrap_err().to_string()
    }

    #[test]
    fn our_own_modules_pass_and_another_kernel_s_does_not() {
        for kernel in ALL {
            check_module(&kernel.words(), kernel, false).unwrap();
        }
        let text = refusal(&SHADOW_RAYS.words());
        assert!(text.contains("kernel 'shade'"), "{text}");
    }

    #[test]
    fn no_part_of_a_module_is_one() {
        let whole = SHADOW_RAYS.words();
        // Ends of instructions are the hard ones: each part is framed
        let (mut at, mut ends) = (5, vec![0, 1, 4, 5]);
        while at < whole.len() {
            ends.push(at);
            at += (whole[at] >> 16) as usize;
        }
        let step = ends.len() / 100;
        for end in ends.into_iter().step_by(step).chain([whole.len() - 1]) {
            assert!(check_module(&whole[..end], &SHADOW_RAYS, false).is_err(), "{end} words");
        }
    }

    #[test]
    fn what_is_no_module_is_said() {
        let whole = SHADE.words();
        let with = |at: usize, word: u32| {
            let mut words = whole.clone();
            words[at] = word;
            refusal(&words)
        };
        assert!(refusal(&[]).contains("does not begin"));
        assert!(refusal(&[MAGIC]).contains("1 words"), "four bytes of junk");
        assert!(with(0, MAGIC.swap_bytes()).contains("byte order"));
        assert!(with(1, 0x0009_0000).contains("is of SPIR-V 9.0"));
        assert!(with(3, 0).contains("header"));
        assert!(with(3, u32::MAX).contains("header"));
        assert!(refusal(&whole[..5]).contains("entry point") || refusal(&whole[..5]).contains("cut off"));
        // Without the end of its last function; and with an instruction that is longer than what is left
        assert!(refusal(&whole[..whole.len() - 1]).contains("cannot be read"));
        assert!(refusal(&[whole.as_slice(), &[0x0005_0000]].concat()).contains("cut off"));
        // OpDecorate some variable DescriptorSet 0
        let set = whole.windows(4).position(|w| (w[0], w[2], w[3]) == (0x0004_0047, 34, 0)).unwrap() + 3;
        assert!(with(set, 1).contains("reads set 1, whose layout is not given"));
        assert!(with(set, 2).contains("reads set 2"));
    }

    #[test]
    fn changed_words_are_refused_or_read_without_a_panic() {
        let whole = SHADE.words();
        let mut refused = 0;
        // Words spread over the module, each with a bit turned: lengths, opcodes, ids, literals
        for step in 0..400_usize {
            let mut words = whole.clone();
            let at = 1 + step * (whole.len() - 1) / 400;
            words[at] ^= 1 << (step * 7 % 32);
            refused += usize::from(check_module(&words, &SHADE, false).is_err());
        }
        assert!(refused > 150, "{refused} of 400");
    }
}
