//! What the plugin draws, held against the float64 oracle.

mod headless;

use arealight::glam::{DAffine3, DVec3, Vec3 as Color3};
use arealight::{Light, LightTable, Quality};
use arealight_oracle::material::{Material, Surface};
use arealight_oracle::shading::{RelativeLight, ltc, shape_ltc_on, shape_seen_from};
use bevy::asset::RenderAssetUsages;
use bevy::camera::{ScalingMode, Viewport};
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_arealight::{AreaLight, AreaLightPlugin, LightShape, Opening, Profile, TubeEnds};
use headless::{add_picture, app, picture};

const SIZE: [u32; 2] = [96, 64];
const CAMERA: Vec3 = Vec3::new(0.5, 3.0, 6.0);

/// Relative to a point's brightest channel: the picture, base colours and reflectances are half floats, each
/// within 5e-4, and the rest is float32's.
const TOLERANCE: f64 = 2e-3;

/// Of a floor as Bevy's G-buffer holds it, with 12 bits an axis of the octahedron. Held against the normal
/// that is up a floor that is half metal has an error of 2.2e-3.
const NORMAL: DVec3 = DVec3::new(0.0, 4094.0, -1.0);

/// A floor of numbers that Bevy's G-buffer holds exactly, in steps of 1/255.
fn material(metallic: u8, coat: f32) -> (StandardMaterial, Surface) {
    let part = |step: u8| f32::from(step) / 255.0;
    let color = [200, 150, 100].map(|step| part(step).powf(2.2));
    let (roughness, reflectance, coat_roughness) = (part(102), part(140), 6.0 / 30.0);
    let bevys = StandardMaterial {
        base_color: Color::linear_rgb(color[0], color[1], color[2]),
        metallic: part(metallic),
        perceptual_roughness: roughness,
        reflectance,
        clearcoat: coat,
        clearcoat_perceptual_roughness: coat_roughness,
        ..default()
    };
    let ours = Material {
        base_color: Color3::from_array(color),
        metalness: part(metallic),
        roughness,
        dielectric_f0: Color3::splat(0.16 * reflectance * reflectance),
        coat,
        coat_roughness,
        ..Material::default()
    };
    (bevys, ours.surface())
}

/// A light of each kind above the floor, without symmetry.
fn lights() -> Vec<(&'static str, AreaLight, Transform)> {
    let xy = |points: &[[f64; 2]]| points.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect::<Vec<_>>();
    let arrow = xy(&[[0.0, 0.8], [0.8, -0.6], [0.0, -0.2], [-0.8, -0.6]]);
    let arrow = LightShape::Polygon(arrow);
    let roof = [[-0.5, 0.0, 0.0], [-0.5, 1.0, 0.2], [0.5, 1.0, 0.2], [0.5, 0.0, 0.0]];
    let wall = [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0], [0.5, -0.6, 0.5], [-0.5, -0.6, 0.5]];
    let vertices = roof.iter().chain(&wall).copied().map(DVec3::from_array).collect();
    let mesh = LightShape::mesh(vertices, vec![4, 4]);
    let (p0, p1) = (DVec3::new(-0.8, 0.0, 0.0), DVec3::new(0.6, 0.2, 0.1));
    let tube = |ends| LightShape::Tube { p0, p1, radius: 0.1, ends };
    let spot = Profile::new(&[[0.0, 1.0], [30.0, 1.0], [70.0, 0.0]], 4).unwrap();
    let lamp = AreaLight::rectangle(0.5, 0.3);
    let doors = Opening::doors(&lamp.shape, 0.3, 0.4).unwrap();
    let down = Transform::from_xyz(0.3, 1.5, -0.5).looking_at(Vec3::new(0.0, 0.0, 0.4), Vec3::Z);
    let warm = |light: AreaLight| AreaLight { radiance: LinearRgba::rgb(8.0, 7.0, 5.0), ..light };
    [
        ("rectangle", AreaLight::rectangle(1.6, 0.7), down.with_scale(Vec3::splat(1.25))),
        ("polygon", AreaLight::new(arrow), down),
        ("mesh", AreaLight { two_sided: true, ..AreaLight::new(mesh) }, down),
        ("disk", AreaLight::disk(0.6), down.with_scale(Vec3::splat(0.8))),
        ("sphere", AreaLight::sphere(0.4), down.with_scale(Vec3::splat(1.5))),
        ("tube", AreaLight::new(tube(TubeEnds::Flat)), down),
        ("capsule", AreaLight::new(tube(TubeEnds::Round)), down),
        ("spot", AreaLight { profile: Some(spot), ..AreaLight::rectangle(0.4, 0.3) }, down),
        ("lamp with doors", AreaLight { opening: Some(doors), ..lamp }, down.with_scale(Vec3::splat(1.5))),
    ]
    .map(|(name, light, transform)| (name, warm(light), transform))
    .to_vec()
}

