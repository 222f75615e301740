// SPDX-License-Identifier: MIT
// What Argus tells the rest of the vehicle over CAN, and the orders it takes from there (SPEC.md, CAN).
//
// Pure: frames go out and in as bytes, time comes in; sockets are the caller's business.
#ifndef HAL_CAN_TELEMETRY_H
#define HAL_CAN_TELEMETRY_H

#include "argus/argus.h"
#include "hal/gen_argus_dbc.h"

#define HAL_TELEMETRY_PERIOD_MS 1000u // of every frame that nothing else makes due
#define HAL_TELEMETRY_CHANGE_MS 200u  // health and plan: at most one frame in this time
#define HAL_TELEMETRY_READING_MS 90u  // readings: likewise, less than the 100 ms of a SIP
#define HAL_TELEMETRY_ALL_MS 200u     // readings of a server that lists all in every SIP
#define HAL_TELEMETRY_EDGE_MS 250u    // emergencies: one in this time
#define HAL_TELEMETRY_EDGE_BURST 8u   // ... after so many at once
#define HAL_TELEMETRY_EDGE_QUEUE 32u  // that wait; the oldest is dropped, which a gap in Roll tells
#define HAL_TELEMETRY_NONCE_MS 2000u  // how long a nonce is good
#define HAL_TELEMETRY_NONCES 3u       // heartbeats in that time

#define HAL_TELEMETRY_FRAMES 8u // that repeat, of a robot with up to 16 sonars
#define HAL_TELEMETRY_UPPER 6u  // more of one that has 32
#define HAL_TELEMETRY_SLOTS (HAL_TELEMETRY_FRAMES + (ARGUS_SONARS > 16 ? HAL_TELEMETRY_UPPER : 0u))

typedef struct {
    uint16_t id;
    uint8_t length;
    uint8_t data[HAL_DBC_LENGTH];
} hal_telemetry_frame_t;

// Why an order was refused. X(NAME, text).
#define HAL_TELEMETRY_REFUSAL_TABLE(X)                                          \
    X(LENGTH, "its length is not 8")                                            \
    X(RESERVED, "a reserved bit is set")                                        \
    X(CRC, "its CRC is wrong")                                                  \
    X(UNKNOWN_NONCE, "its nonce is not that of a heartbeat of the last 2 s")    \
    X(USED_NONCE, "its nonce, or a later one, was used: repeated or overtaken") \
    X(ORDER, "no such order, or no such sonar")

typedef enum {
    HAL_TELEMETRY_TAKEN,
#define HAL_TELEMETRY_REFUSAL_ENUM(name, text) HAL_TELEMETRY_BAD_##name,
    HAL_TELEMETRY_REFUSAL_TABLE(HAL_TELEMETRY_REFUSAL_ENUM)
#undef HAL_TELEMETRY_REFUSAL_ENUM
        HAL_TELEMETRY_VERDICTS
} hal_telemetry_verdict_t;

const char *hal_telemetry_verdict_text(hal_telemetry_verdict_t verdict);

typedef enum { HAL_TELEMETRY_NEVER, HAL_TELEMETRY_GOOD, HAL_TELEMETRY_USED } hal_telemetry_use_t;

typedef struct {
    uint16_t value;
    uint32_t sent_ms;
    hal_telemetry_use_t use; // USED: it, or a later one, served an order
} hal_telemetry_nonce_t;

// One of the frames that repeat.
typedef struct {
    uint8_t data[HAL_DBC_LENGTH]; // as sent last
    uint32_t sent_ms;
    uint32_t wait_ms; // after the last one, as things are now
    bool ever;
} hal_telemetry_sent_t;

typedef struct {
    uint8_t robot;
    uint8_t sonars; // that have frames: 16 at least
    uint32_t stale_ms;
    uint32_t second_ms; // uptime is counted in whole seconds, over the wrap of the clock
    uint32_t uptime_s;
    hal_telemetry_sent_t sent[HAL_TELEMETRY_SLOTS]; // by how far its id lies from the first
    uint32_t readings[ARGUS_SONARS];                // of each sonar, as of its last frame
    uint8_t roll;
    uint8_t plan_roll;
    uint8_t edge_roll;
    uint8_t edges; // that may go at once
    uint32_t edge_ms;
    argus_mask_t alarmed;  // sonars about which an emergency went out
    argus_mask_t injected; // those whose fault is made for a test; the caller sets it, 0 on a board
    bool link_alarmed;
    uint8_t queue_head;
    uint8_t queued;
    hal_telemetry_frame_t queue[HAL_TELEMETRY_EDGE_QUEUE];
    uint32_t key; // of the permutation by which numbers become nonces
    uint16_t number;
    uint8_t newest; // nonce
    hal_telemetry_nonce_t nonce[HAL_TELEMETRY_NONCES];
    uint32_t verdicts[HAL_TELEMETRY_VERDICTS]; // monotonic
} hal_telemetry_t;

// A reading older than `stale_ms` is sent as old. `seed` should differ from start to start. Nonces do not
// repeat for 65,536 heartbeats.
void hal_telemetry_init(hal_telemetry_t *self, uint8_t robot, uint32_t stale_ms, uint64_t seed,
                        uint32_t now_ms);

// Ids on the bus for this robot.
uint16_t hal_telemetry_command_id(const hal_telemetry_t *self);

// An event of the manager; an edge becomes an emergency frame.
void hal_telemetry_event(hal_telemetry_t *self, const argus_status_t *status, const argus_event_t *event);

// The next frame that is due, emergencies first; false: none now. It counts as sent.
bool hal_telemetry_next(hal_telemetry_t *self, const argus_status_t *status, uint32_t now_ms,
                        hal_telemetry_frame_t *frame);

// A last heartbeat; its state says that argusd ends.
void hal_telemetry_farewell(hal_telemetry_t *self, const argus_status_t *status, uint32_t now_ms,
                            hal_telemetry_frame_t *frame);

// Ms until a frame is due by time, at most HAL_TELEMETRY_PERIOD_MS.
uint32_t hal_telemetry_due_ms(const hal_telemetry_t *self, uint32_t now_ms);

// A frame on the command id. HAL_TELEMETRY_TAKEN: `order` is to be carried out, its nonce is used up.
hal_telemetry_verdict_t hal_telemetry_take(hal_telemetry_t *self, const uint8_t *data, size_t length,
                                           uint32_t now_ms, hal_dbc_command_t *order);

uint32_t hal_telemetry_refused(const hal_telemetry_t *self); // frames on the command id, monotonic

// CRC-16/CCITT-FALSE over the id (low byte first) and the first 6 bytes.
uint16_t hal_telemetry_crc(uint16_t id, const uint8_t data[HAL_DBC_LENGTH]);

#endif
