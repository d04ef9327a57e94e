// Arealight in WebGPU: the exported kernel, the table, lights as records, and a frame. All layouts come from the export's manifest.json.

// Loads what `arealight export DIR --target webgpu --effects ...` wrote. `table` changes the table's layers, for tests of what a wrong one does.
export async function load(device, folder, table = (layers) => layers) {
    const fetched = async (path) => {
        const response = await fetch(`${folder}/${path}`);
        if (!response.ok) throw new Error(`${folder}/${path}: ${response.status}`);
        return response;
    };
    const manifest = await (await fetched("manifest.json")).json();
    const target = manifest.targets.webgpu;
    const code = await (await fetched(target.file)).text();
    const pipeline = await device.createComputePipelineAsync({
        layout: "auto",
        compute: { module: device.createShaderModule({ code }), entryPoint: target.entry_point },
    });
    const file = new DataView(await (await fetched("tables/ggx.ktx2")).arrayBuffer());
    return { device, target, pipeline, table: tableTexture(device, file, table) };
}

// The table's texture. In a KTX2 file without supercompression the place and length of level 0 are at bytes 80 and 88.
function tableTexture(device, file, change) {
    const [width, height, layers] = [20, 24, 32].map((at) => file.getUint32(at, true));
    const [offset, length] = [80, 88].map((at) => Number(file.getBigUint64(at, true)));
    const texels = change(new Uint16Array(file.buffer.slice(offset, offset + length)), width, layers);
    const texture = device.createTexture({
        size: [width, height, layers],
        format: "rgba16float",
        usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
    });
    const layout = { bytesPerRow: 8 * width, rowsPerImage: height };
    device.queue.writeTexture({ texture }, texels, layout, [width, height, layers]);
    return texture;
}

// Writes values to the fields of a struct, by the manifest's offsets.
function writeStruct(layout, view, at, values) {
    for (const [name, value] of Object.entries(values)) {
        const field = layout.fields.find((one) => one.name === name);
        if (!field) throw new Error(`the kernel has no field ${name}`);
        const isInteger = field.type.includes("u32");
        [value].flat().forEach((number, index) => {
            const place = at + field.offset + 4 * index;
            if (isInteger) view.setUint32(place, number, true);
            else view.setFloat32(place, number, true);
        });
    }
}

const subtract = (a, b) => a.map((x, i) => x - b[i]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const normalize = (a) => a.map((x) => x / Math.hypot(...a));

const TWO_SIDED = 1, FLAT = 2, QUAD = 8, NO_TEXTURE = 0xffffffff;

// Packs convex lights of three or four vertices: the records, and rows of vertices.
export function packLights(target, lights) {
    const layout = target.structs.ArealightGpuLight;
    const records = new DataView(new ArrayBuffer(layout.size * Math.max(lights.length, 1)));
    const vertices = [];
    lights.forEach((light, index) => {
        const count = light.vertices.length;
        const center = [0, 1, 2].map((axis) => light.vertices.reduce((sum, vertex) => sum + vertex[axis], 0) / count);
        const outline = light.vertices.map((vertex) => subtract(vertex, center));
        const radius = Math.max(...outline.map((vertex) => Math.hypot(...vertex)));
        const area = cross(subtract(outline[1], outline[0]), subtract(outline[2], outline[0]));
        writeStruct(layout, records, index * layout.size, {
            radiance: light.radiance,
            first_vertex: vertices.length / 4,
            center,
            radius,
            normal: normalize(area),
            area: Math.hypot(...area) / (radius * radius) * (count === 3 ? 0.5 : 1),
            vertex_count: count,
            flags: (light.two_sided ? TWO_SIDED : 0) | FLAT | QUAD,
            texture_layer: NO_TEXTURE,
        });
        outline.forEach((vertex) => vertices.push(...vertex, 0));
    });
    return { records, vertices: new Float32Array(vertices), count: lights.length };
}

// A buffer that holds these bytes.
function buffer(device, usage, data) {
    const made = device.createBuffer({ size: data.byteLength, usage: usage | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(made, 0, data.buffer, data.byteOffset, data.byteLength);
    return made;
}

// A texture of four 32-bit floats a texel.
function texture(device, size, texels) {
    const made = device.createTexture({
        size,
        format: "rgba32float",
        usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
    });
    device.queue.writeTexture({ texture: made }, texels, { bytesPerRow: 16 * size[0] }, size);
    return made;
}

// Shades a G-buffer (`position`, `normal` and `base_color`, four floats a pixel, in world space) that is seen from `camera`. Returns the
// radiance, four floats a pixel.
export async function shade({ device, target, pipeline, table }, gBuffer, size, camera, lights) {
    const packed = packLights(target, lights);
    const block = target.structs.ShadeConstants;
    const constants = new DataView(new ArrayBuffer(block.size));
    writeStruct(block, constants, 0, { camera, light_count: packed.count, quad_count: packed.count, size });

    // Bind by the manifest's names
    const radiance = device.createTexture({
        size,
        format: "rgba32float",
        usage: GPUTextureUsage.STORAGE_BINDING | GPUTextureUsage.COPY_SRC,
    });
    const resources = {
        table_image: table.createView({ dimension: "2d-array" }),
        lights: { buffer: buffer(device, GPUBufferUsage.STORAGE, packed.records) },
        light_vertices: { buffer: buffer(device, GPUBufferUsage.STORAGE, packed.vertices) },
        g_position: texture(device, size, gBuffer.position).createView(),
        g_normal: texture(device, size, gBuffer.normal).createView(),
        g_base_color: texture(device, size, gBuffer.base_color).createView(),
        radiance_image: radiance.createView(),
        constants: { buffer: buffer(device, GPUBufferUsage.UNIFORM, constants) },
    };
    const entries = target.bindings.map(({ binding, name }) => {
        if (!resources[name]) throw new Error(`the kernel wants ${name}: this page shades quads on surfaces of two lobes alone`);
        return { binding, resource: resources[name] };
    });

    // Dispatch, and read back
    const commands = device.createCommandEncoder();
    const pass = commands.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
    pass.dispatchWorkgroups(...size.map((side, axis) => Math.ceil(side / target.workgroup_size[axis])));
    pass.end();
    const bytesPerRow = 256 * Math.ceil(size[0] / 16);
    const readback = device.createBuffer({
        size: bytesPerRow * size[1],
        usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ,
    });
    commands.copyTextureToBuffer({ texture: radiance }, { buffer: readback, bytesPerRow }, size);
    device.queue.submit([commands.finish()]);
    await readback.mapAsync(GPUMapMode.READ);
    const rows = new Float32Array(readback.getMappedRange());
    const texels = new Float32Array(4 * size[0] * size[1]);
    for (let y = 0; y < size[1]; y++) {
        texels.set(rows.subarray(y * bytesPerRow / 4, y * bytesPerRow / 4 + 4 * size[0]), y * 4 * size[0]);
    }
    return texels;
}
