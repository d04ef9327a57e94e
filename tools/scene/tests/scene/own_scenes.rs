//! The scenes of `scenes/` load without a warning, and hold what they promise.

use arealight::Effects;
use arealight_scene::{Scene, SceneBuffers};
use glam::DVec3;
use std::path::{Path, PathBuf};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

fn load(name: &str) -> Scene {
    let scene = Scene::load(path(name)).unwrap();
    let warnings: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings, [""; 0], "{name}");
    let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
    // The camera sees a surface in the middle of its lower half, and all shading normals face outwards
    let camera = scene.camera(None, 16.0 / 9.0).unwrap();
    let [start, direction] = camera.ray([0.0, -0.5], 16.0 / 9.0);
    assert!(buffers.closest_hit(start, direction).is_some());
    for triangle in &scene.triangles {
        let [p, q, r] = triangle.positions;
        let flat = (q - p).cross(r - p);
        assert!(triangle.normals.iter().all(|n| n.as_dvec3().dot(flat) > 0.0), "{name}: {triangle:?}");
    }
    scene
}

/// What dielectrics of glTF need.
const LOBES: Effects = Effects::DIFFUSE.union(Effects::GLOSSY).union(Effects::COUPLED);

#[test]
fn every_file_loads_and_is_small() {
    let files = std::fs::read_dir(path("")).unwrap().map(|file| file.unwrap());
    let names: Vec<String> = files.map(|file| file.file_name().into_string().unwrap()).collect();
    assert_eq!(names.len(), 26);
    for name in names {
        load(&name);
        let size = std::fs::metadata(path(&name)).unwrap().len();
        assert!(size < 300_000, "{name} has {size} bytes");
    }
}

#[test]
fn the_sweep_covers_roughness_and_metalness_under_one_rectangle() {
    let scene = load("sweep.glb");
    for metalness in [1.0, 0.67, 0.33, 0.0] {
        for roughness in [0.05, 0.12, 0.2, 0.3, 0.42, 0.56, 0.75, 1.0] {
            let is_it = |m: &arealight_oracle::material::Material| {
                m.metalness == metalness && m.roughness == roughness
            };
            assert!(scene.materials.iter().any(|m| is_it(&m.material)), "{roughness} {metalness}");
        }
    }
    assert_eq!((scene.lights.len(), scene.lights[0].shape.vertices().len()), (1, 4));
    assert_eq!(scene.effects(), LOBES);
}

#[test]
fn the_coats_lie_on_every_base_and_beside_each_is_the_same_without() {
    let scene = load("coats.glb");
    for name in ["paint", "plastic", "hammered", "lacquer"] {
        let material = |name: &str| &scene.materials.iter().find(|m| m.name == name).unwrap().material;
        let (without, with) = (material(name), material(&format!("{name}, coated")));
        assert_eq!((without.coat, with.coat), (0.0, 1.0), "{name}");
        assert_eq!((without.base_color, without.roughness), (with.base_color, with.roughness), "{name}");
    }
    let coats = Effects::COAT | Effects::COAT_NORMAL;
    assert_eq!(scene.effects(), LOBES | coats);
    assert_eq!(scene.lights.len(), 4);
}

#[test]
fn sheen_lies_on_every_cloth_and_beside_each_is_the_same_without() {
    let scene = load("sheen.glb");
    let cloths = [
        ("satin", [0.8, 0.5, 0.5], 0.3),
        ("velvet", [0.5, 0.6, 1.0], 0.6),
        ("striped", [1.0, 1.0, 1.0], 0.5),
        ("brushed", [0.9, 0.9, 0.6], 1.0),
    ];
    for (name, color, roughness) in cloths {
        let material = |name: &str| scene.materials.iter().find(|m| m.name == name).unwrap();
        let (without, with) = (material(name), material(&format!("{name}, sheen")));
        assert_eq!(without.material.sheen_color, glam::Vec3::ZERO, "{name}");
        assert_eq!(with.material.sheen_color.to_array(), color, "{name}");
        assert_eq!(with.material.sheen_roughness, roughness, "{name}");
        let textures = (with.sheen_color_texture.is_some(), with.sheen_roughness_texture.is_some());
        assert_eq!(textures, (name == "striped", name == "brushed"));
    }
    assert_eq!(scene.effects(), LOBES | Effects::SHEEN);
}

#[test]
fn there_is_a_ball_of_every_material() {
    let scene = load("materials.glb");
    let balls = scene.materials.iter().filter(|material| material.emission == glam::Vec3::ZERO);
    assert_eq!(balls.filter(|material| material.name != "floor").count(), 16);
    let spun = scene.materials.iter().find(|material| material.name == "spun").unwrap();
    assert!(spun.anisotropy_texture.is_some());
    assert!(scene.materials.iter().filter(|material| material.material.film.is_some()).count() == 4);
    let layers = Effects::COAT | Effects::SHEEN | Effects::ANISOTROPY | Effects::THIN_FILM;
    assert_eq!(scene.effects(), LOBES | layers);
}

