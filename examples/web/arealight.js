// Arealight in WebGPU: the exported kernel, the table, lights as records, and a frame. All layouts come from the export's manifest.json.

// Loads what `arealight export DIR --target webgpu --effects ...` wrote. `table` changes the table's layers, for tests of what a wrong one does;
// `kernel` changes the kernel, see clipless.js.
export async function load(device, folder, table = (layers) => layers, kernel = (code) => code) {
    const fetched = async (path) => {
        const response = await fetch(`${folder}/${path}`);
        if (!response.ok) throw new Error(`${folder}/${path}: ${response.status}`);
        return response;
    };
    const manifest = await (await fetched("manifest.json")).json();
    const target = manifest.targets.webgpu;
    const code = kernel(await (await fetched(target.file)).text());
    const pipeline = await device.createComputePipelineAsync({
        layout: "auto",
        compute: { module: device.createShaderModule({ code }), entryPoint: target.entry_point },
    });
    const file = new DataView(await (await fetched("tables/ggx.ktx2")).arrayBuffer());
    return { device, target, pipeline, table: tableTexture(device, file, table) };
}

// Runs the export's self-test with the table: a bit for each of ten points that is wrong, 0 where all are right.
export async function wrongPoints({ device, table }, folder) {
    const code = await (await fetch(`${folder}/webgpu/self_test.wgsl`)).text();
    const compute = { module: device.createShaderModule({ code }), entryPoint: "main" };
    const pipeline = await device.createComputePipelineAsync({ layout: "auto", compute });
    const { STORAGE, COPY_SRC, COPY_DST, MAP_READ } = GPUBufferUsage;
    const [found, readback] = [STORAGE | COPY_SRC, COPY_DST | MAP_READ].map((usage) => device.createBuffer({ size: 4, usage }));
    const entries = [table.createView({ dimension: "2d-array" }), { buffer: found }].map((resource, binding) => ({ binding, resource }));
    const commands = device.createCommandEncoder();
    const pass = commands.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
    pass.dispatchWorkgroups(1);
    pass.end();
    commands.copyBufferToBuffer(found, 0, readback, 0, 4);
    device.queue.submit([commands.finish()]);
    await readback.mapAsync(GPUMapMode.READ);
    return new Uint32Array(readback.getMappedRange())[0];
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

export const subtract = (a, b) => a.map((x, i) => x - b[i]);
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
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

// A picture of `size` pixels that is shaded again and again: its G-buffer, up to `capacity` lights, and its
// radiance. `inputs` are all but the radiance, of another frame that shows the same by another kernel.
export class Frame {
    constructor({ device, target, pipeline, table }, size, capacity, inputs = null) {
        Object.assign(this, { device, target, pipeline, size });
        const { COPY_DST, STORAGE, UNIFORM } = GPUBufferUsage;
        const buffer = (usage, bytes) => device.createBuffer({ size: bytes, usage: usage | COPY_DST });
        const texture = (usage) => device.createTexture({ size, format: "rgba32float", usage });
        const { TEXTURE_BINDING, COPY_SRC, STORAGE_BINDING } = GPUTextureUsage;
        const image = () => texture(TEXTURE_BINDING | GPUTextureUsage.COPY_DST);
        this.inputs = inputs ?? {
            lights: buffer(STORAGE, capacity * target.structs.ArealightGpuLight.size),
            vertices: buffer(STORAGE, capacity * 4 * 16),
            constants: buffer(UNIFORM, target.structs.ShadeConstants.size),
            position: image(),
            normal: image(),
            base_color: image(),
        };
        Object.assign(this, this.inputs);
        this.radiance = texture(STORAGE_BINDING | TEXTURE_BINDING | COPY_SRC);
        this.set = this.bind({
            table_image: table.createView({ dimension: "2d-array" }),
            lights: { buffer: this.lights },
            light_vertices: { buffer: this.vertices },
            g_position: this.position.createView(),
            g_normal: this.normal.createView(),
            g_base_color: this.base_color.createView(),
            radiance_image: this.radiance.createView(),
            constants: { buffer: this.constants },
        });
    }

    // By the manifest's names.
    bind(resources) {
        const entries = this.target.bindings.map(({ binding, name }) => {
            if (!resources[name]) throw new Error(`the kernel wants ${name}: this page shades quads on surfaces of two lobes alone`);
            return { binding, resource: resources[name] };
        });
        return this.device.createBindGroup({ layout: this.pipeline.getBindGroupLayout(0), entries });
    }

    // `position`, `normal` and `base_color`: four floats a pixel, in world space.
    setSurfaces(gBuffer) {
        const layout = { bytesPerRow: 16 * this.size[0] };
        for (const name of ["position", "normal", "base_color"]) {
            this.device.queue.writeTexture({ texture: this[name] }, gBuffer[name], layout, this.size);
        }
    }

    setLights(lights, camera) {
        const packed = packLights(this.target, lights);
        const block = this.target.structs.ShadeConstants;
        const constants = new DataView(new ArrayBuffer(block.size));
        writeStruct(block, constants, 0, { camera, light_count: packed.count, quad_count: packed.count, size: this.size });
        this.device.queue.writeBuffer(this.lights, 0, packed.records);
        this.device.queue.writeBuffer(this.vertices, 0, packed.vertices);
        this.device.queue.writeBuffer(this.constants, 0, constants);
    }

    dispatch(commands) {
        const pass = commands.beginComputePass();
        pass.setPipeline(this.pipeline);
        pass.setBindGroup(0, this.set);
        pass.dispatchWorkgroups(...this.size.map((side, axis) => Math.ceil(side / this.target.workgroup_size[axis])));
        pass.end();
    }

    // Shades, and returns the radiance, four floats a pixel.
    async read() {
        const commands = this.device.createCommandEncoder();
        this.dispatch(commands);
        const bytesPerRow = 256 * Math.ceil(this.size[0] / 16);
        const usage = GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ;
        const readback = this.device.createBuffer({ size: bytesPerRow * this.size[1], usage });
        commands.copyTextureToBuffer({ texture: this.radiance }, { buffer: readback, bytesPerRow }, this.size);
        this.device.queue.submit([commands.finish()]);
        await readback.mapAsync(GPUMapMode.READ);
        const rows = new Float32Array(readback.getMappedRange());
        const [width, height] = this.size;
        const texels = new Float32Array(4 * width * height);
        for (let y = 0; y < height; y++) {
            texels.set(rows.subarray(y * bytesPerRow / 4, y * bytesPerRow / 4 + 4 * width), y * 4 * width);
        }
        return texels;
    }
}
