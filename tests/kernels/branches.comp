#version 450

// What can happen to a branch by a specialisation constant, for what leaves such branches out before a driver
// sees them. Each case writes a number of its own; tests/tests/gpu/prune.rs knows them.

layout(local_size_x = 8) in;

layout(constant_id = 0) const uint FLAGS = 0u;
layout(constant_id = 1) const int LEVEL = 0;
layout(constant_id = 2) const bool SWITCH = true;

layout(set = 0, binding = 0, std430) readonly buffer Arguments {
    uint arguments[];
};
layout(set = 0, binding = 1, std430) writeonly buffer Results {
    uint results[];
};
layout(push_constant, std430) uniform Constants {
    uint count;
} constants;

const uint ONE = 1u;
const uint TWO = 2u;

struct Choice {
    uint flags;
    int level;
};

// A parameter that is only read.
uint by_flags(uint x, uint flags) {
    uint sum = x;
    if ((flags & ONE) != 0u) {
        sum += 10u;
    }
    if ((flags & TWO) != 0u && x > 2u) {
        sum += 100u;
    }
    return sum;
}

// A parameter that is written, though by a constant it looks as if it were not.
uint by_changed_flags(uint x, uint flags) {
    if (x > 3u) {
        flags ^= ONE;
    }
    return (flags & ONE) != 0u ? x + 1u : x + 1000u;
}

// Nobody gets beyond the branch.
uint by_return(uint x) {
    if ((FLAGS & ONE) != 0u) {
        return x * 3u;
    } else {
        return x * 5u;
    }
}

// A loop that a constant leaves, and one whose condition it is.
uint by_loop(uint x) {
    uint sum = 0u;
    for (uint i = 0u; i < x; i++) {
        if (LEVEL == 1 && i == 2u) {
            break;
        }
        if (LEVEL == 2) {
            continue;
        }
        sum += i + 1u;
    }
    do {
        sum += 7u;
        if ((FLAGS & TWO) != 0u) {
            return sum;
        }
    } while (LEVEL == 3 && sum < 100u);
    return sum;
}

// A struct, of which a member is changed on the way.
Choice changed(Choice choice) {
    if (choice.level == 2) {
        choice.level = 1;
    }
    return choice;
}
Choice replaced(Choice choice) {
    return Choice(choice.flags | ONE, choice.level == 2 ? 1 : choice.level);
}
uint by_choice(uint x, Choice choice) {
    return choice.level == 1 ? by_flags(x, choice.flags) : x + 20000u;
}

// Written through a pointer by whom it is given to.
void write(inout uint flags, uint x) {
    if (x % 2u == 0u) {
        flags = 0u;
    }
}
uint by_pointer(uint x) {
    uint flags = FLAGS;
    write(flags, x);
    return by_flags(x, flags);
}

// Written twice, and once in a branch.
uint by_variable(uint x) {
    uint flags = ONE;
    if (x > 4u) {
        flags = TWO;
    }
    uint array[2] = uint[](FLAGS, 0u);
    array[x & 1u] = x;
    return by_flags(x, flags) + by_flags(x, array[0]);
}

uint by_switch(uint x) {
    uint sum = x;
    switch (LEVEL) {
    case 0:
        sum += 1u;
        break;
    case 1:
        sum += 2u;
        if (x > 3u) {
            break;
        }
        sum += 4u;
    default:
        sum += 8u;
    }
    return sum;
}

// Both outcomes, one in the other, decided by different constants.
uint by_nesting(uint x) {
    bool is_set = SWITCH ? (FLAGS & ONE) != 0u : LEVEL > 1;
    uint sum = is_set ? x : x + 7u;
    if (is_set) {
        if (SWITCH) {
            sum += 50u;
        } else if (LEVEL == 3) {
            sum += 60u;
        } else {
            sum += 70u;
        }
    }
    return sum;
}

void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item >= constants.count) {
        return;
    }
    uint x = arguments[item];
    Choice choice = Choice(FLAGS, LEVEL);
    uint[10] sums;
    sums[0] = by_flags(x, FLAGS);
    sums[1] = by_flags(x, FLAGS ^ ONE) + by_changed_flags(x, FLAGS);
    sums[2] = by_return(x);
    sums[3] = by_loop(x);
    sums[4] = by_choice(x, changed(choice));
    sums[5] = by_choice(x, replaced(choice));
    sums[6] = by_pointer(x);
    sums[7] = by_variable(x);
    sums[8] = by_switch(x);
    sums[9] = by_nesting(x);
    for (uint i = 0u; i < 10u; i++) {
        results[item * 10u + i] = sums[i];
    }
}
