// The exported kernel by the clipless method, for comparison: as three.js has it, edges are summed as they are, and a sphere stands for what the
// horizon leaves of a light. Source: Hill and Heitz 2016, "Real-Time Area Lighting: a Journey from Research to Production".

// Table, lobes and lights stay as they are: two functions of the kernel are renamed, and others stand in their place.
export const clipless = (code) => code.replace(/fn (?=arealight_(quad_vector|form_factor)\()/g, "fn exact_") + /* wgsl */ `
fn clipless_edge(a: vec3f, b: vec3f) -> vec3f {
    let x = dot(a, b);
    let y = abs(x);
    let weight = (0.8543985 + (0.4965155 + 0.0145206 * y) * y) / (3.4175940 + (4.1616724 + y) * y);
    return cross(b, a) * select(0.5 * inverseSqrt(max(1.0 - x * x, 1e-7)) - weight, weight, x > 0.0);
}

fn arealight_quad_vector(quad: ptr<function, ArealightQuad>, front: ptr<function, f32>) -> vec3f {
    let a = normalize((*quad).a);
    let b = normalize((*quad).b);
    let c = normalize((*quad).c);
    let d = normalize((*quad).d);
    return clipless_edge(a, b) + clipless_edge(b, c) + clipless_edge(c, d) + clipless_edge(d, a);
}

fn arealight_form_factor(vector: ptr<function, vec3f>) -> f32 {
    let size = length(*vector);
    return max((size * size + (*vector).z) / (size + 1.0), 0.0);
}`;
