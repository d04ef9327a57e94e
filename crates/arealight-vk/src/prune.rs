//! Removes from a SPIR-V module the code that its specialisation constants rule out.
//!
//! Drivers find that out as well, but some do so late: Mesa copies every function to where it is called, with
//! all of its branches, before it looks at a condition. What a scene does not need then costs nothing to
//! shade, and much to compile (docs/decisions/0009-pruned-modules.md).

use constants::{Known, Value, specialization_id};
use flow::{Callees, Flow};
use rspirv::binary::Assemble;
use rspirv::dr::{Function, Instruction, Module, Operand, load_words};
use rspirv::spirv::{Op, StorageClass, Word};
use std::collections::{HashMap, HashSet};

mod constants;
mod flow;
mod freeze;
mod pointers;

pub use freeze::freeze;

/// The module without the branches that are never taken where specialisation constants have these values
/// (pairs of id and value; the others have their defaults), without the functions that then nobody calls, and
/// without the bindings that then nothing uses. It has the same constants and entry points, is specialised in
/// the same way, and computes the same, to the bit where the compiler contracts no sums.
///
/// Code that isn't understood stays as it is: a `switch`, what is computed of other than integers of 32 bits
/// and truth values; and whole modules that have debug information beyond the core's
/// (`NonSemantic.Shader.DebugInfo.100`), or cannot be read.
///
/// [`ComputePass`](crate::ComputePass) does this by itself. It is for hosts that make pipelines of our
/// kernels themselves.
pub fn prune(module: &[u32], specialization: &[(u32, u32)]) -> Vec<u32> {
    pruned(module, specialization).unwrap_or_else(|| module.to_vec())
}

fn pruned(words: &[u32], specialization: &[(u32, u32)]) -> Option<Vec<u32>> {
    if !is_framed(words) {
        return None;
    }
    let mut module = load_words(words).ok()?;
    if module.ext_inst_imports.iter().any(is_foreign) {
        return None;
    }

    // Look at callers first: what they give is known when what they call is looked at
    let known = Known::of(&module, specialization);
    let mut calls = Calls::new(&module, known);
    for place in callers_first(&module) {
        let function = &mut module.functions[place];
        let Some(arguments) = calls.arguments(function) else { continue };
        let flow = Flow::new(function, &arguments, &calls.callees);
        calls.add(function, &flow);
        flow.prune(function);
    }

    // Drop the functions that nobody calls, the bindings that nothing uses, and what is said of what is gone
    module.functions.retain(|function| calls.is_called(function));
    drop_unused_bindings(&mut module);
    let defined: HashSet<Word> =
        module.all_inst_iter().filter_map(|instruction| instruction.result_id).collect();
    let is_defined = |about: &Instruction| match about.operands.first() {
        Some(Operand::IdRef(id)) => defined.contains(id),
        _ => true,
    };
    module.debug_names.retain(is_defined);
    module.annotations.retain(is_defined);
    Some(module.assemble())
}

/// Drops the images and buffers that no instruction of a function uses. (Entry points of SPIR-V 1.3 do not
/// name them.)
fn drop_unused_bindings(module: &mut Module) {
    let instructions = module.functions.iter().flat_map(Function::all_inst_iter);
    let used: HashSet<Word> = instructions
        .chain(&module.entry_points)
        .flat_map(|instruction| instruction.operands.iter().filter_map(Operand::id_ref_any))
        .collect();
    let is_binding = |variable: &Instruction| {
        variable.class.opcode == Op::Variable
            && matches!(
                variable.operands.first(),
                Some(Operand::StorageClass(StorageClass::UniformConstant | StorageClass::StorageBuffer))
            )
    };
    module
        .types_global_values
        .retain(|value| !is_binding(value) || value.result_id.is_none_or(|name| used.contains(&name)));
}

