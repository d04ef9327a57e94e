//! Which blocks of a function are reached.

use super::constants::{Known, Value};
use super::pointers::Uses;
use super::{call, id, name_of};
use rspirv::dr::{Block, Function, Instruction, Module, Operand};
use rspirv::spirv::{Op, Word};
use std::collections::{HashMap, HashSet};

/// What functions see of those that they call, and of the module.
pub(super) struct Callees {
    known: Known,
    /// For each function, which parameters it may write through or pass on.
    writes: HashMap<Word, Vec<bool>>,
    /// Short functions that call nobody, which are looked into for what they return.
    leaves: HashMap<Word, Function>,
}

impl Callees {
    /// `known`: the module's constants.
    pub fn new(module: &Module, known: Known) -> Self {
        const SHORT: usize = 8;
        let mut callees = Self { known, writes: HashMap::new(), leaves: HashMap::new() };
        for function in &module.functions {
            let Some(name) = name_of(function) else { continue };
            let uses = Uses::new(function);
            let is_written =
                |parameter: &Instruction| parameter.result_id.is_none_or(|id| !uses.is_read_alone(id));
            callees.writes.insert(name, function.parameters.iter().map(is_written).collect());
            if function.blocks.len() <= SHORT
                && function.all_inst_iter().all(|instruction| call(instruction).is_none())
            {
                callees.leaves.insert(name, function.clone());
            }
        }
        callees
    }

    /// Whether a function may write through a parameter.
    fn writes(&self, function: Word, parameter: usize) -> bool {
        self.writes.get(&function).and_then(|writes| writes.get(parameter)).is_none_or(|writes| *writes)
    }

    /// A function's result.
    fn returned(&self, function: Word, arguments: &[Option<Value>]) -> Option<Value> {
        let leaf = self.leaves.get(&function)?;
        let flow = Flow::new(leaf, arguments, self);
        let ends =
            flow.live_instructions(leaf).filter(|instruction| instruction.class.opcode == Op::ReturnValue);
        same(ends.map(|end| flow.known.value(id(end, 0)?)))
    }
}

/// What all of the values are; none where one is not known, or others are different.
fn same<'a>(mut values: impl Iterator<Item = Option<&'a Value>>) -> Option<Value> {
    let first = values.next()??;
    values.all(|value| value == Some(first)).then(|| first.clone())
}

/// What is known of a function whose arguments are known in part.
pub(super) struct Flow {
    known: Known,
    /// What is read through these pointers.
    memory: HashMap<Word, Value>,
    /// The blocks that are reached, by label.
    live: HashSet<Word>,
    /// Between which of them: from, to.
    edges: HashSet<(Word, Word)>,
    /// Whether every branch stays.
    keeps_all: bool,
}

impl Flow {
    /// `arguments`: what calls give, by value or behind a pointer.
    pub fn new(function: &Function, arguments: &[Option<Value>], callees: &Callees) -> Self {
        let uses = Uses::new(function);
        let mut known = callees.known.clone();
        let mut parameters = HashMap::new();
        for (parameter, argument) in function.parameters.iter().zip(arguments) {
            known.learn(parameter, argument.clone());
            if let (Some(pointer), Some(value)) = (parameter.result_id, argument)
                && uses.is_read_alone(pointer)
            {
                parameters.insert(pointer, value.clone());
            }
        }

        // Each value that is known may close a branch, and each branch that is closed may make values known:
        // in one round at least one of either, or all is found
        let (live, edges) = Default::default();
        let mut flow = Self { known, memory: HashMap::new(), live, edges, keeps_all: false };
        for _ in 0..=function.blocks.len() {
            flow.follow(function);
            flow.memory.clone_from(&parameters);
            flow.memory.extend(flow.constant_variables(function, &uses, callees));
            if !flow.learn(function, callees) {
                break;
            }
        }
        flow.follow(function);

        // Structured SPIR-V wants a way back for each loop, also where none is taken
        let loops =
            flow.live_instructions(function).filter(|instruction| instruction.class.opcode == Op::LoopMerge);
        if loops.filter_map(|begin| id(begin, 1)).any(|back| !flow.live.contains(&back)) {
            flow.keeps_all = true;
            flow.follow(function);
        }
        flow
    }

