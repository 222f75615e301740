// SPDX-License-Identifier: MIT
// Every setting of the fault manager, in one table: declaration, default, range, unit and meaning.
#ifndef ARGUS_CONFIG_H
#define ARGUS_CONFIG_H

#include <stdbool.h>
#include <stdint.h>

#include "robot/robot.h"

#define ARGUS_PROFILE_PAPER 0
#define ARGUS_PROFILE_ARGUS 1

// X(key, default, minimum, maximum, unit, choices, meaning). `choices` names the values 0, 1, ... of a
// setting that is picked by name ("" for a number). A front end builds its parser and its help from this
// table.
#define ARGUS_CONFIG_TABLE(X)                                                                                \
    X(profile, 1, 0, 1, "", "paper|argus", "rule set of the diagnosis")                                      \
    X(policy, 0, 0, 1, "", "paper|fewest", "planner of the compensating rotations")                          \
    X(robot, 0, 0, ARGUS_ROBOTS, "", ARGUS_ROBOT_CHOICES,                                                      \
      "whose body and sonars hold; by-subclass: of the robot that answers, passive when unknown")              \
    X(active, 1, 0, 1, "", "off|on", "off: diagnose and report, never command a motion")                     \
    X(health_check_ms, 1000, 100, 10000, "ms", "", "period of the health check beside the main task")        \
    X(suspect_readings, 3, 1, 50, "", "", "consecutive disparate fresh readings before a sonar is verified") \
    X(holdoff_mm, 1000, 0, 20000, "mm", "", "a cleared sonar is not verified again before this distance")    \
    X(holdoff_deg, 30, 0, 180, "deg", "", "... or before this change of heading")                            \
    X(caution, 100, 25, 400, "%", "", "profile argus: so much of the tabled evidence a verdict takes")       \
    X(look_every_s, 20, 2, 3600, "s", "", "profile argus: a look at all sonars at least so often")           \
    X(stale_ms, 1500, 700, 10000, "ms", "", "a sonar that yields no reading for this long is silent")        \
    X(object_range_mm, 250, 150, 1000, "mm", "",                                                             \
      "while driving, a reading at or below this is an object: STOP")                                        \
    X(check_range_mm, 350, 200, 1500, "mm", "",                                                              \
      "in failure mode, a reading at or below this stops the next step")                                     \
    X(step_mm, 200, 50, 200, "mm", "", "length of one step in failure mode")                                 \
    X(step_speed_mm_s, 100, 30, 300, "mm/s", "", "speed of a step")                                          \
    X(speed_mm_s, 200, 30, 750, "mm/s", "", "speed of normal driving")                                       \
    X(accel_mm_s2, 300, 50, 2000, "mm/s2", "", "acceleration asked of the robot")                            \
    X(decel_mm_s2, 600, 50, 2000, "mm/s2", "", "deceleration asked of the robot")                            \
    X(turn_speed_deg_s, 60, 10, 100, "deg/s", "", "speed of a turn")                                         \
    X(turn_accel_deg_s2, 200, 20, 300, "deg/s2", "", "angular acceleration asked of the robot")              \
    X(noise_mm, 5, 0, 100, "mm", "", "standard deviation of a sonar reading, for the S5 margin")             \
    X(backoff_mm, 150, 50, 300, "mm", "",                                                                    \
      "how far to back away from a pressed bumper; for a turn, at least")                                    \
    X(rear_clear_mm, 450, 200, 2000, "mm", "", "every rear sonar must read more than this to back away")     \
    X(waypoint_radius_mm, 100, 20, 500, "mm", "", "a waypoint this near counts as passed")                   \
    X(goal_radius_mm, 60, 20, 140, "mm", "", "the goal counts as reached this near")                         \
    X(sonar_cycle_ms, 40, 20, 120, "ms", "", "time between two pings of one array")                          \
    X(baud, 9600, 0, 115200, "bit/s", "",                                                                    \
      "rate of the wire, for its share of the reaction time (0: none, TCP)")                                 \
    X(pulse_ms, 500, 100, 1500, "ms", "", "longest silence towards the robot before a PULSE is sent")        \
    X(link_stall_ms, 600, 200, 5000, "ms", "",                                                               \
      "no SIP for this long: stand, and check all sonars before driving on")                                 \
    X(link_lost_ms, 4000, 1000, 60000, "ms", "", "no SIP for this long: start the session again")            \
    X(retry_max_ms, 8000, 500, 60000, "ms", "", "longest pause between two attempts to reach the robot")

typedef struct {
#define ARGUS_CONFIG_FIELD(key, def, min, max, unit, choices, meaning) int32_t key;
    ARGUS_CONFIG_TABLE(ARGUS_CONFIG_FIELD)
#undef ARGUS_CONFIG_FIELD
} argus_config_t;

typedef enum { ARGUS_POLICY_PAPER = 0, ARGUS_POLICY_FEWEST = 1 } argus_policy_t;

// What is wrong with a configuration; ARGUS_CONFIG_OK when nothing is.
typedef enum {
    ARGUS_CONFIG_OK = 0,
    ARGUS_CONFIG_RANGE,   // the setting number `key` (its row in the table) is out of its range
    ARGUS_CONFIG_DRIVING, // S5: the robot would reach the object before it stands
    ARGUS_CONFIG_STEP     // S5: a step could sweep a point that the check does not see
} argus_config_fault_t;

// The arithmetic of S5 (DESIGN.md, safety invariants), so that a refusal can show it.
typedef struct {
    argus_config_fault_t fault;
    int32_t key;         // row of the table, for ARGUS_CONFIG_RANGE, else -1
    int32_t overhang_mm; // body front ahead of the sonar faces
    int32_t reaction_ms; // sonar refresh + SIP period + SIP and command on the wire
    int32_t travel_mm;   // speed x reaction
    int32_t brake_mm;    // speed^2 / (2 decel), decel at most that of the robot (300 mm/s2)
    int32_t driving_mm;  // overhang + travel + brake: must be < object_range_mm
    int32_t reach_mm;    // largest reading of a point that the body sweeps in one step
    int32_t stepping_mm; // reach + 3 noise + 20: must be < check_range_mm
} argus_config_report_t;

void argus_config_default(argus_config_t *config);

// Ranges first, then the two S5 inequalities for the robot that the setting names, or for the default one.
// Cost: a few thousand integer operations, once at start and once when another robot answers.
argus_config_report_t argus_config_check(const argus_config_t *config);

// The same for a robot.
argus_config_report_t argus_config_check_for(const argus_config_t *config, const argus_robot_t *robot);

// The way, in mm, from a reading that asks for a stop to standstill at the driving speed (S5: v t + v^2 / (2
// decel)).
int32_t argus_config_stop_mm(const argus_config_t *config, const argus_robot_t *robot);

// Largest reading, in mm, that a forward-facing sonar gives of a point which the body sweeps when it moves `step_mm`
// ahead.
int32_t argus_config_reach_mm(const argus_robot_t *robot, int32_t step_mm);

#endif
