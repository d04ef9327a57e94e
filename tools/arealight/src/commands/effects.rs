//! `arealight effects`: what a scene needs, and why.

use crate::failure::Failure;
use crate::lights::LightArguments;
use crate::output::{print, say_what_is_not_shown};
use arealight::Effects;
use arealight_scene::{RequiredEffect, required_effects};
use serde_json::json;
use std::path::PathBuf;
use std::process::ExitCode;

/// Say which effects a scene needs, and why.
///
/// Shaders are made for these effects alone; docs/effects.md says what that saves, docs/gpu.md what each
/// costs a GPU.
#[derive(clap::Args)]
pub struct Arguments {
    /// A .gltf or .glb file
    scene: PathBuf,
    #[command(flatten)]
    lights: LightArguments,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    // No effect depends on where a camera is
    let (scene, _) = arguments.lights.load(Some(&arguments.scene), None, 1.0)?;
    say_what_is_not_shown(&scene, &arguments.scene);
    let required = required_effects(&scene);
    print(&if arguments.json { to_json(arguments, &required) } else { to_text(&required) })
}

/// Who needs an effect, if anybody does.
fn reason(required: &[RequiredEffect], effect: Effects) -> Option<&str> {
    required.iter().find(|one| one.effect == effect).map(|one| one.reason.as_str())
}

fn to_text(required: &[RequiredEffect]) -> String {
    let mut lines = vec![format!("{:18} needed by", "effect")];
    let set: Effects = required.iter().map(|one| one.effect).collect();
    lines.extend(
        set.iter()
            .filter_map(|effect| Some(format!("{:18} {}", effect.to_string(), reason(required, effect)?))),
    );
    lines.push(format!("\nThis scene's set: {set}\nWhat it leaves out: {}\n", Effects::all() - set));
    lines.join("\n")
}

fn to_json(arguments: &Arguments, required: &[RequiredEffect]) -> String {
    let effects: Vec<_> = Effects::all()
        .iter()
        .map(|effect| {
            let reason = reason(required, effect);
            json!({ "effect": effect.to_string(), "required": reason.is_some(), "reason": reason })
        })
        .collect();
    let summary = json!({
        "scene": arguments.scene.display().to_string(),
        "effects": effects,
        "required": required.iter().map(|one| one.effect.to_string()).collect::<Vec<_>>(),
    });
    format!("{summary:#}\n")
}