/// A light in the world in parts that the oracle knows, under a uniform scale.
fn in_world(light: &AreaLight, transform: &Transform) -> Vec<Light> {
    let world = DAffine3::from_cols_array(&transform.compute_affine().to_cols_array().map(f64::from));
    let shapes = match light.shape.moved(&world) {
        LightShape::Mesh { vertices, .. } => {
            vertices.chunks_exact(4).map(|face| LightShape::Polygon(face.to_vec())).collect()
        }
        shape => vec![shape],
    };
    let LinearRgba { red, green, blue, .. } = light.radiance;
    let radiance = Color3::new(red, green, blue);
    let of = |shape| Light {
        shape,
        radiance,
        two_sided: light.two_sided,
        profile: light.profile.clone(),
        opening: light.opening.map(|opening| opening.moved(&world)),
        ..Light::default()
    };
    shapes.into_iter().map(of).collect()
}

/// What a camera draws: where it is, in what part of the picture, from and to, how high it sees if its
/// projection is orthographic, and how many pixels it is jittered by on both axes.
struct Seen {
    camera: Transform,
    part: [[u32; 2]; 2],
    height: Option<f64>,
    jitter: f64,
}

impl Seen {
    fn whole() -> Self {
        Self { camera: camera(), part: [[0; 2], SIZE], height: None, jitter: 0.0 }
    }

    /// Where the ray through the middle of a pixel of that part meets the floor, and the direction to the
    /// viewer there.
    fn floor_at(&self, pixel: [u32; 2]) -> [DVec3; 2] {
        let [from, to] = self.part;
        let size = [0, 1].map(|axis| f64::from(to[axis] - from[axis]));
        let [x, y] = [0, 1]
            .map(|axis| (f64::from(pixel[axis] - from[axis]) + 0.5 + self.jitter) / size[axis] * 2.0 - 1.0);
        let [right, up, back] = [self.camera.right(), self.camera.up(), self.camera.back()]
            .map(|axis| DVec3::from_array(axis.to_array().map(f64::from)));
        let eye = DVec3::from_array(self.camera.translation.to_array().map(f64::from));
        let half = self.height.unwrap_or((std::f64::consts::FRAC_PI_4 / 2.0).tan() * 2.0) / 2.0;
        let aside = right * (x * half * size[0] / size[1]) - up * (y * half);
        let (eye, to_viewer) = if self.height.is_some() { (eye + aside, back) } else { (eye, back - aside) };
        [eye - to_viewer * (eye.y / to_viewer.y), to_viewer]
    }
}

fn camera() -> Transform {
    Transform::from_translation(CAMERA).looking_at(Vec3::ZERO, Vec3::Y)
}

/// The oracle's radiance of the floor at a place, and to a viewer.
fn expected(table: &LightTable, surface: &Surface, lights: &[Light], [place, view]: [DVec3; 2]) -> DVec3 {
    let of = |light: &Light| {
        let seen = shape_seen_from(light, place);
        shape_ltc_on(Quality::default(), table, surface, NORMAL, view, &seen)
            .unwrap_or_else(|| ltc(table, surface, NORMAL, view, &RelativeLight::new(light, place)))
    };
    lights.iter().map(of).sum()
}

