// SPDX-License-Identifier: MIT
// A robot as const data: body, swing circle, where its sonars look and what each is for.
#ifndef ARGUS_ROBOT_TABLE_H
#define ARGUS_ROBOT_TABLE_H

#include "argus/argus.h"
#include "robot/gen_sizes.h"

_Static_assert(ARGUS_SONARS % 8 == 0 && ARGUS_SONARS >= 8 && ARGUS_SONARS <= 32, "8, 16, 24 or 32");

// Only builds that manage more than 16 sensors know a laser.
#define ARGUS_LASER (ARGUS_SONARS > 16)

// Where and whither a sonar looks, robot frame.
typedef struct {
    int16_t x_mm;
    int16_t y_mm;
    int16_t heading_deg; // counter-clockwise, 0 = ahead
} argus_sonar_pose_t;

// One row of hil_sim/tables/robots, which has the source of each figure, or a robot of the caller's own. One
// with a rear array has a second row, the robot turned by 180 degrees: what holds while its rear leads. What
// else belongs to it is found from its own place, so that a row is the same in flash and in the caller's
// memory.
struct argus_robot {
    char name[ARGUS_ROBOT_NAME_MAX]; // the subclass that it announces at SYNC2
    int8_t other;                    // rows from here to its other end, 0: none
    bool reversed;                   // the rear leads
    int16_t poses;                   // bytes from here to the poses of its sonars, as it is built
    uint8_t sonars;                  // that it has; argus_robot_sonars() of them are managed
    uint8_t arrays;
    uint8_t front_bumpers; // segments, 0: no bumper
    uint8_t rear_bumpers;
    uint8_t forward_count;
    uint8_t forward[ARGUS_FORWARD_MAX]; // the forward-facing sonars, left to right; the paper's six
    argus_mask_t forward_mask;          // of those that are managed, like the other masks
    argus_mask_t ahead_mask;            // those that see what the robot drives into
    argus_mask_t astern_mask;
    argus_mask_t flank_mask;      // those that look abeam from ahead of the centre
    argus_mask_t rear_flank_mask; // ... from behind it
    argus_mask_t sector_mask;     // those that are sectors of a laser's scan
    int16_t sector_deg;           // ... so wide each
    int16_t front_mm;             // from the centre of rotation to the ends of the body
    int16_t rear_mm;
    int16_t width_mm;
    int16_t swing_radius_mm;     // to the farthest corner of the body
    int16_t sonar_face_mm;       // x of the foremost transducers
    int16_t rear_overhang_mm;    // of the body beyond those that look astern head-on
    int16_t deck_behind_mm;      // of an upper deck: its foremost faces are so far behind those
    int16_t pitch_deg;           // between two neighbours of the forward-facing ones, mean
    int16_t tolerance_centre_mm; // a2 of the paper's eq. 2
    uint32_t tolerance_excess;   // 1 / cos of the widest angle between neighbours, less 1, in 2^-32
    int16_t decel_mm_s2;         // that the robot brakes with unless set otherwise
    int16_t track_mm;
    int16_t dist_conv_um; // what one unit of position is
    int16_t min_mm;       // readings are from here to no_echo_mm, which says that nothing was heard
    int16_t no_echo_mm;
    int16_t cone_deg;
    int16_t cycle_ms; // between two pings of one array
};

// ARGUS_ROBOTS as they are built, then their other ends; and the sonars of those as they are built.
typedef struct {
    argus_robot_t robots[ARGUS_ROBOT_ROWS];
    argus_sonar_pose_t poses[ARGUS_ROBOT_POSES];
} argus_robot_table_t;

extern const argus_robot_table_t argus_robot_table;

// A robot of the caller's own, its other end, and its sonars.
typedef struct {
    argus_robot_t rows[2];
    argus_sonar_pose_t poses[ARGUS_SONARS];
} argus_own_robot_t;

#endif
