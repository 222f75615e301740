// SPDX-License-Identifier: MIT
// The ray log: where the sonars in use have looked lately, along what, and how far it was free.
#ifndef ARGUS_RAYS_H
#define ARGUS_RAYS_H

#include "knowledge/knowledge.h"

#define ARGUS_RAYS_MAX 128      // some 5 s of one array
#define ARGUS_RAY_TRUST_MM 2000 // no reading tells of more: a thin thing beyond may give no echo
#define ARGUS_RAY_BESIDE_MM 40  // seen beside the cone, close to the transducer

// From the transducer, course frame; `c`, `s`: the direction, scaled by ARGUS_TRIG_ONE.
typedef struct {
    int16_t x_mm;
    int16_t y_mm;
    int16_t c;
    int16_t s;
    uint16_t free_mm : 11;
    uint16_t sonar : 5;
    uint16_t t_ms; // modulo 65,536: no ray lies longer before the one after it than it counts
} argus_ray_t;

typedef struct {
    uint32_t newest_ms;
    uint8_t count;
    uint8_t next; // oldest, once full
    argus_ray_t at[ARGUS_RAYS_MAX];
} argus_rays_t;

// Logs the fresh readings of the sonars that look ahead or abeam and are trusted: neither out nor named.
// `others`: sonars of a sweep, which look along blind bearings now.
void argus_rays_see(argus_rays_t *self, const argus_knowledge_t *knowledge, argus_mask_t others);

// Takes back what a sonar has seen: it has failed. And all of it: the robot may have been carried.
void argus_rays_forget(argus_rays_t *self, int sonar);
void argus_rays_forget_all(argus_rays_t *self);

// How far ahead of the body, up to `most_mm`, the corridor of 2 x `half_mm` along its heading has been seen
// in the last seconds. Each place of it lay within the cone of a trusted sonar and nearer than its echo.
// Cost: 7 places for each 80 mm; for each the ray that showed the one before it, else up to 128 rays.
int32_t argus_rays_seen_mm(const argus_rays_t *self, const argus_knowledge_t *knowledge, int32_t half_mm,
                           int32_t most_mm);

#endif
