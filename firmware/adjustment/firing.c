// SPDX-License-Identifier: MIT
// Shares the slots of a firing order.
#include "adjustment/firing.h"

// The forward-facing sonars in use, and every other one of the rest of their arrays: these watch the swing
// circle.
static size_t add_half(const argus_knowledge_t *const knowledge, const int half, uint8_t *const order) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    ARGUS_ASSERT(half == 0 || half == 1);
    const argus_robot_t *const robot = knowledge->robot;
    const unsigned others = argus_robot_polled(robot) & ~(unsigned)argus_robot_forward(robot);
    size_t count = 0;
    int other = 0;
    for (int i = 0; i < knowledge->sonars; i++) {
        if (argus_robot_faces_forward(robot, i) && !argus_is_out(knowledge, i)) {
            order[count++] = (uint8_t)(i + 1);
        }
    }
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((others >> i & 1u) != 0 && other++ % 2 == half) {
            order[count++] = (uint8_t)(i + 1);
        }
    }
    return count;
}

void argus_firing_share(argus_firing_t *const self, const argus_knowledge_t *const knowledge,
                        const bool tries, argus_outbox_t *const out, const uint32_t now_ms) {
    uint8_t order[ARCOS_TIMING_ARRAYS_MAX * ARCOS_TIMING_POLLING_MAX_PER_ARRAY];
    size_t count = add_half(knowledge, 0, order);
    count += add_half(knowledge, 1, order + count);
    for (int i = 0; tries && i < knowledge->sonars; i++) {
        if (argus_robot_faces_forward(knowledge->robot, i) && argus_is_out(knowledge, i)) {
            order[count++] = (uint8_t)(i + 1);
        }
    }
    ARGUS_ASSERT(count <= sizeof order);
    argus_outbox_string(out, ARCOS_CMD_POLLING, order, count);
    self->ordered = true;
    self->ordered_ms = now_ms;
}
