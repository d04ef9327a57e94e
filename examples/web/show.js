// Shows the radiance of two frames, either side of a line, and the lamps in it, on a canvas.

import { camera, lamps } from "./scene.js";

const CODE = /* wgsl */ `
struct View { position: vec4f, right: vec4f, up: vec4f, forward: vec4f } // the line in position.w, tan in up.w, chosen lamp in right.w, exposure in forward.w
struct Lamp { radiance: vec4f, normal: vec4f, vertices: array<vec4f, 4> } // the count of vertices in radiance.w
@group(0) @binding(0) var radiance: texture_2d<f32>;
@group(0) @binding(1) var position: texture_2d<f32>;
@group(0) @binding(2) var<uniform> view: View;
@group(0) @binding(3) var<storage, read> lamps: array<Lamp>;
@group(0) @binding(4) var other: texture_2d<f32>; // on the right of the line

@vertex fn corner(@builtin(vertex_index) at: u32) -> @builtin(position) vec4f {
    return vec4f(f32(at & 1u) * 4.0 - 1.0, f32(at >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment fn show(@builtin(position) place: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(place.xy);
    let size = vec2f(textureDimensions(radiance));
    let scale = 2.0 * view.up.w / size.y;
    let ray = normalize(view.forward.xyz + (place.x - 0.5 * size.x) * scale * view.right.xyz
        + (0.5 * size.y - place.y) * scale * view.up.xyz);
    let surface = textureLoad(position, pixel, 0);
    var nearest = select(1e9, distance(surface.xyz, view.position.xyz), surface.w > 0.0);
    let line = place.x - view.position.w;
    if (abs(line) < 1.0) { return vec4f(0.9); }
    var color = select(textureLoad(radiance, pixel, 0), textureLoad(other, pixel, 0), line > 0.0).rgb;
    for (var i = 0u; i < arrayLength(&lamps); i++) {
        let normal = lamps[i].normal.xyz;
        let t = dot(lamps[i].vertices[0].xyz - view.position.xyz, normal) / dot(ray, normal);
        let there = view.position.xyz + t * ray;
        var inside = 1e9; // the least distance to an edge
        let count = u32(lamps[i].radiance.w);
        for (var v = 0u; v < count; v++) {
            let a = lamps[i].vertices[v].xyz;
            let edge = lamps[i].vertices[(v + 1u) % count].xyz - a;
            inside = min(inside, dot(cross(edge, there - a), normal) / length(edge));
        }
        let rim = select(0.0, 0.02, f32(i) == view.right.w);
        if (t > 0.0 && t < nearest && inside > -rim) {
            nearest = t;
            // The back is dark; the front is as bright as the screen gets and keeps its colour, at any exposure
            let radiance = lamps[i].radiance.rgb / max(lamps[i].radiance.r, max(lamps[i].radiance.g, lamps[i].radiance.b));
            let emitted = select(vec3f(0.02), 2.0 * radiance / view.forward.w, dot(ray, normal) < 0.0);
            color = select(emitted, vec3f(4.0) / view.forward.w, inside < rim);
        }
    }
    let shown = 1.0 - exp(-color * view.forward.w);
    return vec4f(select(1.055 * pow(shown, vec3f(1.0 / 2.4)) - 0.055, 12.92 * shown, shown <= vec3f(0.0031308)), 1.0);
}`;

export class Shown {
    constructor(device, canvas, [left, right]) {
        this.device = device;
        this.context = canvas.getContext("webgpu");
        const format = navigator.gpu.getPreferredCanvasFormat();
        this.context.configure({ device, format });
        const module = device.createShaderModule({ code: CODE });
        const unfilterable = { texture: { sampleType: "unfilterable-float" } };
        const visibility = GPUShaderStage.FRAGMENT;
        const layout = device.createBindGroupLayout({
            entries: [unfilterable, unfilterable, { buffer: {} }, { buffer: { type: "read-only-storage" } }, unfilterable].map((entry, binding) => ({
                binding,
                visibility,
                ...entry,
            })),
        });
        this.pipeline = device.createRenderPipeline({
            layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }),
            vertex: { module },
            fragment: { module, targets: [{ format }] },
        });
        const buffer = (floats, usage) => device.createBuffer({ size: 4 * floats, usage: usage | GPUBufferUsage.COPY_DST });
        this.view = buffer(16, GPUBufferUsage.UNIFORM);
        this.lamps = buffer(24 * lamps.length, GPUBufferUsage.STORAGE);
        const [radiance, position, other] = [left.radiance, left.position, right.radiance].map((texture) => texture.createView());
        const entries = [radiance, position, { buffer: this.view }, { buffer: this.lamps }, other].map((resource, binding) => ({ binding, resource }));
        this.set = device.createBindGroup({ layout, entries });
    }

    // `line`: where the two frames meet, in pixels from the left.
    draw(commands, lights, chosen, exposure, line) {
        const view = [camera.position, line, camera.right, chosen, camera.up, camera.tan, camera.forward, exposure];
        this.device.queue.writeBuffer(this.view, 0, new Float32Array(view.flat()));
        const records = lights.flatMap(({ radiance, vertices, normal }) => {
            const rows = [0, 1, 2, 3].flatMap((at) => [...(vertices[at] ?? vertices[0]), 0]);
            return [...radiance, vertices.length, ...normal, 0, ...rows];
        });
        this.device.queue.writeBuffer(this.lamps, 0, new Float32Array(records));
        const pass = commands.beginRenderPass({
            colorAttachments: [{ view: this.context.getCurrentTexture().createView(), loadOp: "clear", storeOp: "store" }],
        });
        pass.setPipeline(this.pipeline);
        pass.setBindGroup(0, this.set);
        pass.draw(3);
        pass.end();
    }
}
