//! The shade kernel in other languages: frozen for the effects that are named, translated, described.

use super::File;
use super::interface;
use super::single::LICENCE_LINE;
use super::translate::{Language, Translated, translate};
use crate::failure::Failure;
use arealight::plan::{ShadeOptions, shade_specialization};
use arealight::{Effects, LightSummary};
use arealight_tool_kernels::kernels::SHADE_PORTABLE;
use arealight_vk::freeze;
use serde_json::{Map, Value};

/// What the kernel is made for.
#[derive(clap::Args)]
pub struct TargetArguments {
    /// Also write the kernel shade in these interfaces' languages: WGSL, HLSL, MSL
    #[arg(
        long = "target",
        value_enum,
        value_name = "INTERFACE",
        value_delimiter = ',',
        requires = "effects"
    )]
    targets: Vec<Language>,
    /// The effects that those kernels have, of `arealight effects SCENE`, and nothing else; and the options'
    /// defaults in `single/arealight/arealight.glsl`
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = effect)]
    effects: Vec<Effects>,
    /// What those kernels read positions from
    #[arg(long, value_enum, value_name = "WHAT", default_value_t = Position::Image, requires = "targets")]
    position: Position,
}

/// Where positions come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Position {
    /// Positions in an image
    Image,
    /// A depth buffer, and the frame's matrix
    Depth,
}

/// Effects that mean nothing without another.
const NEEDS: [(Effects, Effects); 7] = [
    (Effects::MESH, Effects::POLYGON),
    (Effects::TEXTURED_ELLIPSE, Effects::ELLIPSE),
    (Effects::COAT_NORMAL, Effects::COAT),
    (Effects::COAT_BY_ALBEDO, Effects::COAT),
    (Effects::COUPLED, Effects::DIFFUSE),
    (Effects::COUPLED_BY_ALBEDO, Effects::COUPLED),
    (Effects::AZIMUTH, Effects::PROFILE),
];

/// The effect of a name.
fn effect(name: &str) -> Result<Effects, String> {
    Effects::all()
        .iter()
        .find(|effect| effect.to_string() == name)
        .ok_or_else(|| format!("there is no such effect; there are: {}", Effects::all()))
}

/// What hosts of every language run once to see that their table is right: `shaders/examples/self_test.comp`.
const SELF_TEST: &[u8] = include_bytes!("../../../../../benches/spirv/examples/self_test.spv");

impl TargetArguments {
    /// The effects that are named, if any.
    pub fn effects(&self) -> Option<Effects> {
        (!self.effects.is_empty()).then(|| self.effects.iter().copied().collect())
    }

    /// The files of every target, and what the manifest says of them.
    pub fn files(&self) -> Result<(Vec<File>, Map<String, Value>), Failure> {
        let (mut files, mut described) = (vec![], Map::new());
        let Some(effects) = self.effects() else { return Ok((files, described)) };
        check(effects)?;
        let spirv = frozen(effects, self.position)?;
        let twice = |(index, language): &(usize, &Language)| self.targets[..*index].contains(language);
        for (_, language) in self.targets.iter().enumerate().filter(|it| !twice(it)) {
            let mut add = |spirv: &[u32], name: &str, content: String| {
                let translated = translate(spirv, *language)
                    .map_err(|message| Failure::Argument { argument: "--target", message })?;
                let path = format!("{}/{name}.{}", language.folder(), language.ending());
                let bytes = (LICENCE_LINE.to_owned() + &translated.text).into_bytes();
                files.push(File { path: path.clone(), bytes, content });
                Ok(self.describe(effects, &path, &translated))
            };
            let content = format!("the kernel shade for {effects}, in {language}; see `targets`");
            described.insert(language.folder().into(), add(&spirv, "shade", content)?);
            add(&words(SELF_TEST), "self_test", format!("the self-test in {language}: table, result"))?;
        }
        Ok((files, described))
    }

    fn describe(&self, effects: Effects, path: &str, translated: &Translated) -> Value {
        let mut described = interface::describe(&translated.module, &translated.slots);
        described.insert("file".into(), path.into());
        described.insert("entry_point".into(), translated.entry_point.clone().into());
        described.insert("effects".into(), effects.names().into());
        let position = if self.position == Position::Depth { "depth" } else { "image" };
        described.insert("position".into(), position.into());
        described.into()
    }
}

