// Shades points of a file that `arealight eval` reads, a pixel each, for a comparison with what that answers.

import { shade } from "./arealight.js";

// Of a point the G-buffer of one pixel. Surfaces are dielectrics of F0 = 0.04, or metals.
function surface(point) {
    const isMetal = !point.albedo;
    const color = isMetal ? point.F0 : point.albedo;
    const pixel = (...values) => new Float32Array(values);
    return {
        position: pixel(...point.position, 1),
        normal: pixel(...point.normal, Math.sqrt(point.alpha)),
        base_color: pixel(...color, isMetal ? 1 : 0),
    };
}

// The answers, as `arealight eval` writes them.
export async function answers(arealight, points) {
    const results = [];
    for (const point of points.cases) {
        const camera = point.position.map((x, axis) => x + point.view[axis]);
        const [r, g, b] = await shade(arealight, surface(point), [1, 1], camera, [point.light]);
        results.push({ name: point.name, radiance: [r, g, b] });
    }
    return { results };
}