    /// Whether a block is reached.
    fn is_live(&self, block: &Block) -> bool {
        label(block).is_some_and(|label| self.live.contains(&label))
    }

    /// What a call gives with an argument: its value, or what it points to.
    pub fn given(&self, argument: Word) -> Option<Value> {
        self.known.value(argument).or_else(|| self.memory.get(&argument)).cloned()
    }

    /// Finds the blocks that are reached from the first.
    fn follow(&mut self, function: &Function) {
        let blocks: HashMap<Word, &Block> =
            function.blocks.iter().filter_map(|block| Some((label(block)?, block))).collect();
        self.live.clear();
        self.edges.clear();
        let mut ahead: Vec<Word> = function.blocks.first().and_then(label).into_iter().collect();
        self.live.extend(&ahead);
        while let Some(from) = ahead.pop() {
            let Some(block) = blocks.get(&from) else { continue };
            for to in self.targets(block) {
                self.edges.insert((from, to));
                if self.live.insert(to) {
                    ahead.push(to);
                }
            }
        }
    }

    /// Where a block may go on.
    fn targets(&self, block: &Block) -> Vec<Word> {
        if let Some(target) = self.decided(block) {
            return vec![target];
        }
        let Some(last) = block.instructions.last() else { return Vec::new() };
        let skipped = match last.class.opcode {
            Op::Branch => 0,
            Op::BranchConditional | Op::Switch => 1,
            _ => return Vec::new(),
        };
        last.operands.iter().skip(skipped).filter_map(Operand::id_ref_any).collect()
    }

    /// Where a block goes on that ends with a branch of known outcome. Branches that belong to loops stay.
    fn decided(&self, block: &Block) -> Option<Word> {
        let [.., merge, branch] = block.instructions.as_slice() else { return None };
        if self.keeps_all
            || (merge.class.opcode, branch.class.opcode) != (Op::SelectionMerge, Op::BranchConditional)
        {
            return None;
        }
        let condition = self.known.value(id(branch, 0)?)?.scalar()?;
        id(branch, if condition == 0 { 2 } else { 1 })
    }

    /// The instructions of the blocks that are reached.
    pub fn live_instructions<'a>(&'a self, function: &'a Function) -> impl Iterator<Item = &'a Instruction> {
        function.blocks.iter().filter(|block| self.is_live(block)).flat_map(|block| &block.instructions)
    }

    /// The variables of a function that are written once and else read alone, with what is written. (What is
    /// read before is anything, so also that.)
    fn constant_variables(
        &self,
        function: &Function,
        uses: &Uses,
        callees: &Callees,
    ) -> HashMap<Word, Value> {
        let mut written: HashMap<Word, Option<Value>> = HashMap::new();
        let mut changed: HashSet<Word> = HashSet::new();
        let mut write = |pointer: Word, value: Option<&Value>| {
            if written.insert(pointer, value.cloned()).is_some() {
                changed.insert(pointer);
            }
        };
        for instruction in self.live_instructions(function) {
            match (instruction.class.opcode, id(instruction, 0), id(instruction, 1)) {
                (Op::Store, Some(pointer), Some(value)) => write(pointer, self.known.value(value)),
                (Op::FunctionCall, ..) => {
                    let Some((callee, arguments)) = call(instruction) else { continue };
                    let changed = arguments.enumerate().filter(|(place, _)| callees.writes(callee, *place));
                    changed.for_each(|(_, argument)| write(argument, None));
                }
                (Op::Load, ..) => {}
                _ if uses.is_reading(instruction) => {}
                // Whatever else is done with a pointer may be to write
                _ => {
                    instruction
                        .operands
                        .iter()
                        .filter_map(Operand::id_ref_any)
                        .for_each(|id| write(id, None));
                }
            }
        }
        let is_constant = |variable: &Word| uses.variables.contains(variable) && !changed.contains(variable);
        written
            .into_iter()
            .filter_map(|(variable, value)| is_constant(&variable).then_some((variable, value?)))
            .collect()
    }

