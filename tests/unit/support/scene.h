// SPDX-License-Identifier: MIT
// A room, a robot that follows a tour in it and sonars with faults: SIPs for the tests of the evidence.
#ifndef TEST_SCENE_H
#define TEST_SCENE_H

#include "awareness/evidence.h"

#define SCENE_WALLS_MAX 64
#define SCENE_PAST 8

typedef struct {
    argus_fault_kind_t kind;
    int value; // wrong: percent; slow: firings; intermittent: percent; stuck: mm, 0: as it read
} scene_fault_t;

typedef struct {
    argus_knowledge_t k;
    argus_evidence_t e;
    uint32_t start_ms;
    uint32_t t_ms;   // since the start
    double x, y, th; // mm, radians
    double v_mm_s, w_rad_s;
    double wall[SCENE_WALLS_MAX][4];
    int walls;
    double person_x, person_y, person_r; // no person: radius 0
    double person_vx, person_vy;
    double smooth_deg; // an echo from a wall is lost beyond this incidence, 0: never
    int noise_mm;      // standard deviation
    int crosstalk_permille;
    scene_fault_t fault[ARGUS_SONARS];
    scene_fault_t coming; // begins 200 mm into the next drive
    int coming_to;
    int bent_deg[ARGUS_SONARS];
    unsigned mute; // sonars that yield nothing in their slots
    uint32_t seed;
    // inside
    int next;
    int pending[ARGUS_SONARS];
    int past[ARGUS_SONARS][SCENE_PAST];
    int stuck_mm[ARGUS_SONARS];
    // what the evidence came to
    argus_fault_kind_t convicted[ARGUS_SONARS]; // first kind
    uint32_t convicted_ms[ARGUS_SONARS];
    uint16_t named;   // ever
    char broken[160]; // a bound that did not hold
} scene_t;

void scene_init(scene_t *self, uint32_t seed, uint32_t start_ms); // in the open, at rest, no noise
void scene_box(scene_t *self, double x1, double y1, double x2, double y2);
void scene_office(scene_t *self); // a room of 6 by 5 m with things in it, noise and crosstalk of 1 %
void scene_run(scene_t *self, uint32_t ms);
void scene_turn(scene_t *self, double deg); // at 60 degrees/s, then settles
void scene_look(scene_t *self);             // the looks of an inquiry, back to the heading
void scene_drive(scene_t *self, double mm); // at 200 mm/s, but not into a wall
void scene_inject(scene_t *self, int sonar, argus_fault_kind_t kind, int value); // in the next drive
void scene_tour(scene_t *self, int legs);
void scene_say(scene_t *self, unsigned sonars, const int *reading_mm); // one SIP by hand
bool scene_all_quiet(const scene_t *self);                             // none was ever convicted
void scene_blank(argus_knowledge_t *k, argus_evidence_t *e);           // all HEALTHY, nothing seen
uint32_t scene_random(scene_t *self, uint32_t below);
const char *scene_text(const scene_t *self); // seed and convictions, for a message

#endif
