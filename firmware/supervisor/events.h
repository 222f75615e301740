// SPDX-License-Identifier: MIT
// The event catalogue: everything the fault manager says, with its level and its meaning.
#ifndef ARGUS_EVENTS_H
#define ARGUS_EVENTS_H

#include <stdbool.h>
#include <stdint.h>

// Levels are those of ROS diagnostics.
typedef enum {
    ARGUS_LEVEL_OK = 0,
    ARGUS_LEVEL_WARN = 1,
    ARGUS_LEVEL_ERROR = 2,
    ARGUS_LEVEL_STALE = 3
} argus_level_t;

// X(id, NAME, level, subject, meaning). Ids are stable: never reuse one. `subject` is what the event is
// about; "sonar" events carry the sonar's number. `meaning` says what `value` is.
#define ARGUS_EVENT_TABLE(X)                                                                                \
    X(10, LINK_UP, OK, "link", "the transport is open")                                                     \
    X(11, LINK_LOST, ERROR, "link",                                                                         \
      "the transport is gone, or no SIP came for link_lost_ms; value: ms without a SIP")                    \
    X(12, LINK_STALLED, WARN, "link", "no SIP for link_stall_ms: standing; value: ms without a SIP")        \
    X(13, LINK_RESUMED, OK, "link", "SIPs come again; value: length of the gap in ms")                      \
    X(14, SESSION_NO_ANSWER, WARN, "session", "nobody answers SYNC; value: attempts so far")                \
    X(15, SESSION_OPEN, OK, "session", "the robot answered and reports; value: attempts it took")           \
    X(16, SESSION_CLOSED, OK, "session", "orderly end: SONAR 0, STOP, CLOSE sent")                          \
    X(17, SESSION_DISLODGED, WARN, "session", "the robot was still in an old session, which was closed")    \
    X(18, SUBCLASS_UNKNOWN, WARN, "session",                                                                \
      "a robot whose body is not known: passive until the setting `robot` says which it is")                \
    X(19, ROBOT_UNSAFE, ERROR, "session",                                                                   \
      "the settings are unsafe for this robot (S5): passive; value: mm that S5 needs")                      \
    X(20, MOTORS_OFF, ERROR, "drive",                                                                       \
      "the motors are off (button or E-stop): enable them to go on; value: SIP flags")                      \
    X(21, MOTORS_ON, OK, "drive", "the motors are on; value: SIP flags")                                    \
    X(22, BUMPER, ERROR, "bumper",                                                                          \
      "a bumper was hit: E_STOP sent; value: front segments << 8 | rear segments")                          \
    X(23, BUMPER_CLEAR, OK, "bumper", "no bumper is pressed any more")                                      \
    X(24, STALL, ERROR, "drive", "a wheel stalls: STOP sent; value: 1 left, 2 right, 3 both")               \
    X(25, BATTERY_LOW, WARN, "battery", "battery low; value: decivolts")                                    \
    X(26, SONARS_BEYOND, WARN, "session",                                                                   \
      "it has more sonars than this build manages, those beyond are left out; value: how many it has")      \
    X(30, SONAR_DEAD, ERROR, "sonar", "dead reading: STOP sent; value: the reading in mm")                  \
    X(31, SONAR_SILENT, ERROR, "sonar",                                                                     \
      "its slot yields no reading: STOP sent; value: age of its last reading in ms")                        \
    X(32, SONAR_SUSPECT, WARN, "sonar",                                                                     \
      "disparate to its neighbours (Algorithm 1); value: the disparity in mm")                              \
    X(33, SONAR_VERIFYING, OK, "sonar",                                                                     \
      "neighbours turn onto its bearing (Algorithm 2); value: its reading in mm")                           \
    X(34, SONAR_WITNESS, OK, "sonar", "a neighbour saw on its bearing; value: that reading in mm")          \
    X(35, SONAR_CLEARED, OK, "sonar", "the witnesses agree with it; value: mean of the witnesses in mm")    \
    X(36, SUSPICION_DROPPED, OK, "sonar", "no longer disparate at rest; value: the disparity in mm")        \
    X(37, SONAR_DISABLED, ERROR, "sonar", "not used any more; value: fault kind")                           \
    X(38, SONAR_HEALTHY, OK, "sonar", "judged healthy; value: its reading in mm")                           \
    X(39, SONAR_UNPROVEN, WARN, "sonar", "no usable witness: it stays a suspect; value: its reading in mm") \
    X(40, FAILURE_STATE, WARN, "health",                                                                    \
      "the failure state changed; value: number of disabled sonars among 1..6")                             \
    X(41, PLAN, WARN, "plan", "rotations that cover the disabled bearings; value: how many")                \
    X(42, PLAN_ROTATION, OK, "plan", "one rotation of the plan; value: degrees, CCW positive")              \
    X(43, HEALTH_CHECK, OK, "health",                                                                       \
      "all front sonars have reported and no suspect is open; value: disabled")                             \
    X(44, SONAR_STALE, STALE, "sonar", "a sonar outside 1..6 yields no reading; value: ms without one")     \
    X(45, SONAR_NAMED, WARN, "sonar", "a suspect: the evidence so far names this fault; value: fault kind") \
    X(46, SONAR_PROBATION, WARN, "sonar",                                                                   \
      "not used yet: does well again, or failed in the last mission; value: its reading in mm")             \
    X(47, SONAR_KIND, WARN, "sonar", "its fault is known better now; value: fault kind")                    \
    X(48, SONAR_PINNED, WARN, "sonar", "keeps its health until unpinned; value: 1 pinned, 0 unpinned")      \
    X(49, SONAR_DEGRADING, WARN, "sonar", "gets worse; value: metres of driving until it will have failed") \
    X(50, OBJECT, WARN, "object",                                                                           \
      "an object in range, or (0, 7) a wall that the way slants into: STOP sent; value: the reading in mm") \
    X(51, OBJECT_CHECKED, WARN, "object",                                                                   \
      "a check in failure mode finds an object; value: the reading in mm")                                  \
    X(52, AVOIDING, OK, "task", "goes round an obstacle; value: heading chosen, degrees")                   \
    X(53, NO_WAY, WARN, "task", "every heading is blocked: waits; value: seconds waited")                   \
    X(54, STEP, OK, "drive", "one step in failure mode; value: mm commanded")                               \
    X(55, SWEEP, OK, "drive", "a sweep of the planned rotations is done; value: smallest reading in mm")    \
    X(56, STOPPED, WARN, "drive", "STOP sent; value: heading in hundredths of a degree")                    \
    X(57, BACKING, WARN, "drive", "backs away; value: mm")                                                  \
    X(58, TURN_BLOCKED, WARN, "drive",                                                                      \
      "the swing circle is not free: no turn; value: the nearest point in mm")                              \
    X(59, WAITING, WARN, "drive", "cannot go on by itself; value: seconds waited")                          \
    X(60, MISSION_START, OK, "task", "a course starts; value: waypoints")                                   \
    X(61, WAYPOINT, OK, "task", "a waypoint was passed; value: its number, from 1")                         \
    X(62, GOAL_REACHED, OK, "task", "at rest at the goal; value: distance to it in mm")                     \
    X(63, MISSION_FAILED, ERROR, "task", "the course was given up; value: distance to the goal in mm")      \
    X(64, TURN_FAILED, WARN, "drive", "a turn did not settle in time; value: degrees off")                  \
    X(65, LOOK, OK, "drive", "looks round to try all sonars; value: 0")                                     \
    X(70, OPERATOR, OK, "operator", "an operator's command was taken; value: its number")                   \
    X(71, PASSIVE, OK, "operator", "reports only: commands no motion")                                      \
    X(72, ACTIVE, OK, "operator", "drives")                                                                 \
    X(80, RECORD_IGNORED, WARN, "record",                                                                   \
      "the stored record is damaged or foreign; value: 1 damaged, 2 version, 3 of another robot")           \
    X(81, EVENTS_LOST, ERROR, "events", "the event queue overflowed; value: events lost")                   \
    X(90, INVARIANT, ERROR, "manager", "an internal invariant does not hold; value: its number")            \
    X(91, STATUS, OK, "status", "periodic picture of all that is known")

