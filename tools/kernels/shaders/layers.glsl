#ifndef LAYERS_GLSL
#define LAYERS_GLSL

// What layers of a surface reflect, and of light all around by sums: the reference has no table and no fit.
// The including kernel has the library's GGX, films and sheen.

// What facets under a film reflect over these reflectances; 1 without a film.
vec3 film_fresnel(ArealightThinFilm film, vec3 f0, float f90, vec3 view, vec3 half_vector) {
    if (!arealight_is_film(film)) {
        return vec3(1.0);
    }
    return arealight_thin_film_reflectance(film, f0, f90, clamp(dot(view, half_vector), 0.0, 1.0));
}

// What facets of these reflectances reflect of light before it reaches a Lambert lobe below; of a film the
// largest channel.
float above_lambert(vec2 reflectances, ArealightThinFilm film, vec3 view, vec3 half_vector) {
    if (arealight_is_film(film)) {
        vec3 fresnel = film_fresnel(film, vec3(reflectances.x), reflectances.y, view, half_vector);
        return min(arealight_max_component(fresnel), 1.0);
    }
    return mix(reflectances.x, reflectances.y, arealight_schlick_weight(view, half_vector));
}

// What such facets reflect of light all around: by 16 x 16 visible normals, to 1e-3.
float reflected(vec3 view, vec2 alpha, vec2 reflectances, ArealightThinFilm film) {
    const int SIDE = 16;
    float sum = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        vec3 light = arealight_ggx_sample(view, alpha, (vec2(i % SIDE, i / SIDE) + 0.5) / float(SIDE));
        float density = arealight_ggx_density(view, light, alpha);
        if (light.z > 0.0 && density > 0.0) {
            vec3 half_vector = arealight_normalize_or(view + light, vec3(0.0, 0.0, 1.0));
            sum += above_lambert(reflectances, film, view, half_vector)
                * arealight_ggx_evaluate(view, light, alpha, vec3(1.0), 1.0).x / density;
        }
    }
    return sum / float(SIDE * SIDE);
}

// Charlie's f cos for a colour of 1; 0 for light from below. The view's cosine is the frame's, from
// AREALIGHT_FORMULA_MIN_COS_VIEW on.
float sheen_evaluate(vec3 view, vec3 light, float roughness) {
    if (light.z <= 0.0) {
        return 0.0;
    }
    vec3 half_vector = arealight_normalize_or(view + light, vec3(0.0, 0.0, 1.0));
    float exponent = 1.0 / (roughness * roughness);
    float distribution = (2.0 + exponent)
        * pow(dot(half_vector.xy, half_vector.xy), 0.5 * exponent) / (2.0 * AREALIGHT_PI);
    float masking = 1.0 + arealight_sheen_masking(view.z, roughness)
        + arealight_sheen_masking(light.z, roughness);
    return distribution / (4.0 * view.z * masking);
}

// Charlie's albedo, by a midpoint rule of 32 x 24 nodes: to 1e-3.
float sheen_true_albedo(vec3 view, float roughness) {
    const int HEIGHTS = 32;
    const int AZIMUTHS = 24;
    float sum = 0.0;
    for (int i = 0; i < HEIGHTS; i++) {
        // Low light weighs most: z = t^3
        float t = (float(i) + 0.5) / float(HEIGHTS);
        float z = t * t * t;
        float radius = sqrt(1.0 - z * z);
        for (int j = 0; j < AZIMUTHS; j++) {
            float phi = AREALIGHT_PI * (float(j) + 0.5) / float(AZIMUTHS);
            sum += 3.0 * t * t * sheen_evaluate(view, vec3(radius * cos(phi), radius * sin(phi), z),
                                                roughness);
        }
    }
    return 2.0 * AREALIGHT_PI * sum / float(HEIGHTS * AZIMUTHS);
}

#endif
