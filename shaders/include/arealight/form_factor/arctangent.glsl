#ifndef AREALIGHT_ARCTANGENT_GLSL
#define AREALIGHT_ARCTANGENT_GLSL

#include "arealight/common.glsl"

// The angle of the point (x, y) from the x axis, in [-pi, pi]; 0 for the origin. The built-in function's
// precision is undefined.
//
// Error: 1.5e-8 of the angle before rounding, after it 4e-7 of the angle or of one radian, whichever is
// smaller. Squares and products are not taken, so that any size of x and y down to 1e-37 will do. Source:
// minimax polynomial of atan(r) / r in r^2 on [0, 1], by the exchange algorithm.
float arealight_arctangent(float y, float x) {
    float width = abs(x);
    float height = abs(y);
    float r = min(width, height) / max(max(width, height), 1e-37);
    float r2 = r * r;
    float high = 0.10640934 + r2 * (-0.075042733 + r2
                                    * (0.042691516 + r2 * (-0.016068627 + r2 * 0.0028498892)));
    float angle = r * (0.99999998 + r2 * (-0.33333073 + r2 * (0.19992619 + r2 * (-0.14203644 + r2 * high))));
    angle = height > width ? 0.5 * AREALIGHT_PI - angle : angle;
    angle = x < 0.0 ? AREALIGHT_PI - angle : angle;
    return y < 0.0 ? -angle : angle;
}

#endif
