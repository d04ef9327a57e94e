// Balls on a floor below lamps, seen by a camera: lamps that can be moved, and the G-buffer, pixel by pixel.

import { cross, normalize, subtract } from "./arealight.js";

const add = (a, b, scale = 1) => a.map((x, axis) => x + scale * b[axis]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// It looks along -z, a little down; `tan` is of half its height's angle.
export const camera = { position: [0, 1.35, 4.6], right: [1, 0, 0], up: normalize([0, 1, -0.16]), tan: 0.42 };
camera.forward = cross(camera.up, camera.right);

// Lamps: an outline about its center, in its plane, one-sided.
const lamp = (radiance, center, u, v, outline) => ({ radiance, center, u, v, outline, scale: 1 });
const QUAD = [[-1, -1], [1, -1], [1, 1], [-1, 1]], TRIANGLE = [[-1, -1], [1, -1], [0, 1]];
export const lamps = [
    lamp([9, 6, 3], [-1.35, 0.95, -1.1], [0.5, 0, -0.25], [0, 0.62, 0], QUAD),
    lamp([2.5, 5, 10], [1.2, 0.4, -0.5], [0.8, 0, 0.4], [0, 0.8, 0], TRIANGLE),
    lamp([5, 5.2, 5.5], [0, 2.0, 1.6], [1.1, 0, 0], [0, -0.12, 0.35], QUAD),
];
export const vertices = ({ center, u, v, outline, scale }) =>
    outline.map(([x, y]) => add(add(center, u, x * scale), v, y * scale));
export const lights = () =>
    lamps.map((one) => ({ radiance: one.radiance, vertices: vertices(one), normal: normalize(cross(one.u, one.v)) }));

// Balls: center, radius, colour and metalness, roughness.
const BALLS = [
    [[-1.1, 0.3, 0.9], 0.3, [0.9, 0.62, 0.3, 1], 0.25],
    [[-0.37, 0.3, 1.2], 0.3, [0.7, 0.1, 0.08, 0], 0.35],
    [[0.37, 0.3, 1.2], 0.3, [0.55, 0.56, 0.58, 1], 0.5],
    [[1.1, 0.3, 0.9], 0.3, [0.1, 0.3, 0.5, 0], 0.15],
];
const FLOOR = [[[0.05, 0.05, 0.06, 0], 0.15], [[0.5, 0.5, 0.5, 0], 0.4]];

// Where a ray through a place of a picture goes: x and y from 0, at its left and top, to its size.
export function direction(x, y, [width, height]) {
    const scale = (2 * camera.tan) / height;
    const across = add(camera.forward, camera.right, (x - width / 2) * scale);
    return normalize(add(across, camera.up, (height / 2 - y) * scale));
}

// The place on the screen of a point, in pixels.
export function onScreen(point, [width, height]) {
    const offset = subtract(point, camera.position);
    const scale = height / (2 * camera.tan * dot(offset, camera.forward));
    return [width / 2 + dot(offset, camera.right) * scale, height / 2 - dot(offset, camera.up) * scale];
}

// How far along a ray a lamp is; Infinity beside it.
export function distanceTo(one, ray) {
    const offset = subtract(camera.position, one.center);
    const normal = cross(one.u, one.v);
    const distance = -dot(offset, normal) / dot(ray, normal);
    const there = add(offset, ray, distance);
    const [x, y] = [one.u, one.v].map((axis) => dot(there, axis) / (dot(axis, axis) * one.scale));
    const isInside = one.outline.every(([ax, ay], at) => {
        const [bx, by] = one.outline[(at + 1) % one.outline.length];
        return (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0;
    });
    return distance > 0 && isInside ? distance : Infinity;
}

// Moves a lamp across the view so that it stays below the pointer, by a step of the screen in pixels.
export function drag(one, step, [, height]) {
    const depth = dot(subtract(one.center, camera.position), camera.forward);
    const scale = (2 * camera.tan * depth) / height;
    one.center = add(add(one.center, camera.right, step[0] * scale), camera.up, -step[1] * scale);
}

// Moves it away from the viewer, by a part of its distance.
export function push(one, part) {
    const offset = subtract(one.center, camera.position);
    one.center = add(camera.position, offset, Math.min(Math.max(1 + part, 1 / Math.hypot(...offset)), 9 / Math.hypot(...offset)));
}

// What a ray meets: its distance, normal, colour and roughness.
function meet(ray) {
    let nearest = { distance: Infinity };
    if (ray[1] < 0) {
        const distance = -camera.position[1] / ray[1];
        const [px, , pz] = add(camera.position, ray, distance);
        const [color, roughness] = FLOOR[(Math.floor(px) + Math.floor(pz)) & 1];
        nearest = { distance, normal: [0, 1, 0], color, roughness };
    }
    for (const [center, radius, color, roughness] of BALLS) {
        const offset = subtract(camera.position, center);
        const along = dot(offset, ray);
        const root = along * along - dot(offset, offset) + radius * radius;
        const distance = -along - Math.sqrt(root);
        if (root > 0 && distance < nearest.distance) {
            nearest = { distance, normal: normalize(add(offset, ray, distance)), color, roughness };
        }
    }
    return nearest;
}

// The surfaces that pixels see, with roughnesses moved by an offset.
export function gBuffer(size, offset = 0) {
    const [width, height] = size;
    const made = ["position", "normal", "base_color"].map((name) => [name, new Float32Array(4 * width * height)]);
    const { position, normal, base_color } = Object.fromEntries(made);
    for (let y = 0; y < height; y++) {
        for (let x = 0; x < width; x++) {
            const [ray, at] = [direction(x + 0.5, y + 0.5, size), 4 * (y * width + x)];
            const met = meet(ray);
            if (met.distance < 60) {
                position.set([...add(camera.position, ray, met.distance), 1], at);
                normal.set([...met.normal, Math.min(Math.max(met.roughness + offset, 0.02), 1)], at);
                base_color.set(met.color, at);
            }
        }
    }
    return { position, normal, base_color };
}