    /// Learns what live blocks compute. Whether any of it is new.
    fn learn(&mut self, function: &Function, callees: &Callees) -> bool {
        let mut is_new = false;
        for block in &function.blocks {
            if !self.is_live(block) {
                continue;
            }
            for instruction in &block.instructions {
                let value = match instruction.class.opcode {
                    Op::Phi => self.phi(instruction, block),
                    Op::Load => id(instruction, 0).and_then(|pointer| self.memory.get(&pointer).cloned()),
                    Op::AccessChain => {
                        let member = self.member_behind(instruction);
                        self.memory.extend(instruction.result_id.zip(member));
                        None
                    }
                    Op::FunctionCall => call(instruction).and_then(|(callee, arguments)| {
                        let arguments: Vec<_> = arguments.map(|argument| self.given(argument)).collect();
                        callees.returned(callee, &arguments)
                    }),
                    _ => self.known.evaluate(instruction),
                };
                is_new |= self.known.learn(instruction, value);
            }
        }
        is_new
    }

    /// Where a value comes from, by way of live blocks.
    fn sources<'a>(&'a self, phi: &'a Instruction, block: &'a Block) -> impl Iterator<Item = &'a [Operand]> {
        phi.operands.chunks_exact(2).filter(move |pair| {
            let edge = pair[1].id_ref_any().zip(label(block));
            edge.is_some_and(|edge| self.edges.contains(&edge))
        })
    }

    fn phi(&self, phi: &Instruction, block: &Block) -> Option<Value> {
        same(self.sources(phi, block).map(|pair| self.known.value(pair[0].id_ref_any()?)))
    }

    /// What a pointer into a struct leads to.
    fn member_behind(&self, chain: &Instruction) -> Option<Value> {
        let base = self.memory.get(&id(chain, 0)?)?.clone();
        let mut places = chain.operands[1..].iter();
        places.try_fold(base, |value, place| value.member(self.known.value(place.id_ref_any()?)?.scalar()?))
    }

    /// Removes unreached code from the function.
    pub fn prune(&self, function: &mut Function) {
        if self.keeps_all {
            return;
        }
        for block in function.blocks.iter_mut().filter(|block| self.is_live(block)) {
            // Go straight to where a branch always goes
            if let Some(target) = self.decided(block) {
                let length = block.instructions.len();
                block.instructions.truncate(length - 2);
                block.instructions.push(plain(Op::Branch, vec![Operand::IdRef(target)]));
            }
            let sources: Vec<Vec<Operand>> = block
                .instructions
                .iter()
                .take_while(|instruction| instruction.class.opcode == Op::Phi)
                .map(|phi| self.sources(phi, block).flatten().cloned().collect())
                .collect();
            for (phi, sources) in block.instructions.iter_mut().zip(sources) {
                phi.operands = sources;
            }
        }

        // What is reached names blocks where branches meet again: where they never do, those end
        let merges = self
            .live_instructions(function)
            .filter(|instruction| matches!(instruction.class.opcode, Op::SelectionMerge | Op::LoopMerge));
        let meeting: HashSet<Word> = merges.filter_map(|merge| id(merge, 0)).collect();
        function.blocks.retain(|block| {
            self.is_live(block) || label(block).is_some_and(|label| meeting.contains(&label))
        });
        for block in function.blocks.iter_mut().filter(|block| !self.is_live(block)) {
            block.instructions = vec![plain(Op::Unreachable, Vec::new())];
        }
    }
}

fn label(block: &Block) -> Option<Word> {
    block.label.as_ref()?.result_id
}

/// An instruction without a result.
fn plain(operation: Op, operands: Vec<Operand>) -> Instruction {
    Instruction::new(operation, None, None, operands)
}
