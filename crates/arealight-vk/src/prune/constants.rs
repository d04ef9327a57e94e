//! Values that are known before a module runs.

use super::id;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, Word};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// What is known of a value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// The bits of an integer of 32 bits; or a truth value, 0 or 1.
    Scalar(u32),
    /// The members of a struct, as far as they are known.
    Struct(Rc<[Option<Value>]>),
}

impl Value {
    pub fn scalar(&self) -> Option<u32> {
        match self {
            Self::Scalar(scalar) => Some(*scalar),
            Self::Struct(_) => None,
        }
    }

    pub fn member(&self, place: u32) -> Option<Self> {
        match self {
            Self::Scalar(_) => None,
            Self::Struct(members) => members.get(place as usize)?.clone(),
        }
    }
}

/// The values that are known, by id.
#[derive(Clone)]
pub(super) struct Known {
    scalars: HashSet<Word>,
    structs: HashSet<Word>,
    values: HashMap<Word, Value>,
}

impl Known {
    /// The constants of a module, specialised.
    pub fn of(module: &Module, specialization: &[(u32, u32)]) -> Self {
        let specialised: HashMap<Word, u32> =
            module.annotations.iter().filter_map(specialization_id).collect();
        let given = |instruction: &Instruction| {
            let constant = specialised.get(&instruction.result_id?)?;
            specialization.iter().find(|(id, _)| id == constant).map(|(_, value)| *value)
        };
        let mut known = Self { scalars: HashSet::new(), structs: HashSet::new(), values: HashMap::new() };
        for instruction in &module.types_global_values {
            let operand = instruction.operands.first();
            let literal = operand.and_then(literal);
            let truth =
                |usual: u32| Value::Scalar(given(instruction).map_or(usual, |value| u32::from(value != 0)));
            let value = match instruction.class.opcode {
                Op::TypeBool => {
                    known.scalars.extend(instruction.result_id);
                    None
                }
                Op::TypeInt if literal == Some(32) => {
                    known.scalars.extend(instruction.result_id);
                    None
                }
                Op::TypeStruct => {
                    known.structs.extend(instruction.result_id);
                    None
                }
                Op::ConstantTrue => Some(Value::Scalar(1)),
                Op::ConstantFalse => Some(Value::Scalar(0)),
                Op::Constant => literal.map(Value::Scalar),
                Op::SpecConstantTrue => Some(truth(1)),
                Op::SpecConstantFalse => Some(truth(0)),
                Op::SpecConstant => given(instruction).or(literal).map(Value::Scalar),
                Op::ConstantComposite | Op::SpecConstantComposite => known.members(instruction),
                Op::SpecConstantOp => match operand {
                    Some(Operand::LiteralSpecConstantOpInteger(operation)) => {
                        known.fold(*operation, instruction, 1).map(Value::Scalar)
                    }
                    _ => None,
                },
                _ => None,
            };
            known.learn(instruction, value);
        }
        known
    }

    /// What is known of an id.
    pub fn value(&self, id: Word) -> Option<&Value> {
        self.values.get(&id)
    }

    /// What an instruction of a function makes of its operands alone, where that is known.
    pub fn evaluate(&self, instruction: &Instruction) -> Option<Value> {
        match instruction.class.opcode {
            Op::CopyObject => self.value(id(instruction, 0)?).cloned(),
            Op::CompositeConstruct => self.members(instruction),
            Op::CompositeExtract => {
                let mut places = instruction.operands[1..].iter();
                places.try_fold(self.value(id(instruction, 0)?)?.clone(), |value, place| {
                    value.member(literal(place)?)
                })
            }
            operation => self.fold(operation, instruction, 0).map(Value::Scalar),
        }
    }

    /// Learns a value, if it is of a type that is followed. Whether that is new.
    pub fn learn(&mut self, instruction: &Instruction, value: Option<Value>) -> bool {
        let (Some(value), Some(result), Some(of)) = (value, instruction.result_id, instruction.result_type)
        else {
            return false;
        };
        let followed = match value {
            Value::Scalar(_) => &self.scalars,
            Value::Struct(_) => &self.structs,
        };
        followed.contains(&of) && self.values.insert(result, value.clone()).as_ref() != Some(&value)
    }

    /// A struct of an instruction's operands.
    fn members(&self, instruction: &Instruction) -> Option<Value> {
        let is_struct = self.structs.contains(&instruction.result_type?);
        let member = |operand: &Operand| self.value(operand.id_ref_any()?).cloned();
        is_struct.then(|| Value::Struct(instruction.operands.iter().map(member).collect()))
    }

    /// What an operation makes of the operands from a place on.
    fn fold(&self, operation: Op, instruction: &Instruction, first: usize) -> Option<u32> {
        let operand = |place: usize| self.value(id(instruction, first + place)?)?.scalar();
        // One of these decides
        match (operation, operand(0), operand(1)) {
            (Op::LogicalAnd, Some(0), _) | (Op::LogicalAnd, _, Some(0)) => return Some(0),
            (Op::LogicalOr, Some(1), _) | (Op::LogicalOr, _, Some(1)) => return Some(1),
            (Op::Select, Some(condition), _) => return operand(if condition == 0 { 2 } else { 1 }),
            _ => {}
        }
        let a = operand(0)?;
        match operation {
            Op::LogicalNot => return Some(u32::from(a == 0)),
            Op::Not => return Some(!a),
            _ => {}
        }
        let b = operand(1)?;
        let (signed_a, signed_b) = (a.cast_signed(), b.cast_signed());
        let is = |truth: bool| Some(u32::from(truth));
        match operation {
            Op::LogicalAnd | Op::BitwiseAnd => Some(a & b),
            Op::LogicalOr | Op::BitwiseOr => Some(a | b),
            Op::BitwiseXor => Some(a ^ b),
            Op::IAdd => Some(a.wrapping_add(b)),
            Op::ISub => Some(a.wrapping_sub(b)),
            Op::IMul => Some(a.wrapping_mul(b)),
            Op::ShiftLeftLogical => a.checked_shl(b),
            Op::ShiftRightLogical => a.checked_shr(b),
            Op::IEqual | Op::LogicalEqual => is(a == b),
            Op::INotEqual | Op::LogicalNotEqual => is(a != b),
            Op::ULessThan => is(a < b),
            Op::ULessThanEqual => is(a <= b),
            Op::UGreaterThan => is(a > b),
            Op::UGreaterThanEqual => is(a >= b),
            Op::SLessThan => is(signed_a < signed_b),
            Op::SLessThanEqual => is(signed_a <= signed_b),
            Op::SGreaterThan => is(signed_a > signed_b),
            Op::SGreaterThanEqual => is(signed_a >= signed_b),
            _ => None,
        }
    }
}

fn literal(operand: &Operand) -> Option<u32> {
    match operand {
        Operand::LiteralBit32(literal) => Some(*literal),
        _ => None,
    }
}

/// What a decoration says of a specialisation constant: its id in the module, and the id that hosts give it a
/// value by.
pub(super) fn specialization_id(annotation: &Instruction) -> Option<(Word, u32)> {
    match annotation.operands.as_slice() {
        [
            Operand::IdRef(target),
            Operand::Decoration(Decoration::SpecId),
            Operand::LiteralBit32(constant),
        ] => Some((*target, *constant)),
        _ => None,
    }
}
