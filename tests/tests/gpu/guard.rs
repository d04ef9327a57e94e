//! No NaN comes out, and no compiler may think otherwise: the last guard of a form factor compares bits as
//! whole numbers, and is still there when the optimiser is done. Outputs are judged by their bits, before any
//! clamp that hides a NaN.

use arealight::kernels::{Kernel, SHADE, constant};
use arealight_tests::Path;
use arealight_tests::kernel::UNGUARDED;
use arealight_tests::prelude::*;
use arealight_tests::spirv::{tool, words};
use arealight_tool_kernels::kernels::EVAL;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::Op;
use std::collections::{HashMap, HashSet};

/// float32's infinity: what is at or beyond it, as a whole number, is infinite, NaN or negative.
const INFINITY: u32 = 0x7f80_0000;

fn module(words: &[u32]) -> Module {
    let mut loader = rspirv::dr::Loader::new();
    rspirv::binary::parse_words(words, &mut loader).expect("the module parses");
    loader.module()
}

fn ids(instruction: &Instruction) -> Vec<u32> {
    instruction.operands.iter().filter_map(Operand::id_ref_any).collect()
}

/// Where the values of a function come from and go to; through variables too, as the compiler's front end
/// leaves them.
struct Flow<'a> {
    made_by: HashMap<u32, &'a Instruction>,
    used_by: HashMap<u32, Vec<&'a Instruction>>,
}