/// Whether an outline turns both ways.
fn is_concave(light: &arealight::Light) -> bool {
    let normal = light.shape.area_vector();
    let corners = light.shape.vertices().iter().zip(light.shape.vertices().iter().cycle().skip(1));
    let corners = corners.zip(light.shape.vertices().iter().cycle().skip(2));
    corners.into_iter().any(|((a, b), c)| (*b - *a).cross(*c - *b).dot(normal) < 0.0)
}

#[test]
fn the_room_has_outlines_of_many_kinds() {
    const PLATFORM: f64 = 0.5;
    let scene = load("room.glb");
    let named = |name: &str| scene.lights.iter().find(|light| light.name == name).unwrap();
    let counts: Vec<usize> = scene.lights.iter().map(|light| light.shape.vertices().len()).collect();
    assert_eq!(counts, [8, 10, 7, 3, 4, 5]);
    assert!(is_concave(named("star")) && is_concave(named("arrow")) && !is_concave(named("octagon")));
    let two_sided = scene.lights.iter().filter(|light| light.two_sided);
    assert_eq!(two_sided.map(|light| light.name.as_str()).collect::<Vec<_>>(), ["two-sided panel"]);
    // The platform's top cuts the sunken panel, and is there
    let sunken = named("sunken panel");
    assert!(sunken.shape.vertices().iter().any(|v| v.y < PLATFORM - 0.2));
    assert!(sunken.shape.vertices().iter().any(|v| v.y > PLATFORM + 0.2));
    let top = DVec3::new(1.35, PLATFORM + 0.1, -0.7);
    let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
    let hit = buffers.closest_hit(top, DVec3::NEG_Y).unwrap();
    assert!((hit.distance - 0.1).abs() < 1e-4, "{}", hit.distance);
}

#[test]
fn the_demo_shows_what_there_is() {
    let scene = load("demo.glb");
    let lights = Effects::TWO_SIDED | Effects::POLYGON;
    assert_eq!(scene.effects(), LOBES | lights | Effects::SPECULAR_INPUT);
    let letters: Vec<_> = scene.lights.iter().filter(|light| light.name.starts_with("letter")).collect();
    assert_eq!(letters.len(), 3);
    assert!(letters.iter().all(|letter| is_concave(letter)));
    assert!(scene.lights.iter().any(|light| light.name == "key"), "an EXT_lights_area rectangle");
    let metal = |metalness: f32| scene.materials.iter().any(|m| m.material.metalness == metalness);
    assert!(metal(0.0) && metal(1.0));
    // The floor's roughness varies by much
    let floor = scene.materials.iter().find(|m| m.metallic_roughness_texture.is_some()).unwrap();
    let texture = scene.textures[floor.metallic_roughness_texture.unwrap() as usize];
    let texels = &scene.images[texture.image as usize].texels;
    let green = || texels.iter().map(|texel| texel.to_le_bytes()[1]);
    assert!(green().min().unwrap() < 30 && green().max().unwrap() > 180);
    assert_eq!(scene.camera(Some("hero"), 1.0).unwrap().aspect.map(|a| (a * 9.0).round()), Some(16.0));
}

#[test]
fn the_screen_shows_a_test_card_to_a_floor_of_all_roughnesses() {
    let scene = load("screen.glb");
    assert_eq!(scene.effects(), LOBES | Effects::TWO_SIDED | Effects::POLYGON | Effects::TEXTURED);
    let layer = |name: &str| {
        let light = scene.lights.iter().find(|light| light.name == name).unwrap();
        light.texture.as_ref().map(|texture| texture.layer)
    };
    assert_eq!([layer("television"), layer("sign"), layer("lamp")], [Some(0), Some(1), None]);
    assert_eq!(scene.light_texture_size(1024).unwrap().side(0), 512);
    // The camera sees the card's red corner on the upper left, the green one on its right
    let card = scene.light_texture_source(0).unwrap();
    assert_eq!([card.width, card.height], [512, 288]);
    let camera = scene.camera(None, 16.0 / 9.0).unwrap();
    let screen = &scene.lights.iter().find(|light| light.name == "television").unwrap();
    let right = camera.forward.cross(DVec3::Y);
    for (vertex, uv) in screen.shape.vertices().iter().zip(&screen.texture.as_ref().unwrap().uvs) {
        let offset = *vertex - screen.shape.center();
        assert_eq!((offset.dot(right) > 0.0, offset.y < 0.0), (uv.x > 0.5, uv.y > 0.5));
    }
    assert_eq!(card.texels[2].to_le_bytes()[..3], [225, 30, 25]);
    // The floor's roughness
    let texture = scene.materials.iter().find_map(|m| m.metallic_roughness_texture).unwrap();
    let texels = &scene.images[scene.textures[texture as usize].image as usize].texels;
    let ends = [texels[0], texels[texels.len() - 1]].map(|texel| f64::from(texel.to_le_bytes()[1]) / 255.0);
    // The middle of the last of 64 texels is at 0.984 of a range of 0.82, when squared
    assert!(ends.iter().zip([0.03, 0.85]).all(|(a, b)| (a - b).abs() < 0.016), "{ends:?}");
    // Both sides of the sign show it
    assert!(scene.lights.iter().any(|light| light.two_sided && light.texture.is_some()));
}