/// The largest error at twenty pixels, relative to what the oracle has there, where that is not dark.
fn worst(pixels: &[[f32; 4]], seen: &Seen, table: &LightTable, surface: &Surface, lights: &[Light]) -> f64 {
    let [from, to] = seen.part;
    let step = |axis: usize, count: u32| (to[axis] - from[axis]) / count;
    let places = (0..20).map(|index| {
        [from[0] + step(0, 12) + index % 5 * step(0, 6), from[1] + step(1, 3) + index / 5 * step(1, 6)]
    });
    let pairs: Vec<[DVec3; 2]> = places
        .map(|[x, y]| {
            let [red, green, blue, _] = pixels[(y * SIZE[0] + x) as usize].map(f64::from);
            [DVec3::new(red, green, blue), expected(table, surface, lights, seen.floor_at([x, y]))]
        })
        .collect();
    let brightest = pairs.iter().map(|[_, oracle]| oracle.max_element()).fold(0.0, f64::max);
    assert!(brightest > 0.01, "the floor is lit");
    pairs
        .iter()
        .filter(|[_, oracle]| oracle.max_element() > 1e-3 * brightest)
        .map(|[ours, oracle]| (*ours - *oracle).abs().max_element() / oracle.max_element())
        .fold(0.0, f64::max)
}

/// Bevy with the plugin, and a floor of a material.
fn world(material: StandardMaterial) -> (App, Entity) {
    let mut app = app();
    app.add_plugins(AreaLightPlugin::default());
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(40.0, 40.0));
    let floor = app.world_mut().spawn(Mesh3d(mesh)).id();
    cover(&mut app, floor, material);
    (app, floor)
}

fn cover(app: &mut App, floor: Entity, material: StandardMaterial) {
    let material = app.world_mut().resource_mut::<Assets<StandardMaterial>>().add(material);
    app.world_mut().entity_mut(floor).insert(MeshMaterial3d(material));
}

#[test]
fn every_kind_of_light_is_that_of_the_oracle() {
    let table = LightTable::ggx();
    let (mut app, floor) = world(StandardMaterial::default());
    let image = add_picture(&mut app, SIZE);
    app.world_mut().spawn(headless::camera(&image, camera()));
    let lights = lights();
    let entities: Vec<Entity> = lights
        .iter()
        .map(|(_, light, transform)| app.world_mut().spawn((light.clone(), *transform)).id())
        .collect();
    for (surface, metallic, coat) in [("dielectric", 0, 0.0), ("half metal", 128, 0.0), ("coated", 0, 0.8)] {
        let (bevys, ours) = material(metallic, coat);
        cover(&mut app, floor, bevys);
        for (index, (kind, light, transform)) in lights.iter().enumerate() {
            for (other, entity) in entities.iter().enumerate() {
                let visibility = if other == index { Visibility::Visible } else { Visibility::Hidden };
                app.world_mut().entity_mut(*entity).insert(visibility);
            }
            let pixels = picture(&mut app);
            let error = worst(&pixels, &Seen::whole(), &table, &ours, &in_world(light, transform));
            println!("{kind} on {surface}: {error:.1e}");
            assert!(error < TOLERANCE, "{kind} on {surface}: {error:.1e}");

            // The twin: the light a centimetre and a half higher
            let higher = Transform { translation: transform.translation + Vec3::Y * 0.015, ..*transform };
            let error = worst(&pixels, &Seen::whole(), &table, &ours, &in_world(light, &higher));
            assert!(error > 2.0 * TOLERANCE, "{kind} on {surface}, moved: {error:.1e}");
        }
    }
}

#[test]
fn cameras_side_by_side_jittered_and_orthographic_ones_see_the_same() {
    let (table, (bevys, surface)) = (LightTable::ggx(), material(0, 0.0));
    let (mut app, _) = world(bevys);
    let (_, light, transform) = lights().swap_remove(0);
    app.world_mut().spawn((light.clone(), transform));
    let image = add_picture(&mut app, SIZE);
    let middle = SIZE[0] / 2;
    let part = |from: u32, to: u32| [[from, 0], [to, SIZE[1]]];
    let viewport = |[from, to]: [[u32; 2]; 2]| Camera {
        viewport: Some(Viewport {
            physical_position: from.into(),
            physical_size: UVec2::from(to) - UVec2::from(from),
            ..default()
        }),
        order: isize::from(from[0] > 0),
        clear_color: if from[0] > 0 { ClearColorConfig::None } else { ClearColorConfig::Default },
        ..default()
    };
    let jitter = TemporalJitter { offset: Vec2::splat(0.5) };
    let (left, right) = (part(0, middle), part(middle, SIZE[0]));
    app.world_mut().spawn(headless::camera(&image, camera())).insert((viewport(left), jitter));
    let scaling_mode = ScalingMode::FixedVertical { viewport_height: 4.0 };
    let projection = OrthographicProjection { scaling_mode, ..OrthographicProjection::default_3d() };
    app.world_mut()
        .spawn(headless::camera(&image, camera()))
        .insert((viewport(right), Projection::Orthographic(projection)));
    let pixels = picture(&mut app);
    for (part, height, jitter) in [(left, None, 0.5), (right, Some(4.0), 0.0)] {
        let seen = Seen { camera: camera(), part, height, jitter };
        let error = worst(&pixels, &seen, &table, &surface, &in_world(&light, &transform));
        println!("orthographic of height {height:?}: {error:.1e}");
        assert!(error < TOLERANCE, "orthographic of height {height:?}: {error:.1e}");
    }
}

