#version 450
// Writes `offset` items beyond its own: with a large offset, outside of the buffer.
layout(local_size_x = 64) in;
layout(binding = 0) writeonly buffer Out { uint items[]; } to;
layout(push_constant) uniform Constants { uint offset; };

void main() {
    to.items[gl_GlobalInvocationID.x + offset] = 1u;
}