#[test]
fn the_clock_is_a_disk_that_shows_its_face_upright() {
    let scene = load("clock.glb");
    assert_eq!(
        scene.effects(),
        LOBES | Effects::TWO_SIDED | Effects::ELLIPSE | Effects::TEXTURED_ELLIPSE,
        "no polygon shows anything"
    );
    let disks: Vec<_> = scene.lights.iter().filter(|light| !light.shape.is_polygonal()).collect();
    let [clock] = disks[..] else { panic!("{} disks", disks.len()) };
    assert_eq!((clock.texture.as_ref().unwrap().layer, clock.two_sided), (0, true));
    let arealight::LightShape::Disk { axis_u, axis_v, .. } = clock.shape else { panic!("{clock:?}") };
    // From the camera, its rows run to the right and its top is up
    let camera = scene.camera(None, 16.0 / 9.0).unwrap();
    let right = camera.forward.cross(DVec3::Y).normalize_or_zero();
    assert!(axis_u.dot(right) > 0.81 && axis_v.y > 0.81, "{clock:?}");
    let source = scene.light_texture_source(0).unwrap();
    assert_eq!([source.width, source.height], [256; 2]);
    assert!(
        (source.part.low.abs().max_element() < 1e-4) && (source.part.size - 1.0).abs().max_element() < 1e-4
    );
}

#[test]
fn the_shadows_are_of_one_rectangle_on_two_floors() {
    let (matt, glossy) = (load("shadows.glb"), load("shadows-glossy.glb"));
    for scene in [&matt, &glossy] {
        let [light] = &scene.lights[..] else { panic!("{} lights", scene.lights.len()) };
        // Files hold 16 bits of fraction
        let size = light.shape.bounds()[1] - light.shape.bounds()[0];
        assert!((size - DVec3::new(1.6, 0.0, 0.9)).length() < 1e-4, "{size}");
        assert_eq!(scene.lamps[0].triangles.len(), 2);
        assert!(light.shape.area_vector().y < 0.0, "it faces the floor");
    }
    assert_eq!(matt.triangles.len(), glossy.triangles.len());
    // Lambert alone, and GGX alone
    let floor = |scene: &Scene| scene.materials[scene.triangles[0].material as usize].material;
    let (matt, glossy) = (floor(&matt), floor(&glossy));
    assert_eq!((matt.metalness, matt.dielectric_f0, matt.dielectric_f90), (0.0, glam::Vec3::ZERO, 0.0));
    assert_eq!((glossy.metalness, glossy.roughness), (1.0, 0.3));
}

#[test]
fn the_hundred_lamps_are_quads_above_boxes() {
    for (name, roughness, metalness) in
        [("hundred-lamps.glb", 0.5, 0.0), ("hundred-lamps-metal.glb", 0.3, 1.0)]
    {
        let scene = load(name);
        let floor = &scene.materials[scene.triangles[0].material as usize].material;
        assert_eq!((floor.roughness, floor.metalness), (roughness, metalness));
        check_hundred_lamps(&scene);
    }
}

fn check_hundred_lamps(scene: &Scene) {
    assert_eq!(scene.lights.len(), 100);
    assert!(scene.lights.iter().all(|light| light.shape.is_convex_quad() && !light.two_sided));
    let (boxes, floor) = (12 * 18, 2);
    let plain = (0..scene.triangles.len()).filter(|index| !scene.is_lamp(*index)).collect::<Vec<_>>();
    assert_eq!(plain.len(), boxes + floor);
    // No lamp is in a box: all hang above them
    let heights = plain.iter().flat_map(|index| scene.triangles[*index].positions.map(|p| p.y));
    let lowest = scene.lights.iter().map(|light| light.shape.bounds()[0].y).fold(f64::MAX, f64::min);
    assert!(lowest > heights.fold(0.0, f64::max), "{lowest}");
}