impl<'a> Flow<'a> {
    fn new(instructions: &[&'a Instruction]) -> Self {
        let made_by = instructions.iter().filter_map(|&i| Some((i.result_id?, i))).collect();
        let mut used_by: HashMap<u32, Vec<&Instruction>> = HashMap::new();
        for &instruction in instructions {
            for id in ids(instruction) {
                used_by.entry(id).or_default().push(instruction);
            }
        }
        Self { made_by, used_by }
    }

    /// Whether a value is a number's bits.
    fn is_bits(&self, id: u32) -> bool {
        let (mut waiting, mut seen) = (vec![id], HashSet::new());
        while let Some(id) = waiting.pop() {
            let Some(instruction) = self.made_by.get(&id).filter(|_| seen.insert(id)) else { continue };
            match instruction.class.opcode {
                Op::Bitcast => return true,
                Op::Load => {
                    let variable = ids(instruction)[0];
                    let stores = self.used_by[&variable].iter().map(|i| (i.class.opcode, ids(i)));
                    waiting.extend(
                        stores
                            .filter(|(op, ids)| *op == Op::Store && ids[0] == variable)
                            .map(|(_, ids)| ids[1]),
                    );
                }
                _ => {}
            }
        }
        false
    }

    /// Whether a choice or a branch is made by a value.
    fn decides(&self, id: u32) -> bool {
        let (mut waiting, mut seen) = (vec![id], HashSet::new());
        while let Some(id) = waiting.pop() {
            if !seen.insert(id) {
                continue;
            }
            for user in self.used_by.get(&id).into_iter().flatten() {
                match user.class.opcode {
                    Op::Select | Op::BranchConditional => return true,
                    Op::LogicalAnd | Op::LogicalOr | Op::LogicalNot | Op::Phi | Op::Load => {
                        waiting.extend(user.result_id);
                    }
                    Op::Store => waiting.push(ids(user)[0]),
                    _ => {}
                }
            }
        }
        false
    }
}

/// How many comparisons of a float's bits with infinity's decide something: they reach a choice between
/// values or a branch.
fn guards(module: &Module) -> usize {
    let constants: HashSet<u32> = module
        .types_global_values
        .iter()
        .filter(|i| i.class.opcode == Op::Constant && i.operands == [Operand::LiteralBit32(INFINITY)])
        .filter_map(|i| i.result_id)
        .collect();
    let mut guards = 0;
    for function in &module.functions {
        let instructions: Vec<_> = function.all_inst_iter().collect();
        let flow = Flow::new(&instructions);
        for instruction in &instructions {
            let comparison = matches!(
                instruction.class.opcode,
                Op::ULessThan | Op::UGreaterThan | Op::ULessThanEqual | Op::UGreaterThanEqual
            );
            let operands = ids(instruction);
            if comparison
                && operands.iter().any(|id| constants.contains(id))
                && operands.iter().any(|&id| flow.is_bits(id))
                && instruction.result_id.is_some_and(|id| flow.decides(id))
            {
                guards += 1;
            }
        }
    }
    guards
}

/// A module as `spirv-opt` leaves it, its specialisation constants set; `None` where that tool is missing.
fn optimised(kernel: &Kernel, specialization: &[(u32, u32)]) -> Option<Vec<u32>> {
    let defaults: Vec<String> = specialization.iter().map(|(id, value)| format!("{id}:{value}")).collect();
    let set = format!("--set-spec-const-default-value={}", defaults.join(" "));
    let mut arguments = vec!["--freeze-spec-const", "--fold-spec-const-op-composite", "-O", "-", "-o", "-"];
    if !defaults.is_empty() {
        arguments.insert(0, &set);
    }
    let output = tool("spirv-opt", &arguments, kernel.spirv)?;
    assert!(output.status.success(), "{}: spirv-opt fails", kernel.name);
    Some(words(&output.stdout))
}

#[test]
fn the_guard_is_in_every_module() {
    // One function has it for polygons, and another for round lights
    assert_eq!(guards(&module(&EVAL.words())), 1);
    assert_eq!(guards(&module(&SHADE.words())), 2);
    assert_eq!(guards(&module(&UNGUARDED.words())), 0, "the twin: no guard is seen where there is none");
}

#[test]
fn the_guard_outlives_the_optimiser() {
    // The optimiser takes a second and more for each: every path and horizon
    for effects in [Effects::all(), Effects::all() - Effects::POLYGON] {
        for horizon in [Horizon::Cosine, Horizon::Both] {
            // The other kernel has the same functions
            let kernels = if horizon == Horizon::Both { &[&EVAL, &SHADE][..] } else { &[&EVAL] };
            for kernel in kernels {
                let constants = [(constant::EFFECTS, effects.bits()), (constant::HORIZON, horizon as u32)];
                let Some(words) = optimised(kernel, &constants) else { return };
                // Inlined for each of two lobes
                let found = guards(&module(&words));
                let what = format!("{}, {effects}, {horizon:?}", kernel.name);
                assert!(found >= 2, "{what}: {found} comparisons are left for two lobes");
            }
        }
    }
    let Some(words) = optimised(&UNGUARDED, &[]) else { return };
    assert_eq!(guards(&module(&words)), 0, "the twin");
}

/// Lights with each vertex in turn replaced by NaN or infinity, and whole ones.
fn poisoned() -> Vec<[[f32; 4]; 4]> {
    let whole =
        [[-1.0, -1.0, 2.0, 0.0], [-1.0, 1.0, 2.0, 0.0], [1.0, 1.0, 2.0, 0.0], [1.0, -1.0, 2.0, 0.0_f32]];
    let mut lights = vec![whole];
    let quiet_and_signalling = [f32::NAN, f32::from_bits(0x7f80_0001), f32::from_bits(0xffff_ffff)];
    for poison in quiet_and_signalling.into_iter().chain([f32::INFINITY, f32::NEG_INFINITY]) {
        for vertex in 0..4 {
            for axis in 0..3 {
                let mut light = whole;
                light[vertex][axis] = poison;
                lights.push(light);
            }
        }
    }
    lights
}

#[test]
fn what_is_not_finite_gives_zero_to_the_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let lights = poisoned();
    let square = lights[0].map(|v| DVec3::new(v[0].into(), v[1].into(), v[2].into()));
    let surface = Surface { diffuse_albedo: DVec3::ONE, ..glossy_surface(0.3) };
    let mut given = Cases::new(&vec![point(surface, DVec3::Z, square.into(), true); lights.len()]);
    given.vertices = lights.iter().flatten().map(|v| [v[0], v[1], v[2] - 2.0, 0.0]).collect();
    let levels = Level::of(&[Path::Quad, Path::Polygon], &[Horizon::Cosine, Horizon::Both]);
    let lobes = [SpecularLobes::Two, SpecularLobes::HalfVectors];
    for (mut level, lobes) in levels.into_iter().flat_map(|level| lobes.map(|lobes| (level, lobes))) {
        level.quality.specular_lobes = lobes;
        let answers = engine.run(&given, level.effects(Effects::DIFFUSE | Effects::GLOSSY), level.quality);
        assert!(f32::from_bits(answers[0][0]) > 0.1, "{level}: the whole light shines");
        for (light, answer) in lights.iter().zip(&answers).skip(1) {
            assert_eq!(*answer, [0; 4], "{level}: {light:?}");
        }
    }
}

#[test]
fn without_the_guard_nan_comes_through() {
    let Some(engine) = TestEngine::new() else { return };
    let lights = poisoned();
    let buffer = engine.host().storage_buffer("vertices", &lights).unwrap();
    let found: Vec<[u32; 4]> =
        engine.dispatch(&UNGUARDED, &[], &[Resource::buffer(buffer.handle())], lights.len());
    assert!((0.1..1.0).contains(&f32::from_bits(found[0][0])));
    // The sign bit aside, NaN is beyond infinity
    let nan = found[1..].iter().filter(|bits| bits[0] & 0x7fff_ffff > INFINITY).count();
    assert!(nan * 2 > found.len(), "NaN comes through in {nan} of {}", found.len());
    // A clamp hides it, or does not: what it makes of NaN is left open
    let wrong = found[1..].iter().filter(|bits| bits[1] != 0).count();
    println!("a clamp lets {wrong} of {} through as something other than 0", found.len() - 1);
}
