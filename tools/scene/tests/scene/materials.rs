//! Materials, textures, and the effects that they need.

use crate::shapes::panel;
use crate::writer::{Writer, png};
use crate::{error, load, panel_with, warnings};
use arealight::Effects;
use arealight_oracle::material::Material;
use arealight_oracle::thin_film::ThinFilm;
use arealight_scene::{Scene, SceneBuffers, Wrap, required_effects};
use arealight_tool_kernels::gpu::{GpuMaterial, GpuTexture};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};

fn material(value: Value) -> Material {
    load(panel_with(value)).materials[0].material
}

#[test]
fn factors_and_defaults() {
    // glTF's defaults are those of a white, rough metal
    let default = material(json!({}));
    let expected = Material { metalness: 1.0, ..Material::default() };
    assert_eq!(default, expected);
    // No material at all is the same
    let mut writer = panel_with(json!({}));
    writer.root["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("material");
    let scene = load(writer);
    assert_eq!((scene.materials[0].material, scene.materials[0].name.as_str()), (expected, "default"));

    let read = material(json!({ "pbrMetallicRoughness": {
        "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.25, "roughnessFactor": 0.5 } }));
    assert_eq!((read.base_color, read.metalness, read.roughness), (Vec3::new(0.1, 0.2, 0.3), 0.25, 0.5));
}

#[test]
fn index_and_specular_make_the_dielectric() {
    let with = |extensions: Value| {
        let read = material(json!({ "extensions": extensions }));
        (read.dielectric_f0, read.dielectric_f90)
    };
    let close = |(f0, f90): (Vec3, f32), expected: Vec3, grazing: f32| {
        assert!((f0 - expected).length() < 1e-6 && f90 == grazing, "{f0} {f90}");
    };
    close(with(json!({ "KHR_materials_ior": { "ior": 1.5 } })), Vec3::splat(0.04), 1.0);
    close(with(json!({ "KHR_materials_ior": { "ior": 2.0 } })), Vec3::splat(1.0 / 9.0), 1.0);
    close(with(json!({ "KHR_materials_ior": { "ior": 0.0 } })), Vec3::ONE, 1.0);
    let specular = json!({ "specularFactor": 0.5, "specularColorFactor": [1.0, 0.5, 30.0] });
    close(with(json!({ "KHR_materials_specular": specular })), Vec3::new(0.02, 0.01, 0.5), 0.5);
    // Both: the colour multiplies the index's reflectance
    let both = json!({ "KHR_materials_ior": { "ior": 2.0 },
                       "KHR_materials_specular": { "specularColorFactor": [0.9, 0.9, 0.9] } });
    close(with(both), Vec3::splat(0.1), 1.0);
}

fn with_specular(values: &Value) -> Value {
    json!({ "pbrMetallicRoughness": { "metallicFactor": 0 },
        "extensions": { "KHR_materials_specular": values } })
}

#[test]
fn specular_is_read_with_its_textures() {
    let (scene, gpu) = read(with_specular(&json!({
        "specularFactor": 0.5, "specularTexture": { "index": 0 },
        "specularColorFactor": [1, 0.5, 50], "specularColorTexture": { "index": 0 } })));
    let read = &scene.materials[0];
    // The colour is sRGB, the weight is not
    let textures = [read.specular_texture, read.specular_color_texture].map(Option::unwrap);
    assert_eq!(textures.map(|index| scene.textures[index as usize].srgb), [false, true]);
    assert_eq!([gpu.specular_texture, gpu.specular_color_texture], textures);
    // What is above 1 is cut off by the kernel, below the colour's texture
    let f0 = Vec3::from_array(gpu.dielectric_f0);
    assert!((f0 - Vec3::new(0.02, 0.01, 1.0)).length() < 1e-6 && gpu.dielectric_f90 == 0.5, "{f0}");
    // A texture makes a usual dielectric unusual; none of either is read where the factor is zero
    let effects = |values: Value| {
        let scene = load(textured(with_specular(&values)));
        (scene.effects().contains(Effects::SPECULAR_INPUT), scene.textures.len())
    };
    for texture in ["specularTexture", "specularColorTexture"] {
        assert_eq!(effects(json!({ texture: { "index": 0 } })), (true, 1));
        assert_eq!(effects(json!({ "specularFactor": 0, texture: { "index": 0 } })), (true, 0));
    }
    assert_eq!(effects(json!({})), (false, 0));
}

#[test]
fn what_is_out_of_range_or_unknown_is_said() {
    let with = |extension: &str, field: &str, value: f32| with(extension, &json!({ field: value }));
    let film = |field: &str, value: f32| with_film(&json!({ "iridescenceFactor": 1, field: value }));
    let transformed = json!({ "clearcoatFactor": 1, "clearcoatTexture": { "index": 0 },
        "clearcoatRoughnessTexture": {
        "index": 0, "extensions": { "KHR_texture_transform": { "rotation": 1 } } } });
    for (value, text) in [
        (
            json!({ "pbrMetallicRoughness": { "roughnessFactor": 1.5 } }),
            "roughnessFactor [1.5] is not in [0, 1]: clamped",
        ),
        (json!({ "emissiveFactor": [0, 0, -1] }), "emissiveFactor [0.0, 0.0, -1.0] is negative: clamped"),
        (
            json!({ "alphaMode": "BLEND" }),
            "alphaMode BLEND: seen whole where alpha is 0.5 or more; its shadow is blended",
        ),
        (with("KHR_materials_ior", "ior", 0.5), "KHR_materials_ior: 0.5 is below 1: 1.5 is used"),
        (
            with("KHR_materials_emissive_strength", "emissiveStrength", -1.0),
            "emissiveStrength -1 must be finite and not negative: 0 is used",
        ),
        (
            with("KHR_materials_volume", "thicknessFactor", 1.0),
            "KHR_materials_volume is not supported: ignored",
        ),
        (
            with("KHR_materials_clearcoat", "clearcoatFactor", 1.5),
            "clearcoatFactor [1.5] is not in [0, 1]: clamped",
        ),
        (
            clearcoat(&transformed),
            "clearcoatTexture: mapped otherwise than clearcoatRoughnessTexture, drawn as that is",
        ),
        (film("iridescenceIor", 0.5), "iridescenceIor 0.5 is not in 1 to 100: 1.3 is used"),
        (
            film("iridescenceThicknessMaximum", -3.0),
            "iridescenceThicknessMaximum -3 is no thickness: 0 is used",
        ),
        (film("iridescenceFactor", 2.0), "iridescenceFactor [2.0] is not in [0, 1]: clamped"),
        (
            with_anisotropy(&json!({ "anisotropyStrength": 2.0 })),
            "anisotropyStrength [2.0] is not in [0, 1]: clamped",
        ),
        (
            with_transmission(&json!({ "diffuseTransmissionFactor": 2.0 })),
            "diffuseTransmissionFactor [2.0] is not in [0, 1]: clamped",
        ),
    ] {
        let scene = load(textured(value));
        assert_eq!(warnings(&scene), [format!("material '#0': {text}")]);
        assert!((0.0..=1.0).contains(&scene.materials[0].material.roughness));
    }
}

#[test]
fn what_is_wrong_with_extensions_is_named() {
    let missing = json!({ "index": 7 });
    for (extension, values, text) in [
        ("clearcoat", json!({ "clearcoatFactor": "much" }), "material '#0': KHR_materials_clearcoat"),
        ("clearcoat", json!({ "clearcoatFactor": 1, "clearcoatTexture": missing }), "textures[7]"),
        ("sheen", json!({ "sheenColorFactor": [1, 1] }), "material '#0': KHR_materials_sheen"),
        ("sheen", json!({ "sheenColorFactor": [1, 1, 1], "sheenColorTexture": missing }), "textures[7]"),
        ("anisotropy", json!({ "anisotropyStrength": "much" }), "material '#0': KHR_materials_anisotropy"),
        (
            "diffuse_transmission",
            json!({ "diffuseTransmissionFactor": "much" }),
            "material '#0': KHR_materials_diffuse_transmission",
        ),
    ] {
        let text_of = error(textured(with(&format!("KHR_materials_{extension}"), &values)));
        assert!(text_of.contains(text), "{text_of}");
    }
}

/// A writer with a panel and a texture of 2 by 1 texels (half red with alpha 128, white).
fn textured(material: Value) -> Writer {
    let mut writer = panel_with(material);
    let image = image::RgbaImage::from_raw(2, 1, vec![128, 0, 0, 128, 255, 255, 255, 255]).unwrap();
    writer.texture("texture", &png(image));
    writer
}

/// What is read of a material with that texture, without a warning: the scene, and what the GPU has of it.
fn read(material: Value) -> (Scene, GpuMaterial) {
    let scene = load(textured(material));
    assert_eq!(warnings(&scene), [""; 0]);
    let gpu = SceneBuffers::new(&scene, DVec3::ZERO).unwrap().materials[0];
    (scene, gpu)
}

#[test]
fn textures_are_decoded_and_shared() {
    let scene = load(textured(json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 },
                                  "metallicRoughnessTexture": { "index": 0 } },
        "normalTexture": { "index": 0, "scale": 0.5 }, "emissiveTexture": { "index": 0 } })));
    let read = &scene.materials[0];
    assert_eq!((read.base_color_texture, read.emission_texture), (Some(0), Some(0)));
    assert_eq!((read.metallic_roughness_texture, read.normal_texture), (Some(1), Some(1)));
    assert_eq!(read.normal_scale, 0.5);
    assert_eq!((scene.textures[0].srgb, scene.textures[1].srgb), (true, false));
    assert_eq!(scene.images.len(), 1);
    assert_eq!((scene.images[0].width, scene.images[0].height), (2, 1));
    assert_eq!(scene.images[0].texels, [0x8000_0080, 0xFFFF_FFFF]);
    assert_eq!(warnings(&scene), [""; 0]);
    // On the GPU each has levels of its own, since means of sRGB are others
    let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
    assert_eq!(buffers.texels.len(), 6);
    assert_eq!((buffers.textures[0].first_texel, buffers.textures[1].first_texel), (0, 3));
    assert_eq!(
        buffers.textures[0],
        GpuTexture { first_texel: 0, width: 2, height: 1, flags: GpuTexture::SRGB }
    );
    assert_eq!(buffers.textures[1].flags, 0);
    assert_eq!((buffers.materials[0].normal_texture, buffers.materials[0].normal_scale), (1, 0.5));
}

/// A material with an extension.
fn with(extension: &str, values: &Value) -> Value {
    json!({ "extensions": { extension: values } })
}

fn clearcoat(values: &Value) -> Value {
    with("KHR_materials_clearcoat", values)
}

#[test]
fn a_clear_coat_is_read_with_its_textures() {
    let (scene, gpu) = read(clearcoat(&json!({
        "clearcoatFactor": 0.75, "clearcoatTexture": { "index": 0 },
        "clearcoatRoughnessFactor": 0.25, "clearcoatRoughnessTexture": { "index": 0 },
        "clearcoatNormalTexture": { "index": 0, "scale": 0.5 } })));
    let read = &scene.materials[0];
    assert_eq!((read.material.coat, read.material.coat_roughness), (0.75, 0.25));
    assert_eq!((read.coat_texture, read.coat_roughness_texture), (Some(0), Some(0)));
    assert_eq!((read.coat_normal_texture, read.coat_normal_scale), (Some(0), 0.5));
    assert!(!scene.textures[0].srgb);
    assert_eq!((gpu.coat, gpu.coat_roughness), (0.75, 0.25));
    assert_eq!([gpu.coat_texture, gpu.coat_roughness_texture, gpu.coat_normal_texture], [0; 3]);
    assert_eq!(gpu.coat_normal_scale, 0.5);
    // None without the extension, and none of its textures where its factor is zero, which is the default
    for without in [json!({}), clearcoat(&json!({ "clearcoatTexture": { "index": 0 } }))] {
        let scene = load(textured(without));
        let read = &scene.materials[0];
        assert_eq!((read.material.coat, read.coat_texture, scene.textures.len()), (0.0, None, 0));
        assert_eq!(
            SceneBuffers::new(&scene, DVec3::ZERO).unwrap().materials[0].coat_texture,
            GpuMaterial::NO_TEXTURE
        );
    }
}

#[test]
fn a_coat_has_a_normal_of_its_own_where_textures_bend_it_or_what_is_below() {
    let effects = |normal: Value, coat: Value| {
        let mut material = clearcoat(&coat);
        if !normal.is_null() {
            material["normalTexture"] = normal;
        }
        load(textured(material)).effects() & (Effects::COAT | Effects::COAT_NORMAL)
    };
    let texture = |scale: f32| json!({ "index": 0, "scale": scale });
    let coat = |scale: Option<f32>| match scale {
        None => json!({ "clearcoatFactor": 1 }),
        Some(scale) => json!({ "clearcoatFactor": 1, "clearcoatNormalTexture": texture(scale) }),
    };
    let both = Effects::COAT | Effects::COAT_NORMAL;
    assert_eq!(effects(Value::Null, coat(None)), Effects::COAT);
    assert_eq!(effects(texture(1.0), coat(None)), both);
    assert_eq!(effects(Value::Null, coat(Some(1.0))), both);
    assert_eq!(effects(texture(1.0), coat(Some(0.5))), both);
    // Both are bent alike
    assert_eq!(effects(texture(0.5), coat(Some(0.5))), Effects::COAT);
    // No weight, no coat
    assert_eq!(effects(texture(1.0), json!({ "clearcoatFactor": 0 })), Effects::empty());
}

#[test]
fn sheen_is_read_with_its_textures() {
    let (scene, gpu) = read(with(
        "KHR_materials_sheen",
        &json!({
        "sheenColorFactor": [0.75, 0.5, 0.25], "sheenColorTexture": { "index": 0 },
        "sheenRoughnessFactor": 0.25, "sheenRoughnessTexture": { "index": 0 } }),
    ));
    let read = &scene.materials[0];
    assert_eq!(read.material.sheen_color.to_array(), [0.75, 0.5, 0.25]);
    assert_eq!(read.material.sheen_roughness, 0.25);
    // The colour is sRGB, the roughness is not
    let textures = [read.sheen_color_texture, read.sheen_roughness_texture].map(Option::unwrap);
    assert_eq!(textures.map(|index| scene.textures[index as usize].srgb), [true, false]);
    assert!(scene.effects().contains(Effects::SHEEN));
    assert_eq!((gpu.sheen_color, gpu.sheen_roughness), ([0.75, 0.5, 0.25], 0.25));
    assert_eq!([gpu.sheen_color_texture, gpu.sheen_roughness_texture], textures);
    // None without the extension, and none of its textures where its colour is black, which is the default
    for without in [json!({}), with("KHR_materials_sheen", &json!({ "sheenColorTexture": { "index": 0 } }))] {
        let scene = load(textured(without));
        let read = &scene.materials[0];
        assert_eq!((read.sheen_color_texture, scene.textures.len()), (None, 0));
        assert!(!scene.effects().contains(Effects::SHEEN));
    }
}

fn with_film(values: &Value) -> Value {
    with("KHR_materials_iridescence", values)
}

#[test]
fn thin_films_are_read_with_their_textures() {
    let (scene, gpu) = read(with_film(&json!({
        "iridescenceFactor": 0.5, "iridescenceTexture": { "index": 0 }, "iridescenceIor": 1.5,
        "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 600,
        "iridescenceThicknessTexture": { "index": 0 } })));
    let read = &scene.materials[0];
    assert_eq!(read.material.film, Some(ThinFilm { weight: 0.5, ior: 1.5, thickness: 600.0 }));
    let film = [gpu.film_weight, gpu.film_ior, gpu.film_least_thickness, gpu.film_thickness];
    assert_eq!(film, [0.5, 1.5, 200.0, 600.0]);
    assert_eq!(
        [gpu.film_texture, gpu.film_thickness_texture].map(|index| scene.textures[index as usize].srgb),
        [false; 2]
    );
    // A film lies above reflectances, which are the usual ones
    let effects = |metalness: f32| {
        let mut material = with_film(&json!({ "iridescenceFactor": 1 }));
        material["pbrMetallicRoughness"] = json!({ "metallicFactor": metalness });
        load(textured(material)).effects()
    };
    assert_eq!(effects(1.0), Effects::GLOSSY | Effects::THIN_FILM);
    assert_eq!(effects(0.0), Effects::GLOSSY | Effects::DIFFUSE | Effects::COUPLED | Effects::THIN_FILM);
    // The extension's defaults; no film without it, without a factor, and without a thickness
    let film = |values: Value| load(textured(values)).materials[0].material.film;
    let usual = ThinFilm { weight: 1.0, ior: f64::from(1.3_f32), thickness: 400.0 };
    assert_eq!(film(with_film(&json!({ "iridescenceFactor": 1 }))), Some(usual));
    let without = json!({ "iridescenceFactor": 1, "iridescenceThicknessMaximum": 0 });
    for none in [json!({}), with_film(&json!({})), with_film(&without)] {
        assert_eq!(film(none), None);
    }
}

#[test]
fn wrap_modes_become_flags() {
    let wrapped = |sampler: Value| {
        let mut writer = textured(json!({ "normalTexture": { "index": 0 } }));
        writer.push("samplers", sampler);
        writer.root["textures"][0]["sampler"] = json!(0);
        let scene = load(writer);
        let flags = SceneBuffers::new(&scene, DVec3::ZERO).unwrap().textures[0].flags;
        ([scene.textures[0].wrap_u, scene.textures[0].wrap_v], flags)
    };
    let (clamp, mirror) = (33071, 33648);
    let (modes, flags) = wrapped(json!({}));
    assert_eq!((modes, flags), ([Wrap::Repeat; 2], 0));
    let (modes, flags) = wrapped(json!({ "wrapS": clamp, "wrapT": mirror }));
    assert_eq!((modes, flags), ([Wrap::Clamp, Wrap::Mirror], GpuTexture::CLAMP_U | GpuTexture::MIRROR_V));
    let (_, flags) = wrapped(json!({ "wrapS": mirror, "wrapT": clamp }));
    assert_eq!(flags, GpuTexture::MIRROR_U | GpuTexture::CLAMP_V);
}

#[test]
fn texture_features_that_are_missing_are_said() {
    let specular = json!({ "specularTexture": { "index": 0 } });
    let mut writer = textured(json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "texCoord": 1 } },
        "normalTexture": { "index": 0, "extensions": { "KHR_texture_transform": {} } },
        "emissiveTexture": { "index": 0, "extensions": { "KHR_texture_transform": {} } },
        "extensions": { "KHR_materials_specular": specular } }));
    let attributes = &mut writer.root["meshes"][0]["primitives"][0]["attributes"];
    attributes.as_object_mut().unwrap().remove("TEXCOORD_0");
    let expected = [
        "meshes[0] 'panel'.primitives[0]: has no TEXCOORD_0: its emissive texture is read at (0, 0)",
        "material '#0': normalTexture, emissiveTexture, specularTexture: mapped otherwise than \
        baseColorTexture, drawn as that is",
        "meshes[0] 'panel'.primitives[0]: has no TEXCOORD_1: its textures are read at (0, 0)",
    ];
    assert_eq!(warnings(&load(writer)), expected);
}

