// SPDX-License-Identifier: MIT
// The main task: a course of waypoints, and a way round what stands in it.
#ifndef ARGUS_TASK_H
#define ARGUS_TASK_H

#include "argus/argus.h"
#include "knowledge/knowledge.h"

#define ARGUS_POINTS_MAX 128

// Echoes seen lately, course frame: what the way round an obstacle is planned from.
typedef struct {
    int16_t x_mm;
    int16_t y_mm;
    uint8_t sonar;
    bool again; // by two echoes at least: one may be crosstalk
    uint32_t seen_ms;
} argus_seen_t;

typedef struct {
    argus_point_t waypoint[ARGUS_WAYPOINTS_MAX];
    uint16_t count;
    uint16_t next;
    argus_seen_t seen[ARGUS_POINTS_MAX];
    uint16_t seen_count;
    uint16_t seen_next; // oldest, once full
    bool avoiding;
    int8_t side;       // +1 left, -1 right, 0 none chosen yet
    argus_point_t leg; // where the robot now heads for
    bool has_leg;
    int32_t refused_cdeg[8]; // headings found blocked in this place
    uint8_t refused;
    bool slanted; // into a wall beside it, on this heading: refused after waiting, too
    int32_t slanted_cdeg;
    argus_point_t refused_at;
} argus_task_t;

void argus_task_init(argus_task_t *self);
bool argus_task_set(argus_task_t *self, const argus_point_t *points, uint16_t count);

// Remembers the fresh echoes of sonars not DISABLED; forgets those of a sonar; marks a place that a bumper
// hit.
void argus_task_see(argus_task_t *self, const argus_knowledge_t *knowledge, uint32_t now_ms);
void argus_task_forget(argus_task_t *self, int sonar);
void argus_task_bumped(argus_task_t *self, const argus_knowledge_t *knowledge, uint32_t now_ms);

// Passes every waypoint that is near enough; true when the goal itself is reached. `passed` counts waypoints
// passed now.
bool argus_task_progress(argus_task_t *self, const argus_knowledge_t *knowledge, const argus_config_t *config,
                         int *passed);

int32_t argus_task_goal_mm(const argus_task_t *self, const argus_knowledge_t *knowledge);

// Half of what is driven straight along, ahead or back, without a turn: half the body, and something for its
// heading.
int32_t argus_task_straight_half_mm(const argus_robot_t *robot);

// Length of the corridor of 2 x half_mm that is free of remembered echoes along a heading; INT32_MAX without
// any.
int32_t argus_task_clear_mm(const argus_task_t *self, const argus_knowledge_t *knowledge,
                            int32_t heading_cdeg, int32_t half_mm);

// Whether two echoes may be of one thing: at most 150 mm apart along x and along y.
bool argus_task_is_one_thing(argus_point_t a, argus_point_t b);

// Whether an echo there, course frame, `within_mm` of the robot's centre, would be the second one of a thing
// that was seen within them as well: 150 mm from there in the last 5 s, or known by two echoes in the last
// minute, 80 mm from there. Cost: one pass over the points.
bool argus_task_has_seen(const argus_task_t *self, const argus_knowledge_t *knowledge, argus_point_t at,
                         int32_t within_mm);

// Nearest to the robot's centre, were it `back_mm` farther back, of what was seen more than once in the last
// seconds, also where no sonar sees it now; INT32_MAX without any. Cost: one pass over the points.
int32_t argus_task_nearest_mm(const argus_task_t *self, const argus_knowledge_t *knowledge, int32_t back_mm);

// An object stopped the robot on its present heading: that heading is refused until the robot has moved on.
void argus_task_refuse(argus_task_t *self, const argus_knowledge_t *knowledge);

// A wall beside the robot, which only its flank hears, stopped it: waiting does not take that one away.
void argus_task_refuse_slant(argus_task_t *self, const argus_knowledge_t *knowledge);

// After waiting in one place: every heading may be tried again, but into such a wall while the flank reads
// near.
void argus_task_forgive(argus_task_t *self, const argus_knowledge_t *knowledge);

// Something is there, course frame, whoever found it.
void argus_task_touched(argus_task_t *self, argus_point_t at, uint32_t now_ms);

// Chooses the next leg: the waypoint itself when the way is free, else the nearest free heading. False: no
// way.
bool argus_task_choose(argus_task_t *self, const argus_knowledge_t *knowledge);

// Where the robot cannot turn: a leg straight ahead, if the corridor there is free. False: no way that way
// either.
bool argus_task_escape(argus_task_t *self, const argus_knowledge_t *knowledge);

// The course was left (operator, reconnect): the next leg is chosen anew.
void argus_task_restart(argus_task_t *self);

// Bearing and distance of the leg.
int32_t argus_task_bearing_cdeg(const argus_task_t *self, const argus_knowledge_t *knowledge);
int32_t argus_task_leg_mm(const argus_task_t *self, const argus_knowledge_t *knowledge);

#endif
