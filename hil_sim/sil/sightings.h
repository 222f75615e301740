// SPDX-License-Identifier: MIT
// What SIPs say, and the truth, in columns (sightings.py): C and Python write the same memory.
#ifndef ARGUS_SIM_SIGHTINGS_H
#define ARGUS_SIM_SIGHTINGS_H

#include "../robot/report.h"

enum { SIGHTINGS = 512, SEEN_READINGS = 8192, ON_THE_LINE = 64 };

// t_ms to count: as the SIP was made; first: its readings, counted from the beginning of the mission. The
// rest: as it was taken.
typedef struct {
    double t_ms, x, y, heading;
    int64_t first;
    int32_t count, mode;
    double true_x, true_y, th, travelled_mm, v, w;
} sighting_t;

typedef struct {
    sighting_t row;
    int32_t length;
    uint8_t packet[FRAME_MAX];
} sent_t;

// base: readings that were taken out before those that are here. sent: SIPs on the line, from first on.
typedef struct {
    int64_t rows_count, readings_count, base, first, count;
    sighting_t rows[SIGHTINGS];
    reading_t readings[SEEN_READINGS];
    sent_t sent[ON_THE_LINE];
} sightings_t;

bool argus_sim_sightings_have_room(const sightings_t *seen);

// A SIP is made, whose readings the ring still has: what it says, at its time.
sighting_t argus_sim_sighting(sightings_t *seen, const parts_t *parts);

// It goes on the line.
void argus_sim_sighting_sent(sightings_t *seen, const sighting_t *made, const uint8_t *packet,
                             int32_t length);

// The fault manager has taken a packet; whether a SIP was it, which is then the last row.
bool argus_sim_sighting_taken(sightings_t *seen, const parts_t *parts, int32_t mode, const uint8_t *packet,
                              int32_t length);

#endif