#[test]
fn masks_and_sides_become_flags() {
    let scene = load(panel_with(json!({ "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 0.75] } })));
    let gpu = SceneBuffers::new(&scene, DVec3::ZERO).unwrap().materials[0];
    assert_eq!(gpu.flags, GpuMaterial::ALPHA_MASK | GpuMaterial::DOUBLE_SIDED);
    assert_eq!((gpu.alpha_cutoff, gpu.base_alpha), (0.25, 0.75));
    assert_eq!(gpu.base_color_texture, GpuMaterial::NO_TEXTURE);
    let scene = load(panel_with(json!({ "alphaMode": "MASK" })));
    assert_eq!(scene.materials[0].alpha_cutoff, Some(0.5), "glTF's default");
    assert_eq!(load(panel_with(json!({}))).materials[0].alpha_cutoff, None);
}

#[test]
fn effects_are_what_the_scene_needs() {
    let required = |scene: &Scene| -> Vec<String> {
        let required = required_effects(scene);
        let union: Effects = required.iter().map(|one| one.effect).collect();
        assert_eq!(union, scene.effects());
        required.iter().map(ToString::to_string).collect()
    };
    let metal = json!({ "name": "metal" });
    assert_eq!(required(&load(panel_with(metal))), ["glossy: material 'metal'"]);
    // A metal whose texture can make it a dielectric
    let maybe = json!({ "pbrMetallicRoughness": { "metallicRoughnessTexture": { "index": 0 } } });
    let both = ["diffuse: material '#0'", "glossy: material '#0'", "coupled: material '#0'"];
    assert_eq!(required(&load(textured(maybe))), both);
    let matte = json!({ "name": "matte", "pbrMetallicRoughness": { "metallicFactor": 0 },
                        "extensions": { "KHR_materials_specular": { "specularFactor": 0 } } });
    let matte = load(panel_with(matte));
    assert_eq!(required(&matte), ["diffuse: material 'matte'", "specular_input: material 'matte'"]);
    let black = json!({ "name": "black", "pbrMetallicRoughness": {
        "metallicFactor": 0, "baseColorFactor": [0, 0, 0, 1] } });
    assert_eq!(required(&load(panel_with(black.clone()))), ["glossy: material 'black'"]);
    // An index of 1.5 is the usual one; a metal's index does not matter
    let mut usual = black.clone();
    usual["extensions"] = json!({ "KHR_materials_ior": { "ior": 1.5 } });
    assert_eq!(required(&load(panel_with(usual))), ["glossy: material 'black'"]);
    let metal = json!({ "name": "metal", "extensions": { "KHR_materials_ior": { "ior": 3 } } });
    assert_eq!(required(&load(panel_with(metal))), ["glossy: material 'metal'"]);
    // Lights
    let mut writer = panel_with(black);
    let sign = writer.emitter("sign", [1.0; 3], true);
    writer.object("sign", &panel(1.0, 1.0), sign, json!({}));
    assert_eq!(required(&load(writer)), ["glossy: material 'black' and 1 more", "two_sided: light 'sign'"]);
}

#[test]
fn materials_that_nothing_is_made_of_do_not_count() {
    let mut writer = panel_with(json!({ "name": "used" }));
    writer.push("materials", json!({ "name": "unused", "alphaMode": "BLEND" }));
    let scene = load(writer);
    assert_eq!((scene.materials.len(), warnings(&scene).len()), (1, 0));
}

fn with_anisotropy(values: &Value) -> Value {
    with("KHR_materials_anisotropy", values)
}

#[test]
fn anisotropy_is_read_with_its_texture() {
    let (scene, gpu) = read(with_anisotropy(&json!({
        "anisotropyStrength": 0.75, "anisotropyRotation": 0.5, "anisotropyTexture": { "index": 0 } })));
    let read = &scene.materials[0];
    assert_eq!((read.anisotropy_strength, read.anisotropy_rotation), (0.75, 0.5));
    let texture = read.anisotropy_texture.unwrap();
    assert!(!scene.textures[texture as usize].srgb);
    assert!(scene.effects().contains(Effects::ANISOTROPY));
    assert_eq!((gpu.anisotropy_texture, gpu.anisotropy_strength), (texture, 0.75));
    assert_eq!(gpu.anisotropy_direction, [0.5_f32.cos(), 0.5_f32.sin()]);
    // None without the extension, nor of its texture where the strength is zero, which is the default
    for without in [json!({}), with_anisotropy(&json!({ "anisotropyTexture": { "index": 0 } }))] {
        let scene = load(textured(without));
        assert_eq!((scene.materials[0].anisotropy_texture, scene.textures.len()), (None, 0));
        assert!(!scene.effects().contains(Effects::ANISOTROPY));
    }
}

fn with_transmission(values: &Value) -> Value {
    json!({ "pbrMetallicRoughness": { "metallicFactor": 0 },
            "extensions": { "KHR_materials_diffuse_transmission": values } })
}

#[test]
fn diffuse_transmission_is_read_with_both_textures() {
    let (scene, gpu) = read(with_transmission(&json!({
        "diffuseTransmissionFactor": 0.75, "diffuseTransmissionColorFactor": [0.25, 0.5, 1.0],
        "diffuseTransmissionTexture": { "index": 0 }, "diffuseTransmissionColorTexture": { "index": 0 } })));
    let read = &scene.materials[0];
    assert_eq!(read.material.transmission, 0.75);
    assert_eq!(read.material.transmission_color.to_array(), [0.25, 0.5, 1.0]);
    assert!(scene.effects().contains(Effects::TRANSMISSION));
    assert_eq!((gpu.transmission, gpu.transmission_color), (0.75, [0.25, 0.5, 1.0]));
    let textures = [gpu.transmission_texture, gpu.transmission_color_texture];
    assert_eq!(textures.map(|index| scene.textures[index as usize].srgb), [false, true]);
    // Half of the diffuse light of the front is what is left
    let surface = read.material.surface();
    assert_eq!(
        (surface.diffuse_albedo, read.material.other_side().diffuse_albedo.x),
        (DVec3::splat(0.25), 0.75 * 0.25)
    );
    // None without the extension, nor of its textures where the factor is zero, which is the default; nor of
    // a metal
    for without in [json!({}), with_transmission(&json!({ "diffuseTransmissionTexture": { "index": 0 } }))] {
        let scene = load(textured(without));
        assert_eq!((scene.materials[0].transmission_texture, scene.textures.len()), (None, 0));
        assert!(!scene.effects().contains(Effects::TRANSMISSION));
    }
    let mut metal = with_transmission(&json!({ "diffuseTransmissionFactor": 1 }));
    metal["pbrMetallicRoughness"]["metallicFactor"] = json!(1);
    assert!(!load(panel_with(metal)).effects().contains(Effects::TRANSMISSION));
}

#[test]
fn panes_are_read_with_their_texture() {
    let with_pane = |values: Value| {
        json!({ "pbrMetallicRoughness": { "metallicFactor": 0, "baseColorFactor": [0.25, 0.5, 1, 1] },
                "extensions": { "KHR_materials_transmission": values } })
    };
    let (scene, gpu) =
        read(with_pane(json!({ "transmissionFactor": 0.75, "transmissionTexture": { "index": 0 } })));
    assert_eq!((gpu.glass, scene.textures[gpu.glass_texture as usize].srgb), (0.75, false));
    assert!(scene.effects().contains(Effects::GLASS) && !scene.effects().contains(Effects::TRANSMISSION));
    // A quarter of the light below the interface is diffused; what Fresnel's term leaves of the rest passes
    let material = scene.materials[0].material;
    assert_eq!(material.surface().diffuse_albedo, DVec3::new(0.0625, 0.125, 0.25));
    let through = material.other_side();
    assert!((through.f0 - DVec3::new(0.1875, 0.375, 0.75) * 0.96).length() < 1e-7, "{}", through.f0);
    assert_eq!((through.f90, through.diffuse_albedo), (0.0, DVec3::ZERO));
    // The twin: nothing of it where the factor is zero
    let without = load(textured(with_pane(json!({ "transmissionTexture": { "index": 0 } }))));
    assert_eq!((without.materials[0].glass_texture, without.textures.len()), (None, 0));
    assert!(!without.effects().contains(Effects::GLASS));
}
