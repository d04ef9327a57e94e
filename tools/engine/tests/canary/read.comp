#version 450
// Reads what write.comp wrote.
layout(local_size_x = 64) in;
layout(binding = 0) readonly buffer In { uint items[]; } from;
layout(binding = 1) writeonly buffer Out { uint items[]; } to;

void main() {
    to.items[gl_GlobalInvocationID.x] = from.items[gl_GlobalInvocationID.x] * 2u + 1u;
}
