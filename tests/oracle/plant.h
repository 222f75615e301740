// SPDX-License-Identifier: MIT
// A robot in a room, for the fuzz target: ARCOS session, wheels, watchdog, ideal sonars with faults, bumpers.
// It includes nothing of the firmware, and one run of it costs little.
#ifndef ORACLE_PLANT_H
#define ORACLE_PLANT_H

#include "safety.h"

typedef enum {
    PLANT_OK,
    PLANT_OFF,
    PLANT_SILENT,
    PLANT_NEAR,
    PLANT_FAR,
    PLANT_GARBAGE,
    PLANT_FAULTS
} plant_fault_t;

typedef struct {
    const double (*walls)[4]; // from x, y to x, y, mm
    unsigned wall_count;
    const safety_body_t *body;
    const char *subclass; // as it says it
    uint32_t now_ms;
    double x, y, th; // mm, radians
    double v, w;     // mm/s, rad/s
    double gap_mm, gap_used_mm;
    bool contact;
    double contact_v, contact_w; // how it came there
    double x0, y0, th0;
    // What it was told.
    double left_mm, heading, vel, rvel;
    bool moving, turning, motors, sonar_on, braking;
    double setv, accel, decel, setrv, setra;
    uint8_t port; // ADSEL
    int phase;    // 0..2 SYNC, 4 answered, 3 open
    uint32_t heard_ms, next_sip_ms, next_ping_ms;
    // What is wrong with it.
    uint8_t bumpers_front, bumpers_rear, stalls; // pressed besides those of a contact
    uint8_t touch_front, touch_rear;
    uint8_t fault[SAFETY_SONARS];
    uint32_t seed;
    // Sonars: what each array fires next, and what is not reported yet.
    uint8_t fires[4];
    int32_t pending[SAFETY_SONARS];
    // What it says.
    uint8_t out[1024];
    size_t out_length;
} plant_t;

void plant_init(plant_t *self, const safety_body_t *body, const char *subclass, const double (*walls)[4],
                unsigned wall_count, uint32_t now_ms);
void plant_step(plant_t *self); // 10 ms
void plant_take(plant_t *self, const uint8_t *packet, size_t length);
size_t plant_say(plant_t *self, uint8_t *packet, size_t capacity); // the next whole packet, 0: none
size_t plant_frame(uint8_t *packet, const uint8_t *data, size_t length);

#endif
