#version 450
// Writes each item; read.comp after it, without a barrier, is the hazard that the layer must report.
layout(local_size_x = 64) in;
layout(binding = 0) writeonly buffer Out { uint items[]; } to;

void main() {
    to.items[gl_GlobalInvocationID.x] = gl_GlobalInvocationID.x;
}
