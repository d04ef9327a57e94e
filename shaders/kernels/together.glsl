#ifndef TOGETHER_GLSL
#define TOGETHER_GLSL

// Reading what is the same for all items of a subgroup. GPUs read that once by themselves. A device that reads buffers item by item
// (lavapipe) is told how: each item reads another row of sixteen bytes, and takes the others from its neighbours.
//
// The kernels *_together define READ_TOGETHER as 1. They need subgroups of eight items or more, with votes and shuffles; and
// every item of a subgroup at each read, also items that have no pixel.
#ifndef READ_TOGETHER
#define READ_TOGETHER 0
#endif
const bool IS_TOGETHER = READ_TOGETHER != 0;

// Whether `condition` holds for this item; where items read together, whether for any of the subgroup, so that all go on.
bool any_together(bool condition) {
#if READ_TOGETHER
    return subgroupAny(condition);
#else
    return condition;
#endif
}

#if READ_TOGETHER

// The row, of `count` rows that the items of a subgroup read, that this item reads: `count` is a power of two, 8 at most.
uint row_to_read(uint count) {
    return gl_SubgroupInvocationID & (count - 1u);
}

#endif

#endif