/// Whether the instructions end where the module does, as their lengths say.
pub(crate) fn is_framed(module: &[u32]) -> bool {
    const HEADER: usize = 5;
    let mut rest = module.get(HEADER..).unwrap_or_default();
    while let Some(first) = rest.first() {
        match rest.get((first >> 16) as usize..) {
            Some(next) if next.len() < rest.len() => rest = next,
            _ => return false,
        }
    }
    module.len() > HEADER
}

/// Whether an import may say things of functions and of what is in them.
fn is_foreign(import: &Instruction) -> bool {
    !matches!(import.operands.first(), Some(Operand::LiteralString(name)) if name == "GLSL.std.450")
}

fn name_of(function: &Function) -> Option<Word> {
    function.def.as_ref()?.result_id
}

/// The operand at a place, where it is an id.
fn id(instruction: &Instruction, place: usize) -> Option<Word> {
    instruction.operands.get(place)?.id_ref_any()
}

/// The function that an instruction calls, and what with.
fn call(instruction: &Instruction) -> Option<(Word, impl Iterator<Item = Word>)> {
    let is_call = instruction.class.opcode == Op::FunctionCall;
    let callee = is_call.then(|| id(instruction, 0))??;
    Some((callee, instruction.operands[1..].iter().filter_map(Operand::id_ref_any)))
}

/// The places of the functions that entry points reach, such that each comes after all that call it. (SPIR-V
/// for Vulkan has no recursion.)
fn callers_first(module: &Module) -> Vec<usize> {
    let places: HashMap<Word, usize> = module
        .functions
        .iter()
        .enumerate()
        .filter_map(|(place, function)| Some((name_of(function)?, place)))
        .collect();
    let callees = |place: usize| -> Vec<usize> {
        let calls = module.functions[place].all_inst_iter().filter_map(call);
        calls.filter_map(|(callee, _)| places.get(&callee).copied()).collect()
    };

    // Go down to what calls nobody, and write down what was gone through on the way back
    let entries = module.entry_points.iter().filter_map(|entry| places.get(&id(entry, 1)?).copied());
    let mut stack: Vec<(usize, Vec<usize>)> = Vec::new();
    let (mut seen, mut order) = (HashSet::new(), Vec::new());
    for entry in entries {
        if seen.insert(entry) {
            stack.push((entry, callees(entry)));
        }
        while let Some((place, below)) = stack.last_mut() {
            match below.pop() {
                Some(callee) if seen.insert(callee) => stack.push((callee, callees(callee))),
                Some(_) => {}
                None => {
                    order.push(*place);
                    stack.pop();
                }
            }
        }
    }
    order.reverse();
    order
}

/// Who is called, and what with.
struct Calls {
    /// For each function that is called, what all calls so far give for its parameters, where that is known
    /// and the same.
    given: HashMap<Word, Vec<Option<Value>>>,
    callees: Callees,
}

impl Calls {
    fn new(module: &Module, known: Known) -> Self {
        let entries = module.entry_points.iter().filter_map(|entry| Some((id(entry, 1)?, Vec::new())));
        Self { given: entries.collect(), callees: Callees::new(module, known) }
    }

    fn is_called(&self, function: &Function) -> bool {
        name_of(function).is_some_and(|name| self.given.contains_key(&name))
    }

    /// What is known of a function's parameters; none where nobody calls it.
    fn arguments(&self, function: &Function) -> Option<Vec<Option<Value>>> {
        self.given.get(&name_of(function)?).cloned()
    }

    /// Adds the calls of a function that are reached.
    fn add(&mut self, function: &Function, flow: &Flow) {
        for (callee, arguments) in flow.live_instructions(function).filter_map(call) {
            let arguments: Vec<_> = arguments.map(|argument| flow.given(argument)).collect();
            match self.given.get_mut(&callee) {
                None => {
                    self.given.insert(callee, arguments);
                }
                Some(given) => {
                    for (given, argument) in given.iter_mut().zip(arguments) {
                        *given = given.take().filter(|value| Some(value) == argument.as_ref());
                    }
                }
            }
        }
    }
}
