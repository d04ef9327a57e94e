//! Makes specialisation constants into constants.

use super::constants::{Known, Value};
use super::{pruned, specialization_id};
use rspirv::binary::Assemble;
use rspirv::dr::{Instruction, Operand, load_words};
use rspirv::spirv::{Op, Word};
use std::collections::HashSet;

/// As [`prune`](super::prune()), and without specialisation constants: each is a constant of its value, and
/// so is what the module computes of them before it runs. It is for what reads SPIR-V and knows no
/// specialisation: compilers to other shading languages.
///
/// None where the module cannot be read, or computes of specialisation constants what isn't understood: other
/// than integers of 32 bits and truth values.
pub fn freeze(module: &[u32], specialization: &[(u32, u32)]) -> Option<Vec<u32>> {
    let mut module = load_words(pruned(module, specialization)?).ok()?;
    let known = Known::of(&module, specialization);
    let truths: HashSet<Word> = module
        .types_global_values
        .iter()
        .filter(|one| one.class.opcode == Op::TypeBool)
        .filter_map(|one| one.result_id)
        .collect();
    for instruction in &mut module.types_global_values {
        let is_truth = instruction.result_type.is_some_and(|of| truths.contains(&of));
        *instruction = match instruction.class.opcode {
            Op::SpecConstantTrue | Op::SpecConstantFalse | Op::SpecConstant | Op::SpecConstantOp => {
                let value = known.value(instruction.result_id?).and_then(Value::scalar)?;
                constant(instruction, value, is_truth)
            }
            Op::SpecConstantComposite => {
                with_operands(instruction, Op::ConstantComposite, instruction.operands.clone())
            }
            _ => continue,
        };
    }
    module.annotations.retain(|annotation| specialization_id(annotation).is_none());
    Some(module.assemble())
}

/// The constant of this value in place of an instruction.
fn constant(instruction: &Instruction, value: u32, is_truth: bool) -> Instruction {
    match (is_truth, value) {
        (true, 0) => with_operands(instruction, Op::ConstantFalse, vec![]),
        (true, _) => with_operands(instruction, Op::ConstantTrue, vec![]),
        (false, value) => with_operands(instruction, Op::Constant, vec![Operand::LiteralBit32(value)]),
    }
}

/// An instruction with another operation and other operands.
fn with_operands(instruction: &Instruction, operation: Op, operands: Vec<Operand>) -> Instruction {
    Instruction::new(operation, instruction.result_type, instruction.result_id, operands)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prune;
    use arealight::kernels::SHADE;
    use arealight::plan::{ShadeOptions, shade_specialization};
    use arealight::{Effects, LightSummary};

    /// How many specialisation constants and operations on them a module has.
    fn specialised(words: &[u32]) -> usize {
        let module = load_words(words).unwrap();
        let is_specialised = |one: &&Instruction| {
            matches!(
                one.class.opcode,
                Op::SpecConstantTrue
                    | Op::SpecConstantFalse
                    | Op::SpecConstant
                    | Op::SpecConstantOp
                    | Op::SpecConstantComposite
            )
        };
        let ids = module.annotations.iter().filter_map(specialization_id).count();
        module.types_global_values.iter().filter(is_specialised).count() + ids
    }

    #[test]
    fn a_frozen_module_has_no_specialisation_constant() {
        let lights = LightSummary { light_count: 1, effects: Effects::POLYGON, ..LightSummary::default() };
        let values = shade_specialization(ShadeOptions::default(), lights);
        let pruned = prune(&SHADE.words(), &values);
        assert!(specialised(&pruned) > 13, "which pruning leaves");
        let frozen = freeze(&SHADE.words(), &values).unwrap();
        assert_eq!(specialised(&frozen), 0);
        assert!(frozen.len() <= pruned.len(), "nothing is added");
        // Other values, another module
        let others =
            shade_specialization(ShadeOptions { from_depth: true, ..ShadeOptions::default() }, lights);
        assert_ne!(freeze(&SHADE.words(), &others).unwrap(), frozen);
    }

    #[test]
    fn what_is_no_module_is_not_frozen() {
        let words = SHADE.words();
        assert_eq!(freeze(&words[..words.len() - 1], &[]), None);
        assert_eq!(freeze(&[], &[]), None);
    }
}
