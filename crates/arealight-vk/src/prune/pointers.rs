//! How a function uses pointers.

use rspirv::dr::{Function, Instruction, Operand};
use rspirv::spirv::{Op, StorageClass, Word};
use std::collections::HashSet;

/// Which pointers of a function are only read through.
pub(super) struct Uses {
    /// Variables of the function that have no initial value.
    pub variables: HashSet<Word>,
    /// Pointers into others, which are only read through.
    chains: HashSet<Word>,
    /// Operands of instructions other than reads.
    written: HashSet<Word>,
}

impl Uses {
    pub fn new(function: &Function) -> Self {
        let instructions = || function.blocks.iter().flat_map(|block| &block.instructions);
        let used_by = |is_user: &dyn Fn(&Instruction) -> bool| -> HashSet<Word> {
            let users = instructions().filter(|instruction| is_user(instruction));
            users
                .flat_map(|instruction| instruction.operands.iter().filter_map(Operand::id_ref_any))
                .collect()
        };
        let is_load = |instruction: &Instruction| instruction.class.opcode == Op::Load;
        let is_local = |variable: &&Instruction| {
            variable.operands.as_slice() == [Operand::StorageClass(StorageClass::Function)]
        };

        // A pointer into another is that alone
        let not_loaded = used_by(&|instruction| !is_load(instruction));
        let chains = instructions().filter(|instruction| instruction.class.opcode == Op::AccessChain);
        let chains: HashSet<Word> =
            chains.filter_map(|chain| chain.result_id).filter(|chain| !not_loaded.contains(chain)).collect();
        let is_reading =
            |instruction: &Instruction| instruction.result_id.is_some_and(|id| chains.contains(&id));
        let written = used_by(&|instruction| !is_load(instruction) && !is_reading(instruction));
        let variables = instructions().filter(|instruction| instruction.class.opcode == Op::Variable);
        let variables = variables.filter(is_local).filter_map(|variable| variable.result_id).collect();
        Self { variables, chains, written }
    }

    /// Whether an instruction makes a pointer into another, and nothing is written through it.
    pub fn is_reading(&self, instruction: &Instruction) -> bool {
        instruction.result_id.is_some_and(|id| self.chains.contains(&id))
    }

    /// Whether nothing is written through a pointer, and nobody else gets it.
    pub fn is_read_alone(&self, pointer: Word) -> bool {
        !self.written.contains(&pointer)
    }
}
