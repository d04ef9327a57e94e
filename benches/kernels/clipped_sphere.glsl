#ifndef CLIPPED_SPHERE_GLSL
#define CLIPPED_SPHERE_GLSL

// The form factor of a sphere clipped at the receiver's horizon, in closed form: Snyder 1996, "Area light
// sources for real-time graphics"; Heitz 2017, "Geometric derivation of the irradiance of polygonal lights",
// whose tabulation engines read.
//
// `form_factor`: the sphere's own where it faces the receiver, (radius / distance)^2, in [0, 1]. `z`: the
// height of its center over its distance, in [-1, 1]. Returns a form factor in [0, 1].
float clipped_sphere(float form_factor, float z) {
    float s = sqrt(form_factor);
    if (z >= s) {
        return form_factor * z;
    }
    if (z <= -s) {
        return 0.0;
    }
    float q = sqrt(form_factor - z * z);
    float c = sqrt(1.0 - form_factor);
    return (form_factor * z * atan(q, -c * z) - c * q + atan(q, c)) / 3.1415927;
}

#endif
