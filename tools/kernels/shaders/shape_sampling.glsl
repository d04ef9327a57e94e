#ifndef SHAPE_SAMPLING_GLSL
#define SHAPE_SAMPLING_GLSL

// Drawing points of disks, spheres and tubes, and the density of such draws in solid angle: for the Monte
// Carlo reference.

#include "random.glsl"
#include "round_lights.glsl"
#include "arealight/shadows/ray_origin.glsl"

bool is_two_sided(ArealightGpuShape shape) {
    return (shape.flags & SHAPE_TWO_SIDED) != 0u;
}

// A point that was drawn, or that a ray meets.
struct ShapeSample {
    vec3 offset;   // from the shading point
    float density; // in solid angle; 0 where it does not shine towards the shading point, or is none
};

// The density in solid angle of a point that was drawn by area; `error` as in arealight_lit_side.
float area_density(vec3 offset, vec3 normal, float area, bool two_sided, float error) {
    float square = dot(offset, offset);
    float cosine = -dot(normal, offset) * inversesqrt(max(square, AREALIGHT_TINY));
    bool shines = arealight_lit_side(offset, normal, two_sided, error) != 0.0;
    return shines ? square / (area * abs(cosine)) : 0.0;
}

// Two unit vectors across a third one.
void make_basis(vec3 axis, out vec3 across, out vec3 up) {
    vec3 other = abs(axis.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    across = arealight_normalize_or(cross(axis, other), vec3(0.0, 0.0, 1.0));
    up = cross(axis, across);
}

// The density of directions drawn evenly from the cone that a sphere fills, `center` being from the shading
// point: that of all directions from inside, where only a sphere of two sides shines.
float sphere_density(vec3 center, float radius, bool two_sided) {
    float square = radius * radius / dot(center, center);
    if (!(square < 1.0)) {
        return two_sided ? 0.25 * AREALIGHT_INVERSE_PI : 0.0;
    }
    // 1 - cosine, without a cancellation
    float height = square / (1.0 + sqrt(1.0 - square));
    return 0.5 * AREALIGHT_INVERSE_PI / height;
}

// How far a ray from the shading point goes to a sphere's surface, `center` being from there: into it, or out
// of it from inside. A ray that misses it goes as far as it comes near.
float sphere_distance(vec3 center, float radius, vec3 ray) {
    float approach = dot(center, ray);
    vec3 beside = center - approach * ray;
    float depth = sqrt(max(radius * radius - dot(beside, beside), 0.0));
    return dot(center, center) > radius * radius ? approach - depth : approach + depth;
}

float ellipse_area(ArealightGpuShape shape) {
    return AREALIGHT_PI * length(cross(shape.axis_u, shape.axis_v));
}

// The density at `offset` of an ellipse around `center`, both from the shading point.
float ellipse_density(ArealightGpuShape shape, vec3 center, vec3 offset, vec3 normal) {
    float error = arealight_position_error(shape.center - center);
    return area_density(offset, normal, ellipse_area(shape), is_two_sided(shape), error);
}

// Areas of a tube's mantle and of both its ends.
vec2 tube_areas(ArealightGpuShape shape) {
    float round = AREALIGHT_PI * shape.radius;
    float ends = int(shape.detail) == AREALIGHT_TUBE_ROUND ? 4.0 : int(shape.detail) == AREALIGHT_TUBE_FLAT
        ? 2.0 : 0.0;
    return round * vec2(4.0 * length(shape.axis_u), ends * shape.radius);
}

ShapeSample sample_ellipse(ArealightGpuShape shape, vec3 center, inout RandomState random) {
    float radius = sqrt(random_float(random));
    float angle = 2.0 * AREALIGHT_PI * random_float(random);
    vec3 offset = center + radius * (cos(angle) * shape.axis_u + sin(angle) * shape.axis_v);
    vec3 normal = arealight_normalize_or(cross(shape.axis_u, shape.axis_v), vec3(0.0));
    return ShapeSample(offset, ellipse_density(shape, center, offset, normal));
}

ShapeSample sample_sphere(ArealightGpuShape shape, vec3 center, inout RandomState random) {
    float density = sphere_density(center, shape.radius, is_two_sided(shape));
    vec3 axis = arealight_normalize_or(center, vec3(0.0, 0.0, 1.0));
    vec3 across;
    vec3 up;
    make_basis(axis, across, up);
    // Heights of a cone's cap are even
    float depth = random_float(random) * 0.5 * AREALIGHT_INVERSE_PI / max(density, AREALIGHT_TINY);
    float sine = sqrt(max(depth * (2.0 - depth), 0.0));
    float angle = 2.0 * AREALIGHT_PI * random_float(random);
    vec3 ray = (1.0 - depth) * axis + sine * (cos(angle) * across + sin(angle) * up);
    return ShapeSample(ray * sphere_distance(center, shape.radius, ray), density);
}

ShapeSample sample_tube(ArealightGpuShape shape, vec3 center, inout RandomState random) {
    vec2 areas = tube_areas(shape);
    float choice = random_float(random) * (areas.x + areas.y);
    float u = random_float(random);
    float angle = 2.0 * AREALIGHT_PI * random_float(random);
    vec3 axis = arealight_normalize_or(shape.axis_u, vec3(0.0, 0.0, 1.0));
    vec3 across;
    vec3 up;
    make_basis(axis, across, up);
    vec3 radial = cos(angle) * across + sin(angle) * up;
    vec3 offset;
    vec3 normal;
    if (choice < areas.x) {
        normal = radial;
        offset = center + (2.0 * u - 1.0) * shape.axis_u + shape.radius * normal;
    } else if (int(shape.detail) == AREALIGHT_TUBE_ROUND) {
        float height = 2.0 * u - 1.0;
        normal = height * axis + sqrt(max(1.0 - height * height, 0.0)) * radial;
        offset = center + (height < 0.0 ? -shape.axis_u : shape.axis_u) + shape.radius * normal;
    } else {
        // The random number that chose the ends chooses one of them
        float side = choice < areas.x + 0.5 * areas.y ? -1.0 : 1.0;
        normal = side * axis;
        offset = center + side * shape.axis_u + shape.radius * sqrt(u) * radial;
    }
    return ShapeSample(offset, area_density(offset, normal, areas.x + areas.y, false, 0.0));
}

// How much of the way to a point of a shape is before the shape's own geometry; from inside, all of it. It is
// up to the greater of two distances within which no ray meets it: to the plane across the ray that touches
// the tube, and to the endless tube.
float part_before(ArealightGpuShape shape, vec3 position, vec3 offset) {
    vec3 center = shape.center - position;
    if (shape.kind == SHAPE_DISK || dot(center, center) < shape.radius * shape.radius) {
        return 1.0;
    }
    float wide = AREALIGHT_ROUND_MARGIN * shape.radius;
    vec3 axis = shape.axis_u / max(dot(shape.axis_u, shape.axis_u), 1e-37);
    vec3 beside = center - dot(center, axis) * shape.axis_u;
    vec3 across = offset - dot(offset, axis) * shape.axis_u;
    float plane = (dot(center, offset) - abs(dot(shape.axis_u, offset)) - length(offset) * wide)
        / dot(offset, offset);
    float mantle = (length(beside) - wide) * inversesqrt(max(dot(across, across), 1e-37));
    return clamp(max(plane, mantle), 0.0, 1.0);
}

// A point of a shape before the shading point.
ShapeSample sample_shape(ArealightGpuShape shape, vec3 position, inout RandomState random) {
    vec3 center = shape.center - position;
    if (shape.kind == SHAPE_TUBE) {
        return sample_tube(shape, center, random);
    }
    if (shape.kind == SHAPE_SPHERE) {
        return sample_sphere(shape, center, random);
    }
    return sample_ellipse(shape, center, random);
}

// Below, what a ray from the shading point meets, with the density with which sample_shape draws that: 0
// where it meets nothing that shines. `ray` is a unit vector.

const ShapeSample NO_SHAPE = ShapeSample(vec3(0.0), 0.0);

ShapeSample meet_ellipse(ArealightGpuShape shape, vec3 center, vec3 ray) {
    vec3 normal = arealight_normalize_or(cross(shape.axis_u, shape.axis_v), vec3(0.0));
    float distance = dot(normal, center) / dot(normal, ray);
    if (!(distance > 0.0 && distance < 1e30)) {
        return NO_SHAPE;
    }
    // Where in the ellipse's own axes the plane is met
    vec3 point = ray * distance - center;
    float uu = dot(shape.axis_u, shape.axis_u);
    float uv = dot(shape.axis_u, shape.axis_v);
    float vv = dot(shape.axis_v, shape.axis_v);
    vec2 along = vec2(dot(point, shape.axis_u), dot(point, shape.axis_v));
    vec2 place = vec2(along.x * vv - along.y * uv, along.y * uu - along.x * uv) / (uu * vv - uv * uv);
    float density = ellipse_density(shape, center, ray * distance, normal);
    return ShapeSample(ray * distance, dot(place, place) <= 1.0 ? density : 0.0);
}

ShapeSample meet_sphere(ArealightGpuShape shape, vec3 center, vec3 ray) {
    vec3 beside = cross(ray, center);
    bool inside = dot(center, center) <= shape.radius * shape.radius;
    bool met = inside || (dot(ray, center) > 0.0 && dot(beside, beside) <= shape.radius * shape.radius);
    float density = sphere_density(center, shape.radius, is_two_sided(shape));
    return ShapeSample(ray * sphere_distance(center, shape.radius, ray), met ? density : 0.0);
}

// The point at `distance`, from where the tube's outside is seen: as it is convex, a ray enters it once.
ShapeSample tube_point(ArealightGpuShape shape, vec3 ray, float distance, vec3 normal) {
    vec2 areas = tube_areas(shape);
    float density = area_density(ray * distance, normal, areas.x + areas.y, false, 0.0);
    return ShapeSample(ray * distance, distance > 0.0 ? density : 0.0);
}

ShapeSample meet_tube(ArealightGpuShape shape, vec3 center, vec3 ray) {
    float half_length = length(shape.axis_u);
    vec3 axis = shape.axis_u / half_length;
    float speed = dot(ray, axis);
    float height = -dot(center, axis);
    // The mantle, from outside of the endless cylinder
    vec3 across = ray - speed * axis;
    vec3 from = -center - height * axis;
    float a = dot(across, across);
    float b = dot(from, across);
    float c = dot(from, from) - shape.radius * shape.radius;
    float discriminant = b * b - a * c;
    if (c > 0.0 && discriminant > 0.0 && a > 0.0) {
        float distance = (-b - sqrt(discriminant)) / a;
        if (abs(height + distance * speed) <= half_length) {
            return tube_point(shape, ray, distance, (from + distance * across) / shape.radius);
        }
    }
    // The end that the ray comes from, or both half spheres
    if (int(shape.detail) == AREALIGHT_TUBE_FLAT && speed != 0.0) {
        float side = speed > 0.0 ? -1.0 : 1.0;
        float distance = (side * half_length - height) / speed;
        vec3 beside = from + distance * across;
        bool met = dot(beside, beside) <= shape.radius * shape.radius;
        return met ? tube_point(shape, ray, distance, side * axis) : NO_SHAPE;
    }
    if (int(shape.detail) == AREALIGHT_TUBE_ROUND) {
        for (float side = -1.0; side <= 1.0; side += 2.0) {
            vec3 middle = center + side * shape.axis_u;
            float approach = dot(middle, ray);
            float inside = approach * approach - dot(middle, middle) + shape.radius * shape.radius;
            float distance = approach - sqrt(max(inside, 0.0));
            vec3 normal = (ray * distance - middle) / shape.radius;
            if (inside > 0.0 && dot(normal, axis) * side >= 0.0 && dot(normal, ray) < 0.0) {
                return tube_point(shape, ray, distance, normal);
            }
        }
    }
    return NO_SHAPE;
}

// What multiplies the radiance of a shape that a ray from the shading point meets: its image, if it shows
// one. The ray has any length.
vec3 shape_color(ArealightGpuShape shape, vec3 position, vec3 ray) {
    if (shape.kind != SHAPE_DISK || shape.detail == AREALIGHT_NO_IMAGE) {
        return vec3(1.0);
    }
    vec3 center = shape.center - position;
    vec3 normal = cross(shape.axis_u, shape.axis_v);
    ArealightImage image = arealight_disk_image(shape.detail, shape.axis_u, shape.axis_v);
    return arealight_image_color(image, ray * (dot(normal, center) / dot(normal, ray)) - center);
}

ShapeSample meet_shape(ArealightGpuShape shape, vec3 position, vec3 ray) {
    vec3 center = shape.center - position;
    if (shape.kind == SHAPE_TUBE) {
        return meet_tube(shape, center, ray);
    }
    if (shape.kind == SHAPE_SPHERE) {
        return meet_sphere(shape, center, ray);
    }
    return meet_ellipse(shape, center, ray);
}

#endif
