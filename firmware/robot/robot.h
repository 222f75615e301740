// SPDX-License-Identifier: MIT
// Which robots are known, and what the data of one says.
#ifndef ARGUS_ROBOT_H
#define ARGUS_ROBOT_H

#include "arcos/gen_arcos.h"
#include "robot/table.h"

// The robot that is assumed while none is known (p3dx-sh), and one of which nothing is known: no sonars.
const argus_robot_t *argus_robot_default(void);
const argus_robot_t *argus_robot_unknown(void);

// The robot of a subclass as it is announced, in any letter case; NULL: not known. "p3dx" is the body of the
// P3-DX with the older controller. `subclass` ends with 0 within 32 bytes.
const argus_robot_t *argus_robot_find(const char *subclass);

// The robot that the setting `robot` names; NULL for 0 (by subclass) and beyond the table.
const argus_robot_t *argus_robot_chosen(int32_t choice);

// ... and the value that names it, 0 for the unknown one and for one of the caller's own.
uint8_t argus_robot_choice(const argus_robot_t *self);

// Not of the table, and known nonetheless.
bool argus_robot_is_own(const argus_robot_t *self);

bool argus_robot_is_known(const argus_robot_t *self);

// The same robot with its other end ahead: the rear of one as it is built, and back; NULL: it has none that
// could lead. And the robot as it is built.
const argus_robot_t *argus_robot_other_end(const argus_robot_t *self);
const argus_robot_t *argus_robot_built(const argus_robot_t *self);

// From the heading of the robot as it is built to that of the end that leads: 0 or 18000.
int32_t argus_robot_facing_cdeg(const argus_robot_t *self);

// Sonars that are managed: those that it has, at most ARGUS_SONARS.
int argus_robot_sonars(const argus_robot_t *self);

// Where a sonar sits and looks, in the frame of the end that leads. 0 <= sonar < argus_robot_sonars().
argus_sonar_pose_t argus_robot_pose(const argus_robot_t *self, int sonar);

// The sonar mounted to the left (or right) of one that faces forward; -1: none, or it does not face forward.
int argus_robot_beside(const argus_robot_t *self, int sonar, bool left);

// The array that fires a sonar, from 0.
static inline int argus_robot_array_of(const int sonar) {
    return sonar / ARCOS_TIMING_TRANSDUCERS_PER_ARRAY;
}

// Masks over the sonars that are managed.
argus_mask_t argus_robot_all(const argus_robot_t *self);
argus_mask_t argus_robot_forward(const argus_robot_t *self);
argus_mask_t argus_robot_ahead(const argus_robot_t *self);
argus_mask_t argus_robot_astern(const argus_robot_t *self);
argus_mask_t argus_robot_flank(const argus_robot_t *self);
argus_mask_t argus_robot_rear_flank(const argus_robot_t *self);
argus_mask_t argus_robot_array(const argus_robot_t *self, int array);
argus_mask_t argus_robot_polled(const argus_robot_t *self);  // all of the arrays of those that face forward
argus_mask_t argus_robot_leading(const argus_robot_t *self); // ... without those that look astern
argus_mask_t argus_robot_looking(const argus_robot_t *self); // that may cover for others
argus_mask_t argus_robot_sectors(const argus_robot_t *self); // of a laser's scan
static inline bool argus_robot_is_sector(const argus_robot_t *const self, const int sonar) {
    return ARGUS_LASER && (self->sector_mask >> sonar & 1u) != 0;
}
bool argus_robot_faces_forward(const argus_robot_t *self, int sonar);
bool argus_robot_looks_ahead(const argus_robot_t *self, int sonar); // it, or one of another deck

// That a sonar sees, or a sector of a laser's scan.
int32_t argus_robot_cone_deg(const argus_robot_t *self, int sonar);

// Half of its width, mm, rounded up.
int32_t argus_robot_half_width_mm(const argus_robot_t *self);

#endif