/// An image of bytes, linear.
fn image(width: u32, height: u32, bytes: Vec<u8>) -> Image {
    let size = Extent3d { width, height, depth_or_array_layers: 1 };
    Image::new(size, TextureDimension::D2, bytes, TextureFormat::Rgba8Unorm, RenderAssetUsages::default())
}

#[test]
fn images_stand_upright_seen_from_the_front_and_may_be_changed() {
    let (table, (bevys, surface)) = (LightTable::ggx(), material(0, 0.0));
    let (mut app, _) = world(bevys);
    let target = add_picture(&mut app, SIZE);
    app.world_mut().spawn(headless::camera(&target, camera()));
    // Red and green above, blue and black below. Seen from the floor the left is where x grows
    let parts = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [0, 0, 0, 255]];
    let places = [[0.6, -0.6], [-0.6, -0.6], [0.6, 0.6], [-0.6, 0.6]].map(|[x, z]| DVec3::new(x, 0.0, z));
    let shown = app.world_mut().resource_mut::<Assets<Image>>().add(image(2, 2, parts.concat()));
    let down = Transform::from_xyz(0.0, 0.4, 0.0).looking_at(Vec3::ZERO, Vec3::NEG_Z);
    let seen = Seen::whole();
    let pixel_at = |place: DVec3| {
        let pixels = (0..SIZE[0] * SIZE[1]).map(|index| [index % SIZE[0], index / SIZE[0]]);
        let off = |pixel: &[u32; 2]| seen.floor_at(*pixel)[0].distance(place);
        // Below the horizon
        pixels.filter(|[_, y]| *y > 20).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap()
    };
    for plain in [AreaLight::rectangle(2.0, 2.0), AreaLight::disk(1.2)] {
        let light =
            app.world_mut().spawn((AreaLight { image: Some(shown.clone()), ..plain.clone() }, down)).id();
        let pixels = picture(&mut app);
        let [red, green, blue, black] = places.map(|place| {
            let [x, y] = pixel_at(place);
            let [red, green, blue, _] = pixels[(y * SIZE[0] + x) as usize].map(f64::from);
            (DVec3::new(red, green, blue) / surface.diffuse_albedo).to_array()
        });
        for (channel, color) in [red, green, blue].into_iter().enumerate() {
            let others = color[(channel + 1) % 3].max(color[(channel + 2) % 3]);
            assert!(color[channel] > 2.0 * others, "{channel}: {color:?}");
            assert!(color[channel] > 2.0 * black[channel], "{channel}: {color:?}, {black:?}");
        }
        app.world_mut().despawn(light);
    }

    // Changed to one colour, it is a light of that
    *app.world_mut().resource_mut::<Assets<Image>>().get_mut(&shown).unwrap() =
        image(300, 2, [51, 102, 204, 255].repeat(600));
    for (plain, scale) in
        [(AreaLight::rectangle(2.0, 1.0), [-1.0, 1.0, 1.0]), (AreaLight::disk(0.7), [1.0; 3])]
    {
        let one = AreaLight { radiance: LinearRgba::rgb(200.0, 400.0, 800.0), ..plain.clone() };
        let mirrored = down.with_scale(Vec3::from_array(scale));
        let light = app.world_mut().spawn((AreaLight { image: Some(shown.clone()), ..plain }, mirrored)).id();
        let error = worst(&picture(&mut app), &seen, &table, &surface, &in_world(&one, &down));
        println!("one colour: {error:.1e}");
        assert!(error < TOLERANCE, "one colour: {error:.1e}");
        app.world_mut().despawn(light);
    }
}