/// Refuses sets with a part that would do nothing.
fn check(effects: Effects) -> Result<(), Failure> {
    let fault = |message: String| Failure::Argument { argument: "--effects", message };
    if !effects.intersects(Effects::DIFFUSE | Effects::GLOSSY) {
        return Err(fault("without diffuse and glossy every surface is black; name one of them".into()));
    }
    if effects.contains(Effects::LINKED) {
        return Err(fault("linked reads a stencil, which this kernel has not: leave it out".into()));
    }
    match NEEDS.iter().find(|(effect, needed)| effects.contains(*effect) && !effects.contains(*needed)) {
        Some((effect, needed)) => Err(fault(format!("{effect} needs {needed}; name it, too"))),
        None => Ok(()),
    }
}

/// The portable kernel as SPIR-V with these effects and no other, and without specialisation constants.
fn frozen(effects: Effects, position: Position) -> Result<Vec<u32>, Failure> {
    let options = ShadeOptions {
        surfaces: effects & Effects::SURFACES,
        from_depth: position == Position::Depth,
        ..ShadeOptions::default()
    };
    // Of the counts only whether there are quads is in the kernel: it has them, and a frame says how many
    let lights = LightSummary { light_count: 1, quad_count: 1, effects, ..LightSummary::default() };
    freeze(&words(SHADE_PORTABLE), &shade_specialization(options, lights)).ok_or_else(|| Failure::Argument {
        argument: "--target",
        message: "the kernel computes of its constants what cannot be known before it runs; this is a fault \
        of Arealight"
            .into(),
    })
}

fn words(spirv: &[u8]) -> Vec<u32> {
    spirv.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sets from the least to everything, with the most bytes of WGSL that they may have: a tenth more than
    /// they have, so that an effect that gets into a kernel which does not need it shows.
    const SETS: [(&str, usize); 9] = [
        ("diffuse,glossy", 79_000),
        ("diffuse,glossy,polygon,two_sided", 103_000),
        ("diffuse,glossy,polygon,mesh,textured", 144_000),
        ("diffuse,glossy,ellipse,sphere,tube", 235_000),
        ("diffuse,glossy,ellipse,textured_ellipse", 149_000),
        ("diffuse,glossy,coat,coat_normal", 86_000),
        ("diffuse,glossy,coupled,coupled_by_albedo,multiple_scattering", 82_000),
        ("diffuse,glossy,sheen,anisotropy,diffuse_roughness", 121_000),
        (
            "diffuse,glossy,two_sided,specular_input,polygon,textured,ellipse,sphere,tube,mesh,textured_ellipse,coat,coat_normal,coupled,\
             coupled_by_albedo,coat_by_albedo,diffuse_roughness,sheen,anisotropy,multiple_scattering,transmission,\
             thin_film,glass,profile,opening,linked,azimuth",
            433_000,
        ),
    ];

    fn effects_of(names: &str) -> Effects {
        names.split(',').map(|name| effect(name).unwrap()).collect()
    }

    #[test]
    fn every_set_of_effects_is_translated_and_none_has_another() {
        for (names, most) in SETS {
            for position in [Position::Image, Position::Depth] {
                let spirv = frozen(effects_of(names), position).unwrap();
                let [wgsl, hlsl, msl] = [Language::Webgpu, Language::Hlsl, Language::Msl].map(|language| {
                    translate(&spirv, language).unwrap_or_else(|error| panic!("{names}: {error}"))
                });
                let sizes = [&wgsl, &hlsl, &msl].map(|translated| translated.text.len());
                println!(
                    "{names}, {position:?}: {} bytes of SPIR-V, of WGSL, HLSL, MSL {sizes:?}",
                    4 * spirv.len()
                );
                assert!(sizes[0] <= most, "{names}: {} bytes of WGSL", sizes[0]);
            }
        }
        assert!(effects_of(SETS[8].0).is_all(), "the last set is every effect");
        let linked = check(effects_of("diffuse,linked")).unwrap_err().to_string();
        assert!(linked.contains("which this kernel has not") && check(effects_of("diffuse")).is_ok());
    }

    #[test]
    fn a_kernel_that_is_not_frozen_is_refused() {
        let refused = translate(&words(SHADE_PORTABLE), Language::Webgpu).err().unwrap();
        assert!(refused.contains("naga cannot read the kernel"), "{refused}");
    }

    #[test]
    fn sets_of_which_a_part_does_nothing_are_refused() {
        let said = |names: &str| check(effects_of(names)).unwrap_err().to_string();
        assert!(said("polygon").contains("every surface is black"));
        assert!(said("diffuse,mesh").contains("mesh needs polygon"));
        assert!(effect("glosy").unwrap_err().contains("there are: diffuse, glossy"));
        assert!(check(effects_of("diffuse,polygon,mesh")).is_ok());
    }
}
