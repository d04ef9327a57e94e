// A floor below two lights, seen by a camera: its G-buffer, pixel by pixel.

import { normalize } from "./arealight.js";

export const camera = [0, 1.4, 4.2];

export const lights = [
    { radiance: [9, 6, 3], vertices: [[-1.6, 0.15, -1.2], [-0.5, 0.15, -1.6], [-0.5, 1.5, -1.6], [-1.6, 1.5, -1.2]] },
    { radiance: [2.5, 5, 10], vertices: [[0.4, 0.1, -1.7], [1.9, 0.1, -1.0], [1.15, 1.6, -1.35]] },
];

// Where a ray from the camera through a pixel goes.
function direction(x, y, [width, height]) {
    const scale = 0.9 / height;
    return normalize([(2 * x + 1 - width) * scale / 2, (height - 2 * y - 1) * scale / 2 - 0.16, -1]);
}

// What a ray meets of a light before it meets the floor: its radiance, or nothing.
function emission(ray) {
    for (const { radiance, vertices } of lights) {
        const sides = vertices.map((vertex, index) => {
            const next = vertices[(index + 1) % vertices.length];
            const [a, b] = [vertex, next].map((one) => one.map((x, axis) => x - camera[axis]));
            return ray[0] * (a[1] * b[2] - a[2] * b[1]) + ray[1] * (a[2] * b[0] - a[0] * b[2]) + ray[2] * (a[0] * b[1] - a[1] * b[0]);
        });
        if (sides.every((side) => side > 0) || sides.every((side) => side < 0)) return radiance;
    }
    return null;
}

// The floor's G-buffer; of pixels that see a light the emission, which is added to what they reflect.
export function gBuffer(size) {
    const [width, height] = size;
    const made = ["position", "normal", "base_color", "emission"].map((name) => [name, new Float32Array(4 * width * height)]);
    const { position, normal, base_color, emission: emitted } = Object.fromEntries(made);
    for (let y = 0; y < height; y++) {
        for (let x = 0; x < width; x++) {
            const [ray, at] = [direction(x, y, size), 4 * (y * width + x)];
            const light = emission(ray);
            if (light) {
                emitted.set(light, at);
            } else if (ray[1] < 0) {
                const distance = -camera[1] / ray[1];
                const [px, pz] = [0, 2].map((axis) => camera[axis] + distance * ray[axis]);
                const isDark = (Math.floor(px) + Math.floor(pz)) & 1;
                position.set([px, 0, pz, 1], at);
                normal.set([0, 1, 0, isDark ? 0.15 : 0.4], at);
                base_color.set(isDark ? [0.05, 0.05, 0.06, 0] : [0.6, 0.6, 0.6, 0], at);
            }
        }
    }
    return { position, normal, base_color, emission: emitted };
}