typedef enum {
#define ARGUS_EVENT_ENUM(id, name, level, subject, meaning) ARGUS_EV_##name = (id),
    ARGUS_EVENT_TABLE(ARGUS_EVENT_ENUM)
#undef ARGUS_EVENT_ENUM
} argus_event_id_t;

#define ARGUS_NO_SONAR ((int8_t)-1)

typedef struct {
    uint32_t t_ms; // time of the call that raised it
    uint16_t id;   // argus_event_id_t
    int8_t sonar;  // 0..15, or ARGUS_NO_SONAR
    uint8_t state; // argus_failure_t when it was raised
    int32_t value; // see the catalogue
} argus_event_t;

// A first-in first-out queue; when full the newest event is dropped and counted.
#define ARGUS_EVENT_QUEUE 64
typedef struct {
    argus_event_t slot[ARGUS_EVENT_QUEUE];
    uint16_t head;
    uint16_t count;
    uint32_t lost; // monotonic
    uint32_t lost_said;
} argus_events_t;

void argus_events_init(argus_events_t *self);
void argus_events_push(argus_events_t *self, argus_event_t event);
bool argus_events_pop(argus_events_t *self, argus_event_t *event);

// Catalogue look-up; an unknown id gives "?", ARGUS_LEVEL_ERROR. Cost: one pass over the catalogue.
const char *argus_event_name(uint16_t id);
const char *argus_event_subject(uint16_t id);
argus_level_t argus_event_level(uint16_t id);

#endif
