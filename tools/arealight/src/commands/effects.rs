//! `arealight effects`: what a scene calls for, why, and what each effect costs.

use crate::failure::Failure;
use crate::output::print;
use arealight::Effects;
use arealight_benches::instructions::Instructions;
use arealight_scene::{Call, Scene, required_effects};
use serde_json::json;
use std::path::PathBuf;
use std::process::ExitCode;

/// What a scene calls for, why, and what each effect adds to the shade kernel in instructions.
///
/// Shaders are made for these effects alone; docs/effects.md says what that saves.
#[derive(clap::Args)]
pub struct Arguments {
    /// A .gltf or .glb file
    scene: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let path = &arguments.scene;
    let scene = Scene::load(path).map_err(|error| Failure::Scene(error.to_string()))?;
    for warning in &scene.warnings {
        eprintln!("warning: {}: {warning}", path.display());
    }
    let calls = required_effects(&scene);
    let instructions = Instructions::checked_in();
    print(&if arguments.json {
        to_json(arguments, &calls, &instructions)
    } else {
        to_text(&calls, &instructions)
    })
}

/// Who calls for an effect, if anybody does.
fn reason(calls: &[Call], effect: Effects) -> Option<&str> {
    calls.iter().find(|call| call.effect == effect).map(|call| call.reason.as_str())
}

fn to_text(calls: &[Call], instructions: &Instructions) -> String {
    let reasons: Vec<_> = Effects::all().iter().map(|effect| (effect, reason(calls, effect))).collect();
    let width = reasons.iter().map(|(_, reason)| reason.unwrap_or("-").len()).max().unwrap_or(0).max(9);
    let mut lines = vec![format!("{:16} {:width$}  instructions", "effect", "called by")];
    for (effect, reason) in reasons {
        let added = instructions.added_by(effect).map_or_else(
            || "not counted".to_owned(),
            |added| format!("{:+}", i64::from(added.with) - i64::from(added.without)),
        );
        lines.push(format!("{:16} {:width$}  {added:>12}", effect.to_string(), reason.unwrap_or("-")));
    }
    if let Some(plain) = instructions.find("plain") {
        let both = Effects::from_bits_truncate(plain.effects);
        lines.push(format!(
            "\nInstructions of the shade kernel's SPIR-V after {}, beside {} with {both} on the first quality \
             levels.",
            instructions.tool, plain.instructions
        ));
    }
    let called: Effects = calls.iter().map(|call| call.effect).collect();
    lines.push(format!("This scene's set: {called}\n"));
    lines.join("\n")
}

fn to_json(arguments: &Arguments, calls: &[Call], instructions: &Instructions) -> String {
    let effects: Vec<_> = Effects::all()
        .iter()
        .map(|effect| {
            let added = instructions.added_by(effect);
            json!({
                "effect": effect.to_string(),
                "required": reason(calls, effect).is_some(),
                "reason": reason(calls, effect),
                "instructions_without": added.map(|added| added.without),
                "instructions_with": added.map(|added| added.with),
            })
        })
        .collect();
    let summary = json!({
        "scene": arguments.scene,
        "effects": effects,
        "required": calls.iter().map(|call| call.effect.to_string()).collect::<Vec<_>>(),
        "counted_by": instructions.tool,
    });
    format!("{summary:#}\n")
}
