//! What a file of cases may say, and what is said about one that is wrong.

use super::*;
use arealight::{LightShape, TubeEnds};
use arealight_oracle::material::{Coat, Interface, Surface};
use glam::{DVec2, Vec3};

/// There is no image beside these cases.
fn no_image(path: &str) -> Result<Arc<Texture>, String> {
    Err(format!("asked for {path}"))
}

/// A case of `material` under `light`, both the inside of JSON objects.
fn case(material: &str, light: &str) -> String {
    format!(
        r#"{{"name": "a case", "position": [1, 2, 3], "normal": [0, 0, 2], "view": [1, 0, 1], {material},
             "light": {{"radiance": [1, 2, 3], {light}}}}}"#
    )
}

fn read_one(text: &str) -> Result<Case, CaseError> {
    read_cases(&format!(r#"{{"cases": [{text}]}}"#)).map(|mut cases| cases.remove(0))
}

fn message(material: &str, light: &str) -> String {
    read_one(&case(material, light)).unwrap_err().to_string()
}

fn reason(material: &str, light: &str) -> String {
    read_one(&case(material, light)).unwrap().supported(no_image).unwrap_err()
}

const GGX: &str = r#""alpha": 0.25, "F0": [0.1, 0.2, 0.3], "albedo": [0.5, 0.6, 0.7]"#;
const QUAD: &str = r#""type": "polygon", "vertices": [[1, 2, 4], [2, 2, 4], [2, 3, 4], [1, 3, 4]]"#;

#[test]
fn a_case_becomes_lobes_and_a_light_relative_to_its_point() {
    let supported = read_one(&case(GGX, QUAD)).unwrap().supported(no_image).unwrap();
    assert_eq!(supported.name, "a case");
    assert_eq!((supported.normal, supported.view), (DVec3::new(0.0, 0.0, 2.0), DVec3::new(1.0, 0.0, 1.0)));
    let surface = Surface {
        diffuse_albedo: DVec3::new(0.5, 0.6, 0.7),
        f0: DVec3::new(0.1, 0.2, 0.3),
        f90: 1.0,
        alpha: 0.25,
        ..Surface::default()
    };
    assert_eq!(supported.surface, surface);
    assert_eq!(supported.light.shape.vertices()[2], DVec3::new(1.0, 1.0, 1.0));
    assert!(!supported.light.two_sided);
    assert_eq!(supported.light.radiance, Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn without_f0_there_is_no_fresnel_term_and_diffuse_has_no_glossy_lobe() {
    let surface = read_one(&case(r#""alpha": 0.5"#, QUAD)).unwrap().supported(no_image).unwrap().surface;
    assert_eq!((surface.f0, surface.f90, surface.diffuse_albedo), (DVec3::ONE, 1.0, DVec3::ZERO));
    let diffuse = r#""bsdf": "diffuse", "albedo": [0.5, 0.25, 1]"#;
    let surface = read_one(&case(diffuse, QUAD)).unwrap().supported(no_image).unwrap().surface;
    assert_eq!((surface.f0, surface.f90), (DVec3::ZERO, 0.0));
    assert_eq!(surface.diffuse_albedo, DVec3::new(0.5, 0.25, 1.0));
}

#[test]
fn every_light_and_lobe_is_read_and_what_is_not_there_yet_has_a_reason() {
    let disk =
        r#""type": "disk", "center": [0, 0, 5], "axis_u": [1, 0, 0], "axis_v": [0, 2, 0], "two_sided": true"#;
    let Light { two_sided: true, shape: LightShape::Disk { axis_v, .. }, .. } =
        read_one(&case(GGX, disk)).unwrap().light
    else {
        panic!("a two-sided disk")
    };
    assert_eq!(axis_v, DVec3::new(0.0, 2.0, 0.0));
    let before = r#", "occluders": [[[0, 0, 4], [1, 0, 4], [0, 1, 4]]]"#;
    assert_eq!(reason(&format!("{GGX}{before}"), disk), "occluders: before a light that is no polygon");
    let textured = format!(r#"{QUAD}, "texture": "light.exr", "uv": [[0, 0], [1, 0], [1, 1], [0, 1]]"#);
    assert_eq!(reason(GGX, &textured), "light.texture: light.exr: asked for light.exr");
    let no_tangent = "alpha_x and alpha_y differ, and there is no tangent";
    assert_eq!(reason(r#""alpha_x": 0.5, "alpha_y": 0.1"#, QUAD), no_tangent);
    assert!(read_one(&case(r#""alpha_x": 0.5, "alpha_y": 0.5"#, QUAD)).unwrap().supported(no_image).is_ok());
    assert_eq!(
        reason(r#""alpha": 1e-9"#, QUAD),
        "alpha 0.000000001 is below 0.0001, the smallest that is shaded"
    );
}

#[test]
fn other_lights_become_shapes_relative_to_the_point() {
    let white = Arc::new(Texture::from_fn(1, 1, |_, _| DVec3::ONE));
    let load = |path: &str| if path == "white.exr" { Ok(white.clone()) } else { Err("no such file".into()) };
    let shape = |light: &str| read_one(&case(GGX, light)).unwrap().supported(load);
    let shape_reason = |light: &str| shape(light).unwrap_err();
    let disk =
        shape(r#""type": "disk", "center": [0, 0, 5], "axis_u": [1, 0, 0], "axis_v": [0, 2, 0]"#).unwrap();
    let (center, axis_u, axis_v) = (DVec3::new(-1.0, -2.0, 2.0), DVec3::X, DVec3::Y * 2.0);
    assert_eq!(disk.light.shape, LightShape::Disk { center, axis_u, axis_v });
    assert_eq!((disk.surface.alpha, disk.light.two_sided), (0.25, false));
    let window = r#""opening": {"center": [1, 2, 4], "axis_u": [1, 0, 0], "axis_v": [0, 1, 0]}"#;
    let axes = r#""center": [0, 0, 5], "axis_u": [1, 0, 0], "axis_v": [0, 2, 0]"#;
    let seen = shape(&format!(r#""type": "disk", {axes}, {window}"#)).unwrap();
    assert_eq!(seen.light.opening.map(|opening| opening.center), Some(DVec3::Z));
    let sphere = shape(r#""type": "sphere", "center": [0, 0, 5], "radius": 0.5"#).unwrap();
    assert_eq!(sphere.light.shape, LightShape::Sphere { center, radius: 0.5 });
    // What its ends are
    let cylinder = |more: &str, radius: f64| {
        format!(r#""type": "cylinder", "p0": [1, 2, 2], "p1": [1, 2, 5], "radius": {radius} {more}"#)
    };
    let ends = |more: &str| match shape(&cylinder(more, 0.5)).map(|case| case.light.shape) {
        Ok(LightShape::Tube { ends, .. }) => ends,
        other => panic!("{other:?}"),
    };
    assert_eq!((ends(""), ends(r#", "caps": true"#)), (TubeEnds::Open, TubeEnds::Flat));
    // It emits outwards
    assert_eq!(ends(r#", "two_sided": true"#), TubeEnds::Open);
    // A disk may be textured
    let showing = |file: &str| {
        let axes = r#""center": [0, 0, 5], "axis_u": [1, 0, 0], "axis_v": [0, 2, 0]"#;
        format!(r#""type": "disk", {axes}, "texture": "{file}""#)
    };
    let shown = shape(&showing("white.exr")).unwrap();
    let layer = shown.light.texture.map(|texture| texture.layer);
    assert_eq!((layer, shown.image), (Some(0), Some(white.clone())));
    assert_eq!((disk.light.texture, disk.image), (None, None));
    assert_eq!(shape_reason(&showing("red.exr")), "light.texture: red.exr: no such file");
    // What is wrong
    let flat = r#""type": "disk", "center": [0, 0, 5], "axis_u": [1, 0, 0], "axis_v": [2, 0, 0]"#;
    assert!(shape_reason(flat).starts_with("light.axis_u and axis_v: "));
}

#[test]
fn a_textured_case_has_its_image_where_its_coordinates_say() {
    let image = Arc::new(Texture::gradient(4, 4));
    let with = |uv: &str| {
        let light = format!(r#"{QUAD}, "texture": "light.exr", "uv": {uv}"#);
        let case = read_one(&case(GGX, &light)).unwrap();
        case.supported(|path| if path == "light.exr" { Ok(Arc::clone(&image)) } else { no_image(path) })
    };
    let supported = with("[[0, 1], [1, 1], [1, 0.5], [0, 0.5]]").unwrap();
    let light = supported.polygon().unwrap();
    let shown = light.image.unwrap();
    assert_eq!(shown.texture, image);
    // Relative to the shading point: the vertex at uv (0, 0.5) is the box's corner
    assert!((shown.map.corner - DVec3::new(0.0, 1.0, 1.0)).length() < 1e-12, "{:?}", shown.map);
    assert!(shown.map.coordinate(light.vertices[2]).abs_diff_eq(DVec2::new(1.0, 0.5), 1e-12));
    // A light that straddles what it is seen through has no answer on any path
    let window = r#""opening": {"center": [1.5, 2.5, 4], "axis_u": [1, 0, 0], "axis_v": [0, 0, 1]}"#;
    let straddled = reason(GGX, &format!("{QUAD}, {window}"));
    assert!(straddled.starts_with("light.opening: "), "{straddled}");
    let bent = with("[[0, 0], [1, 0], [0.7, 0.7], [0, 1]]").unwrap_err();
    assert!(bent.starts_with("light.texture: uvs["), "{bent}");
}

#[test]
fn a_coat_is_read_and_what_the_library_has_not_has_a_reason() {
    const COAT: &str = r#""bsdf": "coat", "alpha": 0.25, "coat_weight": 0.5, "coat_alpha": 0.01"#;
    let with = |more: &str| format!(r"{COAT}, {more}");
    let gltf = r#""coat_F0": 0.04, "layering": "gltf""#;
    let surface = read_one(&case(&with(gltf), QUAD)).unwrap().supported(no_image).unwrap().surface;
    assert_eq!(surface.coat, Some(Coat { weight: 0.5, alpha: 0.01, normal: None, by_albedo: false }));
    assert_eq!((surface.alpha, surface.f0), (0.25, DVec3::ONE));
    let tilted = with(&format!(r#"{gltf}, "coat_normal": [0, 3, 4]"#));
    let coat = read_one(&case(&tilted, QUAD)).unwrap().supported(no_image).unwrap().surface.coat.unwrap();
    assert_eq!(coat.normal, Some(DVec3::new(0.0, 3.0, 4.0)));
    let by_albedo =
        with(r#""coat_F0": 0.04, "layering": "albedo", "F0": [0.04, 0.1, 0.05], "coupling": "gltf""#);
    let surface = read_one(&case(&by_albedo, QUAD)).unwrap().supported(no_image).unwrap().surface;
    assert!(surface.coat.unwrap().by_albedo);
    assert_eq!(surface.interface, Some(Interface { f0: 0.1, f90: 1.0, by_albedo: false }));
    let reason = reason(&with(r#""coat_F0": 0.05, "layering": "gltf""#), QUAD);
    assert_eq!(reason, "coat_F0 0.05 is not supported; 0.04 is");
    for (more, expected) in [
        (r#""coat_F0": 0.04"#, "layering: is missing"),
        (r#""coat_F0": 2, "layering": "gltf""#, "coat_F0: 2 must be from 0 to 1"),
        (r#""coat_F0": 0.04, "layering": "lacquer""#, "layering: \"lacquer\" is not known"),
        (r#""coat_F0": 0.04, "layering": "gltf", "coupling": "loose""#, "coupling: \"loose\" is not known"),
    ] {
        let message = message(&with(more), QUAD);
        assert!(message.starts_with(&format!("case 'a case': {expected}")), "{message}");
    }
}

#[test]
fn an_unknown_field_is_never_ignored() {
    assert_eq!(reason(&format!(r#"{GGX}, "coat": 1"#), QUAD), "the field \"coat\" is not known");
    assert_eq!(
        reason(GGX, &format!(r#"{QUAD}, "two_sidde": true"#)),
        "the field \"light.two_sidde\" is not known: \"two_sided\"?"
    );
    let window =
        r#""opening": {"center": [1, 2, 3.5], "axis_u": [1, 0, 0], "axis_v": [0, 1, 0], "hosued": true}"#;
    assert_eq!(
        reason(GGX, &format!("{QUAD}, {window}")),
        "the field \"light.opening.hosued\" is not known: \"housed\"?"
    );
    // A field of another kind of case is unknown too
    assert_eq!(
        reason(r#""bsdf": "diffuse", "albedo": [1, 1, 1], "alpha": 1"#, QUAD),
        "the field \"alpha\" is not known"
    );
    let like = reason(r#""alpha": 0.25, "f0": [1, 1, 1]"#, QUAD);
    assert_eq!(like, "the field \"f0\" is not known: \"F0\"?");
    let missing = message(r#""alhpa": 0.25"#, QUAD);
    assert_eq!(missing, "case 'a case': alpha: is missing; \"alhpa\" is there");
}

#[test]
fn a_key_that_is_there_twice_is_refused() {
    let text = case(GGX, QUAD);
    let twice = |key: &str, more: &str| text.replacen(key, &format!("{more}, {key}"), 1);
    for (doubled, key) in [
        (twice("\"alpha\"", "\"alpha\": 0.5"), "alpha"),
        (twice("\"type\"", "\"type\": \"disk\""), "type"),
        (twice("\"name\"", "\"na\\u006de\": \"other\""), "name"),
    ] {
        let said = read_one(&doubled).unwrap_err().to_string();
        assert!(said.contains(&format!("not JSON: the key \"{key}\" is there twice at line")), "{said}");
    }
    assert!(read_cases(&format!(r#"{{"cases": [], "cases": [{text}]}}"#)).is_err());
}

#[test]
fn errors_name_the_case_and_the_field() {
    let two = r#""type": "polygon", "vertices": [[1, 2, 4], [2, 2, 4]]"#;
    let bent = r#""type": "polygon", "vertices": [[0, 0, 1], [1, 0, 1], [1, 1, 1.1], [0, 1, 1]]"#;
    let short_uv = format!(r#"{QUAD}, "texture": "t.exr", "uv": [[0, 0]]"#);
    let levels = format!(r#"{QUAD}, "profile_levels": 2.7"#);
    let null = r#""type": "polygon", "vertices": [[1, 2, 4], [2, null, 4], [0, 0, 4]]"#;
    for (material, light, expected) in [
        (GGX, two, "light.vertices: 2 given, a polygon has at least 3"),
        (GGX, bent, "light.vertices["),
        (GGX, short_uv.as_str(), "light.uv: 1 given for 4 vertices"),
        (GGX, levels.as_str(), "light.profile_levels: 2.7 must be a whole number"),
        (GGX, null, "light.vertices[1][1]: is null (some programs write NaN so), where a number should be"),
        (GGX, r#""type": "cube""#, "light.type: \"cube\" is not known"),
        (GGX, r#""type": "sphere", "center": [0, 0, 0], "radius": -1"#, "light.radius: -1 must be above 0"),
        (GGX, r#""type": "sphere", "radius": 1"#, "light.center: is missing"),
        (GGX, r#""type": 3"#, "light.type: is the number 3, where a text should be"),
        (r#""alpha": 0"#, QUAD, "alpha: 0 must be above 0 and at most 1"),
        (r#""alpha": 1.5"#, QUAD, "alpha: 1.5 must be above 0 and at most 1"),
        (r#""F0": [0, 0, 0]"#, QUAD, "alpha: is missing"),
        (r#""alpha": 0.5, "alpha_x": 0.5"#, QUAD, "alpha: give either alpha, or alpha_x and alpha_y"),
        (r#""alpha": 0.5, "F0": [0, 0, 2]"#, QUAD, "F0: [0, 0, 2] must be from 0 to 1"),
        (r#""alpha": 0.5, "albedo": [0, 0, -1]"#, QUAD, "albedo: [0, 0, -1] must be not negative"),
        (r#""alpha": 0.5, "G": "v-cavity""#, QUAD, "G: \"v-cavity\" is not known"),
        (r#""bsdf": "diffuse""#, QUAD, "albedo: is missing"),
        (r#""bsdf": "velvet""#, QUAD, "bsdf: \"velvet\" is not known"),
    ] {
        let message = message(material, light);
        assert!(message.starts_with(&format!("case 'a case': {expected}")), "{message}\nnot {expected}");
    }
    let zero = case(GGX, QUAD).replace("[0, 0, 2]", "[0, 0, 0]");
    assert_eq!(
        read_one(&zero).unwrap_err().to_string(),
        "case 'a case': normal: is zero, and has no direction"
    );
    let nameless = case(GGX, QUAD).replace("\"name\"", "\"title\"");
    assert_eq!(read_one(&nameless).unwrap_err().to_string(), "case 'cases[0]': name: is missing");
}

#[test]
fn files_that_are_no_cases_are_refused() {
    let message = |text: &str| read_cases(text).unwrap_err().to_string();
    assert!(message("[]").starts_with("cases: missing or no array; a file of cases is"));
    assert!(message(r#"{"cases": [3]}"#).starts_with("cases[0]: is the number 3, where an object"));
    assert!(message("").starts_with("not JSON: EOF"));
    for number in ["NaN", "nan", "-Infinity", "Infinity", "inf"] {
        let text = format!("{{\"cases\": [\n{}]}}", case(&format!("\"alpha\": {number}"), QUAD));
        let message = message(&text);
        assert!(
            message.contains("at line 2 column") && message.ends_with("JSON has no NaN and no infinity"),
            "{message}"
        );
    }
    assert!(message(r#"{"cases": [1e999]}"#).contains("number out of range at line 1"));
    let twice = format!(r#"{{"cases": [{0}, {0}]}}"#, case(GGX, QUAD));
    assert_eq!(message(&twice), "case 'a case': name: another case has the same name");
}
