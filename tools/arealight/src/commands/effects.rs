//! `arealight effects`: what a scene needs, and why.

use crate::failure::Failure;
use crate::output::print;
use arealight::Effects;
use arealight_scene::{Call, Scene, required_effects};
use serde_json::json;
use std::path::PathBuf;
use std::process::ExitCode;

/// What a scene needs, and why.
///
/// Shaders are made for these effects alone; docs/effects.md says what that saves, docs/gpu.md what each costs a GPU.
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
    print(&if arguments.json { to_json(arguments, &calls) } else { to_text(&calls) })
}

/// Who needs an effect, if anybody does.
fn reason(calls: &[Call], effect: Effects) -> Option<&str> {
    calls.iter().find(|call| call.effect == effect).map(|call| call.reason.as_str())
}

fn to_text(calls: &[Call]) -> String {
    let mut lines = vec![format!("{:16} called by", "effect")];
    for effect in Effects::all().iter() {
        lines.push(format!("{:16} {}", effect.to_string(), reason(calls, effect).unwrap_or("-")));
    }
    let called: Effects = calls.iter().map(|call| call.effect).collect();
    lines.push(format!("\nThis scene's set: {called}\n"));
    lines.join("\n")
}

fn to_json(arguments: &Arguments, calls: &[Call]) -> String {
    let effects: Vec<_> = Effects::all()
        .iter()
        .map(|effect| {
            let reason = reason(calls, effect);
            json!({ "effect": effect.to_string(), "required": reason.is_some(), "reason": reason })
        })
        .collect();
    let summary = json!({
        "scene": arguments.scene,
        "effects": effects,
        "required": calls.iter().map(|call| call.effect.to_string()).collect::<Vec<_>>(),
    });
    format!("{summary:#}\n")
}