#[test]
fn the_lamps_are_of_every_shape() {
    use arealight::TubeEnds;
    let scene = load("shapes.glb");
    let kinds = |kind| scene.lights.iter().filter(|light| light.effects().contains(kind)).count();
    assert_eq!([Effects::ELLIPSE, Effects::SPHERE, Effects::TUBE].map(kinds), [3, 2, 3]);
    assert!(scene.lights.iter().all(|light| !light.shape.is_polygonal()), "no lamp is shaded as its mesh");
    let ends = |light: &arealight::Light| match light.shape {
        arealight::LightShape::Tube { ends, .. } => Some(ends),
        _ => None,
    };
    let ends: Vec<TubeEnds> = scene.lights.iter().filter_map(ends).collect();
    assert_eq!(ends, [TubeEnds::Flat, TubeEnds::Round, TubeEnds::Open]);
    assert!(scene.effects().contains(Effects::SHAPES));
    // One of them is cut by the floor
    assert!(scene.lights.iter().any(|light| light.shape.bounds()[0].y < -0.2));
    for roughness in [0.08, 0.2, 0.35, 0.6] {
        assert!(
            scene.materials.iter().any(|m| f64::from(m.material.roughness) == f64::from(roughness as f32))
        );
    }
}

#[test]
fn the_studio_has_its_softboxes() {
    let scene = load("studio.glb");
    let names: Vec<_> = scene.lights.iter().map(|light| light.name.as_str()).collect();
    assert_eq!(names, ["key", "fill", "rim"]);
    assert_eq!(scene.effects(), LOBES);
    // They face what is shown
    for light in &scene.lights {
        let to_middle = DVec3::new(0.0, 0.8, 0.0) - light.shape.center();
        assert!(to_middle.dot(light.shape.area_vector()) > 0.0, "{}", light.name);
    }
}

#[test]
fn the_interior_and_the_gallery_have_lamps_of_three_shapes() {
    let scene = load("interior.glb");
    assert_eq!(scene.effects(), LOBES | Effects::SHEEN | Effects::SPHERE | Effects::TUBE);
    assert_eq!(scene.lights.iter().filter(|light| light.shape.is_polygonal()).count(), 3);
    assert_eq!(scene.lights.len(), 5);
    assert_eq!(load("gallery.glb").effects(), LOBES | Effects::TEXTURED | Effects::SPHERE | Effects::TUBE);
}

#[test]
fn the_neon_is_of_tubes_alone() {
    let scene = load("neon.glb");
    assert_eq!(scene.lights.len(), 15 + 3);
    let is_tube = |light: &arealight::Light| matches!(light.shape, arealight::LightShape::Tube { .. });
    assert!(scene.lights.iter().all(is_tube));
    assert_eq!(scene.effects(), LOBES | Effects::TUBE);
}

#[test]
fn the_shop_has_sixty_panels() {
    let scene = load("shop.glb");
    assert_eq!(scene.lights.len(), 60);
    assert!(scene.lights.iter().all(|light| light.shape.is_convex_quad() && !light.two_sided));
    assert_eq!(scene.effects(), LOBES);
}

#[test]
fn the_product_is_coated_and_brushed_under_a_softbox_that_fades() {
    let scene = load("product.glb");
    assert_eq!(scene.effects(), LOBES | Effects::COAT | Effects::ANISOTROPY | Effects::TEXTURED);
    let textured = scene.lights.iter().filter(|light| light.texture.is_some());
    assert_eq!(textured.map(|light| light.name.as_str()).collect::<Vec<_>>(), ["softbox"]);
}

#[test]
fn each_light_is_one_lamp_s_and_a_lamp_is_what_it_looks_like() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    for name in ["room", "shapes", "neon", "shop", "studio", "screen", "gallery"] {
        let scene = Scene::load(folder.join(format!("{name}.glb"))).unwrap();
        let mut lights: Vec<usize> = scene.lamps.iter().flat_map(|lamp| lamp.lights.clone()).collect();
        lights.sort_unstable();
        assert_eq!(lights, (0..scene.lights.len()).collect::<Vec<_>>(), "{name}");
        let of_lamps: usize = scene.lamps.iter().map(|lamp| lamp.triangles.len()).sum();
        let lamps = (0..scene.triangles.len()).filter(|index| scene.is_lamp(*index));
        assert_eq!(of_lamps, lamps.count(), "{name}: none is two lamps'");
        for lamp in scene.lamps.iter().filter(|lamp| !lamp.triangles.is_empty()) {
            // What looks like a light is where it is, and about as large: a tube in place of a capsule lacks
            // the ends
            let corners = scene.triangles[lamp.triangles.clone()].iter().flat_map(|t| t.positions);
            let seen: arealight_scene::Bounds = corners.collect();
            let shines: arealight_scene::Bounds =
                lamp.lights.clone().flat_map(|light| scene.lights[light].shape.bounds()).collect();
            let off = (seen.min - shines.min).abs().max((seen.max - shines.max).abs()).max_element();
            assert!(off < 0.1 * seen.diagonal(), "{name}: {seen:?}, {shines:?}");
        }
    }
}
