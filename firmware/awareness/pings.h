// SPDX-License-Identifier: MIT
// The ping log: what each sonar lately heard, from where and on which bearing.
#ifndef ARGUS_PINGS_H
#define ARGUS_PINGS_H

#include "awareness/numbers.h"
#include "knowledge/knowledge.h"

// One reading: where the transducer was and looked when its ping was sent, about, course frame. Time and
// place modulo 65,536 ms and mm.
typedef struct {
    uint16_t t_ms;
    uint16_t x_mm;
    uint16_t y_mm;
    int16_t bearing_cdeg;
    uint16_t reading_mm; // ARGUS_NO_ECHO_MM: heard nothing
    uint8_t repeats;     // further ones that were alike, from the same place, the last at t_ms
    uint8_t steady : 1;  // the robot did not rotate in this SIP nor in the one before
    uint8_t rest : 1;    // it stood
    uint8_t weighed : 1; // others have judged it
    uint8_t counted : 1; // ... and it was news
} argus_ping_t;

typedef struct {
    uint8_t next;
    uint8_t count;
    uint32_t looked[ARGUS_PING_SECTORS]; // the pings that looked into a sector, a bit each
    argus_ping_t ping[ARGUS_PINGS];
} argus_pings_t;

// One more. What a robot at rest hears again and again is one ping, from the first place, of the last
// reading.
void argus_pings_note(argus_pings_t *self, argus_ping_t now);

// Drops what is older than ARGUS_PINGS_AGE_MS; to be called at least every 20 s.
void argus_pings_age(argus_pings_t *self, uint32_t now_ms);

// The ping so far back (1: the last); the one a firing was so many firings before it. NULL: not so many.
const argus_ping_t *argus_pings_at(const argus_pings_t *self, int back);
const argus_ping_t *argus_pings_before(const argus_pings_t *self, int back, int firings);
argus_ping_t *argus_pings_mark(argus_pings_t *self, int back); // 1 <= back <= count

int32_t argus_ping_age_ms(const argus_ping_t *self, uint32_t now_ms); // 0 to 65535
static inline bool argus_ping_is_echo(const argus_ping_t *const self) {
    return self->reading_mm < ARGUS_NO_ECHO_MM;
}

// From one to the other: way between the transducers, and turn, 0 to 18000.
int32_t argus_ping_moved_mm(const argus_ping_t *a, const argus_ping_t *b);
int32_t argus_ping_turned_cdeg(const argus_ping_t *a, const argus_ping_t *b);

// How far ahead of `then` on its own bearing `now` was made, and how far beside it (no sign).
typedef struct {
    int32_t along_mm;
    int32_t lateral_mm;
} argus_shift_t;
argus_shift_t argus_ping_shift(const argus_ping_t *now, const argus_ping_t *then);

// The same of one ping beside many: its direction, and the sectors that hold what is beside it, are worked
// out once.
typedef struct {
    const argus_ping_t *ping;
    int32_t cos;
    int32_t sin;
    uint8_t sector[2];
} argus_line_t;
argus_line_t argus_ping_line(const argus_ping_t *self);
argus_shift_t argus_line_shift(const argus_line_t *line, const argus_ping_t *then);

// The pings that may be on the bearing of a line or beside it, a bit each: the highest is the last one.
static inline uint32_t argus_pings_beside(const argus_pings_t *const self, const argus_line_t *const line) {
    _Static_assert(ARGUS_PINGS == 32, "a bit for each");
    const uint32_t slots = self->looked[line->sector[0]] | self->looked[line->sector[1]];
    if (slots == 0 || self->count == 0) {
        return 0;
    }
    const uint32_t all = slots >> self->next | slots << (ARGUS_PINGS - self->next) % ARGUS_PINGS;
    return all & UINT32_MAX << (ARGUS_PINGS - self->count);
}

// The last of them that is on the bearing of the line or beside it (BESIDE_CDEG), and from about its place
// (SAME_ALONG_MM): how far back it lies, and only older ones are left. 0: none.
int argus_pings_near(const argus_pings_t *self, uint32_t *left, const argus_line_t *line);

// What `then` would read from the place of `now`, of a thing that stands.
int32_t argus_ping_predict_mm(const argus_ping_t *now, const argus_ping_t *then);

// Both within `mm` of each other along x and along y.
bool argus_ping_is_within(const argus_ping_t *a, const argus_ping_t *b, int32_t mm);

// Whether the reading of `now` goes on from that of `then`, as a standing thing seen by a robot that does not
// turn.
bool argus_ping_goes_on(const argus_ping_t *now, const argus_ping_t *then);

// The ping of a sonar from a pose of the robot, its reading left open.
argus_ping_t argus_ping_from(const argus_robot_t *robot, int sonar, const argus_pose_t *pose);

#endif
