// SPDX-License-Identifier: MIT
// The link in memory.
#include "hal/fake_link.h"

#include <string.h>

void hal_fake_link_init(hal_fake_link_t *self, uint32_t seed, const hal_clock_t *clock) {
    memset(self, 0, sizeof *self);
    // The generator below cannot leave 0.
    self->random = seed == 0 ? 0x9E3779B9u : seed;
    self->clock = clock;
    self->failure = HAL_LINK_GONE;
}

static uint32_t draw(hal_fake_link_t *self) {
    self->random ^= self->random << 13;
    self->random ^= self->random >> 17;
    self->random ^= self->random << 5;
    return self->random;
}

static bool happens(hal_fake_link_t *self, uint16_t permille) {
    return permille > 0 && draw(self) % 1000u < permille;
}

static uint32_t now_ms(const hal_fake_link_t *self) {
    return self->clock == NULL ? 0 : hal_clock_now_ms(self->clock);
}

static void push(hal_fake_pipe_t *pipe, uint8_t byte, uint32_t due_ms) {
    if (pipe->count == HAL_FAKE_BYTES) {
        pipe->overflowed++;
        return;
    }
    const uint32_t at = (pipe->first + (uint32_t)pipe->count) % HAL_FAKE_BYTES;
    pipe->byte[at] = byte;
    pipe->due_ms[at] = due_ms;
    pipe->count++;
}

static void send(hal_fake_link_t *self, hal_fake_pipe_t *pipe, const hal_fake_faults_t *faults,
                 const uint8_t *bytes, size_t count) {
    const uint32_t due_ms = now_ms(self) + faults->delay_ms;
    for (size_t i = 0; i < count; i++) {
        uint8_t byte = bytes[i];
        if (faults->cut || happens(self, faults->drop_permille)) {
            pipe->dropped++;
            continue;
        }
        if (happens(self, faults->corrupt_permille)) {
            byte = (uint8_t)(byte ^ 1u << (draw(self) % 8u));
            pipe->corrupted++;
        }
        push(pipe, byte, due_ms);
    }
}

static size_t receive(hal_fake_link_t *self, hal_fake_pipe_t *pipe, uint8_t *bytes, size_t capacity) {
    const uint32_t now = now_ms(self);
    size_t count = 0;
    while (count < capacity && pipe->count > 0 && (int32_t)(now - pipe->due_ms[pipe->first]) >= 0) {
        bytes[count++] = pipe->byte[pipe->first];
        pipe->first = (uint16_t)((pipe->first + 1u) % HAL_FAKE_BYTES);
        pipe->count--;
    }
    return count;
}

size_t hal_fake_link_put(hal_fake_link_t *self, const uint8_t *bytes, size_t count) {
    const size_t room = (size_t)HAL_FAKE_BYTES - self->in.count;
    const size_t taken = count < room ? count : room;
    send(self, &self->in, &self->from_robot, bytes, taken);
    return taken;
}

size_t hal_fake_link_take(hal_fake_link_t *self, uint8_t *bytes, size_t capacity) {
    return receive(self, &self->out, bytes, capacity);
}

static int fake_read(void *context, uint8_t *bytes, size_t capacity) {
    hal_fake_link_t *const self = context;
    if (self->closed) {
        return HAL_LINK_NOT_OPEN;
    }
    self->reads++;
    if (self->fail_read_at != 0 && self->reads >= self->fail_read_at) {
        return self->failure;
    }
    const size_t most = self->read_max != 0 && self->read_max < capacity ? self->read_max : capacity;
    const size_t count = receive(self, &self->in, bytes, most);
    self->counters.bytes_in += (uint32_t)count;
    return (int)count;
}

static int fake_write(void *context, const uint8_t *packet, size_t count) {
    hal_fake_link_t *const self = context;
    if (self->closed) {
        return HAL_LINK_NOT_OPEN;
    }
    if (count > HAL_LINK_PACKET_MAX) {
        return HAL_LINK_TOO_LONG;
    }
    self->writes++;
    if (self->fail_write_at != 0 && self->writes >= self->fail_write_at) {
        return self->failure;
    }
    if (happens(self, self->would_block_permille) || count > (size_t)HAL_FAKE_BYTES - self->out.count) {
        self->counters.would_block++;
        return 0;
    }
    send(self, &self->out, &self->to_robot, packet, count);
    self->counters.bytes_out += (uint32_t)count;
    self->counters.writes++;
    return (int)count;
}

static int fake_flush(void *context) {
    const hal_fake_link_t *const self = context;
    return self->closed ? HAL_LINK_NOT_OPEN : 0;
}

static int fake_fd(const void *context) {
    (void)context;
    return -1;
}

static const char *fake_describe(const void *context) {
    (void)context;
    return "fake";
}

static const hal_link_counters_t *fake_counters(const void *context) {
    const hal_fake_link_t *const self = context;
    return &self->counters;
}

static void fake_close(void *context) {
    hal_fake_link_t *const self = context;
    self->closed = true;
}

hal_link_t hal_fake_link(hal_fake_link_t *self) {
    static const hal_link_ops_t ops = {.read = fake_read,
                                       .write = fake_write,
                                       .flush = fake_flush,
                                       .fd = fake_fd,
                                       .describe = fake_describe,
                                       .counters = fake_counters,
                                       .close = fake_close};
    return (hal_link_t){.ops = &ops, .context = self};
}
