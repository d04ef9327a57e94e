// Shades points of a file that `arealight eval` reads, a pixel each, for a comparison with what that answers.

import { Frame } from "./arealight.js";

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
    const frame = new Frame(arealight, [1, 1], 1);
    for (const point of points.cases) {
        frame.setSurfaces(surface(point));
        frame.setLights([point.light], point.position.map((x, axis) => x + point.view[axis]));
        const [r, g, b] = await frame.read();
        results.push({ name: point.name, radiance: [r, g, b] });
    }
    return { results };
}

// Points of a picture that has one light, as a file of `arealight eval`, with the radiance that its pixels hold.
export function pointsOf(gBuffer, radiance, [width, height], camera, light) {
    const [cases, results] = [[], []];
    for (let y = 4; y < height; y += 11) {
        for (let x = 5; x < width; x += 15) {
            const texel = (texels) => [...texels.subarray(4 * (y * width + x), 4 * (y * width + x) + 4)];
            const [position, normal, color] = [gBuffer.position, gBuffer.normal, gBuffer.base_color].map(texel);
            if (position[3] === 0) continue;
            const name = `pixel ${x}, ${y}`;
            const place = position.slice(0, 3);
            const rgb = color.slice(0, 3);
            cases.push({
                name,
                position: place,
                normal: normal.slice(0, 3),
                view: camera.map((value, axis) => value - place[axis]),
                alpha: normal[3] ** 2,
                ...(color[3] === 1 ? { F0: rgb } : { F0: [0.04, 0.04, 0.04], albedo: rgb }),
                light: { type: "polygon", vertices: light.vertices, radiance: light.radiance, two_sided: false },
            });
            results.push({ name, radiance: texel(radiance).slice(0, 3) });
        }
    }
    return { cases, results };
}
