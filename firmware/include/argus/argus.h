// SPDX-License-Identifier: MIT
// Argus: the autonomic sonar fault manager for ARCOS robots. This is its one public header.
//
// WHAT IT IS. Bytes of the robot's serial line and the time go in; packets for the robot, events and a status
// come out. In between the manager keeps the ARCOS session, judges every sonar, works round those that
// failed, and drives a course under its safety rules (DESIGN.md). It allocates nothing, reads no clock, does
// no I/O, has no mutable statics, and needs of the C library memcpy, memset and memcmp only. Any C11
// compiler, 32 bit and up.
//
// HOW TO USE IT. A port owns the wire and the clock; this is all it does (examples/embed/ is a whole one):
//
//     static argus_storage_t storage;
//     argus_config_t config;
//     argus_config_default(&config);                       // then change what is to be changed
//     argus_t *const argus = argus_init(&storage, &config, now_ms());
//     argus_link_up(argus, now_ms());
//     while (!argus_closed(argus)) {
//         argus_receive(argus, now_ms(), bytes, read_wire(bytes, sizeof bytes));
//         while ((n = argus_transmit(argus, packet, sizeof packet)) > 0) { write_wire(packet, n); }
//         const uint32_t wait_ms = argus_process(argus, now_ms());
//         while ((n = argus_transmit(argus, packet, sizeof packet)) > 0) { write_wire(packet, n); }
//         while (argus_next_event(argus, &event)) { log_event(&event); }
//         wait_for_bytes(wait_ms);                         // at most so long
//     }
//
// ORDER OF A LIFE. argus_init(); then argus_record_load() and argus_set_course(), if wanted; argus_link_up()
// when the wire is open; the loop above; argus_link_lost() and argus_link_up() as the wire goes and comes;
// argus_shutdown(); the loop until argus_closed(); argus_record_save(). To start anew call argus_init()
// again.
//
// CONCURRENCY. Not thread-safe, but reentrant: one thread (or one interrupt level) owns an instance; any
// number of instances may live side by side. No function calls back.
//
// UNITS. Names end in them: _mm, _ms, _cdeg (hundredths of a degree), _dv (decivolts). Angles are
// counter-clockwise positive. Times are ms of any free-running counter, uint32_t, and may wrap; they never go
// back.
//
// ERRORS. What a function refuses it says by its result and changes nothing. What goes wrong on the robot is
// an event. A pointer that must not be NULL and an enumeration out of its range are errors of the caller; see
// ARGUS_ASSERT.
//
// COST. No call runs longer than one pass over the bytes given and, for each SIP in them, the diagnosis of
// that SIP; none waits. Figures: tools/dev bench parse reaction.
#ifndef ARGUS_ARGUS_H
#define ARGUS_ARGUS_H

// The one place where the version is written: all else reads it here.
#define ARGUS_VERSION "0.1.0"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// Build ----------------------------------------------------------------------------------------------------

// Checks of what must be true inside the library, and of its callers. The builder of the library may define
// it, for example as -D'ARGUS_ASSERT(condition)=((condition) ? (void)0 : board_reset())'; it must then be a
// void expression. Else it costs nothing, unless ARGUS_ASSERTS is defined (as in every test build): then it
// traps, with no call to anything. The condition has no side effects.
#ifndef ARGUS_ASSERT
#ifdef ARGUS_ASSERTS
#define ARGUS_ASSERT(condition) ((condition) ? (void)0 : __builtin_trap())
#else
#define ARGUS_ASSERT(condition) ((void)sizeof((condition) ? 1 : 0))
#endif
#endif

// Bounds ---------------------------------------------------------------------------------------------------

// The most sonars that a build manages, numbered from 0: 8, 16, 24 or 32. Each costs some 2 KB of RAM; a
// robot may have fewer or more. Where nothing else is set: 32 under an operating system, enough for every
// known robot; 16 on a board. Library and program must be built with the same number.
#ifndef ARGUS_SONARS
#if defined(__unix__) || defined(__APPLE__) || defined(_WIN32)
#define ARGUS_SONARS 32
#else
#define ARGUS_SONARS 16
#endif
#endif
#define ARGUS_NO_SONAR ((int8_t)-1) // where an event is about no sonar
// A mask over sonar numbers: bit K is sonar K.
#if ARGUS_SONARS > 16
typedef uint32_t argus_mask_t;
#else
typedef uint16_t argus_mask_t;
#endif
#define ARGUS_NO_ECHO_MM 5000                     // a reading of this or more: nothing was heard
#define ARGUS_NAME_MAX 32                         // identity strings, cut to 31 characters and a NUL
#define ARGUS_WAYPOINTS_MAX 64                    // points of a course
#define ARGUS_COURSE_LIMIT_MM 30000               // of a point's x and y, either way
#define ARGUS_PACKET_MAX 200                      // the longest packet that is ever sent
#define ARGUS_RECORD_MAX (64 + 60 * ARGUS_SONARS) // the longest record that is ever saved

// Settings -------------------------------------------------------------------------------------------------

// A setting that is picked by name has its values in one table: from a row come the constant, the word of the
// setting, its maximum, and what the value means to the library. OR stands between two rows. To add one is to
// add its row.
#define ARGUS_WORD_OF(name, word, ...) word

// Rule sets of the diagnosis, values of the setting profile. A row: name, word, then which groups of rules
// run (knowledge/profile.h): the paper's tests, the evidence, what goes beyond the paper.
// clang-format off
#define ARGUS_PROFILE_TABLE(X, OR)                                      \
    X(PAPER, "paper", 1, 0, 0, "the rules of the source paper")         \
    OR X(ARGUS, "argus", 0, 1, 1, "evidence while driving, and all that goes beyond the paper; the default")
// clang-format on
// The words of that table, with a bar between them.
#define ARGUS_PROFILE_WORDS ARGUS_PROFILE_TABLE(ARGUS_WORD_OF, "|")
#define ARGUS_PROFILE_LAST ((int32_t)ARGUS_PROFILES - 1) // the last of them

// A constant for each row of that table; ARGUS_PROFILES is how many there are.
typedef enum {
#define ARGUS_PROFILE_CONSTANT(name, ...) ARGUS_PROFILE_##name,
    ARGUS_PROFILE_TABLE(ARGUS_PROFILE_CONSTANT, )
#undef ARGUS_PROFILE_CONSTANT
        ARGUS_PROFILES // how many
} argus_rules_t;

// Planners of the compensating rotations, values of the setting policy. A row: name, word, walks, ring, stop,
// degree, meaning. `walks`: nearest to 0 first, back after each; else the exact planner, one pass and one
// return. `ring`: every living sonar may look, not only those that face forward. `stop`, `degree`: what one
// costs. A stop takes 1 s, in which the robot turns by 60 degrees.
// clang-format off
#define ARGUS_POLICY_TABLE(X, OR)                                                                       \
    X(PAPER, "paper", 1, 0, 0, 0, "Algorithm 3: nearest turn first, back after each")                   \
    OR X(FEWEST, "fewest", 0, 0, 1000, 1, "least stops, then least turning")                            \
    OR X(LEAST_TURN, "least-turn", 0, 0, 1, 1000, "least turning, then least stops")                    \
    OR X(RING, "ring", 0, 1, 1000, 1, "least stops, then least turning, abeam and rear look ahead too") \
    OR X(ADAPTIVE, "adaptive", 0, 1, 60, 1, "least time, abeam and rear look ahead too")
// clang-format on
// The words of that table, with a bar between them.
#define ARGUS_POLICY_WORDS ARGUS_POLICY_TABLE(ARGUS_WORD_OF, "|")
#define ARGUS_POLICY_LAST ((int32_t)ARGUS_POLICIES - 1) // the last of them

// A constant for each row of that table; ARGUS_POLICIES is how many there are.
typedef enum {
#define ARGUS_POLICY_CONSTANT(name, ...) ARGUS_POLICY_##name,
    ARGUS_POLICY_TABLE(ARGUS_POLICY_CONSTANT, )
#undef ARGUS_POLICY_CONSTANT
        ARGUS_POLICIES // how many
} argus_policy_t;

// Values of the setting robot: written by tools/gen_tables.py from hil_sim/tables/robots.
#define ARGUS_ROBOT_WORDS "by-subclass|p3dx-sh|amigo-sh|p3at-sh|peoplebot-sh"
#define ARGUS_ROBOT_LAST 4 // the last of them

// X(key, default, minimum, maximum, unit, choices, meaning). `choices` names the values 0, 1, ... of a
// setting that is picked by name ("" for a number). "auto" alone: a number, or this word for ARGUS_AUTO, its
// default. A front end builds its parser and its help from this table.
#define ARGUS_CONFIG_TABLE(X)                                                                                \
    X(profile, 1, 0, ARGUS_PROFILE_LAST, "", ARGUS_PROFILE_WORDS, "rule set of the diagnosis")               \
    X(diagnosis, 1, 0, 1, "", "off|on",                                                                      \
      "off: every sonar that reports is trusted, nothing is judged; for comparisons")                        \
    X(policy, 4, 0, ARGUS_POLICY_LAST, "", ARGUS_POLICY_WORDS,                                               \
      "planner of the compensating rotations; with profile paper, adaptive stands for paper")                \
    X(robot, 0, 0, ARGUS_ROBOT_LAST, "", ARGUS_ROBOT_WORDS,                                                  \
      "whose body and sonars it has; by-subclass: as it says itself, and passive when that is not known")    \
    X(active, 1, 0, 1, "", "off|on", "off: diagnose and report, never command a motion")                     \
    X(health_check_ms, 1000, 100, 10000, "ms", "", "period of the health check beside the main task")        \
    X(suspect_readings, 3, 1, 50, "", "", "consecutive disparate fresh readings before a sonar is verified") \
    X(holdoff_mm, 1000, 0, 20000, "mm", "", "a cleared sonar is not verified again before this distance")    \
    X(holdoff_deg, 30, 0, 180, "deg", "", "... or before this change of heading")                            \
    X(caution, 100, 25, 400, "%", "", "profile argus: so much of the tabled evidence a verdict takes")       \
    X(stale_ms, 1500, 700, 10000, "ms", "", "a sonar that yields no reading for this long is silent")        \
    X(object_range_mm, ARGUS_AUTO, 150, 1000, "mm", "auto",                                                  \
      "while driving, a reading at or below this is an object: STOP; auto: as the robot's body asks, from "  \
      "250 on")                                                                                              \
    X(check_range_mm, ARGUS_AUTO, 200, 1500, "mm", "auto",                                                   \
      "in failure mode, a reading at or below this stops the next step; auto: likewise, from 350 on")        \
    X(step_mm, 200, 50, 200, "mm", "", "length of one step in failure mode")                                 \
    X(step_speed_mm_s, 100, 30, 300, "mm/s", "", "speed of a step")                                          \
    X(creep_mm_s, 0, 0, 100, "mm/s", "",                                                                     \
      "where no sonar sees the way: creep on at this speed, guided by the bumpers alone; 0: stand and wait") \
    X(speed_mm_s, ARGUS_AUTO, 30, 750, "mm/s", "auto",                                                       \
      "speed of normal driving; profile argus: where something is near, or others do not see far enough; "   \
      "auto: 200, or what S5 allows")                                                                        \
    X(speed_max_mm_s, 500, 30, 750, "mm/s", "",                                                              \
      "profile argus: the most where the way ahead is seen to be free")                                      \
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
    X(sonar_cycle_ms, ARGUS_AUTO, 20, 120, "ms", "auto",                                                     \
      "time between two pings of one array; auto: that of the robot")                                        \
    X(baud, 9600, 0, 115200, "bit/s", "",                                                                    \
      "rate of the wire, for its share of the reaction time (0: none, TCP)")                                 \
    X(pulse_ms, 500, 100, 1500, "ms", "", "longest silence towards the robot before a PULSE is sent")        \
    X(link_stall_ms, 600, 200, 5000, "ms", "",                                                               \
      "no SIP for this long: stand, and check all sonars before driving on")                                 \
    X(link_lost_ms, 4000, 1000, 60000, "ms", "", "no SIP for this long: start the session again")            \
    X(retry_max_ms, 8000, 500, 60000, "ms", "", "longest pause between two attempts to reach the robot")

// A setting that follows the robot: it is worked out when one has answered, from its body and S5.
#define ARGUS_AUTO 0

// The settings, one int32_t for each row of the table.
typedef struct {
#define ARGUS_CONFIG_FIELD(key, def, min, max, unit, choices, meaning) int32_t key;
    ARGUS_CONFIG_TABLE(ARGUS_CONFIG_FIELD)
#undef ARGUS_CONFIG_FIELD
} argus_config_t;

// What is wrong with a configuration; ARGUS_CONFIG_OK when nothing is.
typedef enum {
    ARGUS_CONFIG_OK = 0,
    ARGUS_CONFIG_RANGE,   // the setting number `key` (its row in the table) is out of its range
    ARGUS_CONFIG_DRIVING, // S5: the robot would reach the object before it stands
    ARGUS_CONFIG_STEP     // S5: a step could sweep a point that the check does not see
} argus_config_fault_t;

// The arithmetic of S5 (DESIGN.md, safety invariants), so that a refusal can show it.
typedef struct {
    int32_t fault;           // argus_config_fault_t: the first that was found
    int32_t key;             // row of the table, for ARGUS_CONFIG_RANGE, else -1
    int32_t overhang_mm;     // body front ahead of the sonar faces
    int32_t reaction_ms;     // sonar refresh + SIP period + SIP and command on the wire
    int32_t travel_mm;       // speed x reaction
    int32_t brake_mm;        // speed^2 / (2 decel), decel at most the robot's own (300 mm/s2)
    int32_t driving_mm;      // overhang + travel + brake: must be < object_range_mm
    int32_t reach_mm;        // largest reading of a point that the body sweeps in one step
    int32_t stepping_mm;     // reach + 3 noise + 20: must be < check_range_mm
    int32_t speed_mm_s;      // the settings in force: what ARGUS_AUTO stands for with this robot
    int32_t object_range_mm; // likewise
    int32_t check_range_mm;  // likewise
} argus_config_report_t;

// Events ---------------------------------------------------------------------------------------------------

// Levels are those of ROS diagnostics.
typedef enum {
    ARGUS_LEVEL_OK = 0,
    ARGUS_LEVEL_WARN = 1,
    ARGUS_LEVEL_ERROR = 2,
    ARGUS_LEVEL_STALE = 3
} argus_level_t;

// X(id, NAME, level, subject, meaning). Ids are stable: never reuse one. `subject` is what the event is
// about; "sonar" events carry the sonar's number. `meaning` says what `value` is.
#define ARGUS_CORE_EVENT_TABLE(X)                                                                            \
    X(10, LINK_UP, OK, link, "the transport is open")                                                        \
    X(11, LINK_LOST, ERROR, link,                                                                            \
      "the transport is gone, or no SIP came for link_lost_ms; value: ms without a SIP")                     \
    X(12, LINK_STALLED, WARN, link, "no SIP for link_stall_ms: standing; value: ms without a SIP")           \
    X(13, LINK_RESUMED, OK, link, "SIPs come again; value: length of the gap in ms")                         \
    X(14, SESSION_NO_ANSWER, WARN, session, "no robot answers SYNC; value: attempts so far")                 \
    X(15, SESSION_OPEN, OK, session, "the robot answered and reports; value: attempts it took")              \
    X(16, SESSION_CLOSED, OK, session, "orderly end: SONAR 0, STOP, CLOSE sent")                             \
    X(17, SESSION_DISLODGED, WARN, session, "the robot was still in an old session, which was closed")       \
    X(18, SUBCLASS_UNKNOWN, WARN, session,                                                                   \
      "a robot whose body is not known: passive until the setting `robot` says which it is")                 \
    X(19, ROBOT_UNSAFE, ERROR, session,                                                                      \
      "the settings are unsafe for this robot (S5): passive; value: mm that S5 needs")                       \
    X(20, MOTORS_OFF, ERROR, drive,                                                                          \
      "the motors are off (button or E-stop): enable them to go on; value: SIP flags")                       \
    X(21, MOTORS_ON, OK, drive, "the motors are on; value: SIP flags")                                       \
    X(22, BUMPER, ERROR, bumper,                                                                             \
      "a bumper was hit: E_STOP sent; value: front segments << 8 | rear segments")                           \
    X(23, BUMPER_CLEAR, OK, bumper, "no bumper is pressed any more")                                         \
    X(24, STALL, ERROR, drive, "a wheel stalls: STOP sent; value: 1 left, 2 right, 3 both")                  \
    X(25, BATTERY_LOW, WARN, battery, "battery low; value: decivolts")                                       \
    X(26, SONARS_BEYOND, WARN, session,                                                                      \
      "it has more sonars than this build manages: those beyond are left out; or than its subclass has, or " \
      "fewer than the ring it was given: passive, unless the setting `robot` says which it is; value: how "  \
      "many it should have")                                                                                 \
    X(27, OTHER_ROBOT, ERROR, session,                                                                       \
      "another robot answers than before: passive, the course is paused, until an operator says active and " \
      "go; value: what differs, 1 name, 2 class, 3 subclass, 4 serial number")                               \
    X(28, BATTERY_ODD, WARN, battery,                                                                        \
      "a voltage that no battery of a robot has: not judged; value: decivolts")                              \
    X(30, SONAR_DEAD, ERROR, sonar, "dead reading: STOP sent; value: the reading in mm")                     \
    X(31, SONAR_SILENT, ERROR, sonar,                                                                        \
      "its slot yields no reading: STOP sent; value: age of its last reading in ms")                         \
    X(32, SONAR_SUSPECT, WARN, sonar,                                                                        \
      "evidence against it (under `paper`: Algorithm 1); value: its disparity to its neighbours in mm")      \
    X(33, SONAR_VERIFYING, OK, sonar, "a look: neighbours turn onto its bearing; value: its reading in mm")  \
    X(34, SONAR_WITNESS, OK, sonar, "a neighbour saw on its bearing; value: that reading in mm")             \
    X(35, SONAR_CLEARED, OK, sonar, "the witnesses agree with it; value: mean of the witnesses in mm")       \
    X(36, SUSPICION_DROPPED, OK, sonar, "no longer disparate at rest; value: the disparity in mm")           \
    X(37, SONAR_DISABLED, ERROR, sonar, "not used any more; value: fault kind")                              \
    X(38, SONAR_HEALTHY, OK, sonar, "judged healthy; value: its reading in mm")                              \
    X(39, SONAR_UNPROVEN, WARN, sonar, "no usable witness: it stays a suspect; value: its reading in mm")    \
    X(40, FAILURE_STATE, WARN, health,                                                                       \
      "the failure state changed; value: number of disabled forward-facing sonars")                          \
    X(41, PLAN, WARN, plan, "rotations that cover the disabled bearings; value: how many")                   \
    X(42, PLAN_ROTATION, OK, plan, "one rotation of the plan; value: degrees, CCW positive")                 \
    X(43, HEALTH_CHECK, OK, health,                                                                          \
      "all front sonars have reported and no suspect is open; value: disabled")                              \
    X(44, SONAR_STALE, STALE, sonar,                                                                         \
      "a sonar that does not face forward yields no reading; value: ms without one")                         \
    X(45, SONAR_NAMED, WARN, sonar, "a suspect: the evidence so far names this fault; value: fault kind")    \
    X(46, SONAR_PROBATION, WARN, sonar,                                                                      \
      "not used yet: does well again, or failed in the last mission; value: its reading in mm")              \
    X(47, SONAR_KIND, WARN, sonar, "its fault is known better now; value: fault kind")                       \
    X(48, SONAR_PINNED, WARN, sonar, "keeps its health until unpinned; value: 1 pinned, 0 unpinned")         \
    X(49, SONAR_DEGRADING, WARN, sonar,                                                                      \
      "gets worse: named in this mission as in the one before; value: so many missions in a row")            \
    X(50, OBJECT, WARN, object,                                                                              \
      "an object in range, or (0, 7) a wall that the way slants into: STOP sent; value: the reading in mm")  \
    X(51, OBJECT_CHECKED, WARN, object, "a check in failure mode finds an object; value: the reading in mm") \
    X(52, AVOIDING, OK, task, "goes round an obstacle; value: heading chosen, degrees")                      \
    X(53, NO_WAY, WARN, task, "no way, or no progress on it: waits, or gives up; value: seconds so far")     \
    X(54, STEP, OK, drive, "one step in failure mode; value: mm commanded")                                  \
    X(55, SWEEP, OK, drive, "a sweep of the planned rotations is done; value: smallest reading in mm")       \
    X(56, STOPPED, WARN, drive, "STOP sent; value: heading in hundredths of a degree")                       \
    X(57, BACKING, WARN, drive, "backs away; value: mm")                                                     \
    X(58, TURN_BLOCKED, WARN, drive,                                                                         \
      "no turn: the swing circle is not free, as this sonar hears; value: the nearest point in mm")          \
    X(59, WAITING, WARN, drive, "cannot go on by itself; value: seconds waited")                             \
    X(60, MISSION_START, OK, task, "a course starts; value: waypoints")                                      \
    X(61, WAYPOINT, OK, task, "a waypoint was passed; value: its number, from 1")                            \
    X(62, GOAL_REACHED, OK, task, "at rest at the goal; value: distance to it in mm")                        \
    X(63, MISSION_FAILED, ERROR, task, "the course was given up; value: distance to the goal in mm")         \
    X(64, TURN_FAILED, WARN, drive, "a turn did not settle in time; value: degrees off")                     \
    X(65, LOOK, OK, drive, "looks round to try all sonars; value: 0")                                        \
    X(66, POSE_LEAP, WARN, drive,                                                                            \
      "the position stepped as no robot moves: STOP sent, left out of the pose; value: mm")                  \
    X(67, HEADING_LEAP, WARN, drive,                                                                         \
      "the heading stepped as no robot turns: STOP sent, left out of the pose; value: degrees")              \
    X(68, SLIP, WARN, drive,                                                                                 \
      "the ranges stay while the wheels turn: they slip, or are lifted: STOP sent, left out of the pose; "   \
      "value: mm")                                                                                           \
    X(69, ODOMETRY_LOST, ERROR, drive,                                                                       \
      "it leapt or restarted while nobody saw the robot move, or leaps or slips again and again: where the " \
      "robot is nobody knows, the course is given up; value: of the last leap or slip")                      \
    X(70, OPERATOR, OK, operator, "an operator's command was taken; value: its number")                      \
    X(71, PASSIVE, OK, operator, "reports only: commands no motion")                                         \
    X(72, ACTIVE, OK, operator, "drives")                                                                    \
    X(73, REVERSED, WARN, drive,                                                                             \
      "the leading end changes, at rest; value: 1 the rear leads, 0 the front again")                        \
    X(74, INJECTED, WARN, sonar, "what it reports is altered for a test; value: fault kind, 0: no more")     \
    X(75, WHEEL_SHORT, WARN, drive,                                                                          \
      "ways straight ahead bend: a wheel turns less than ordered, and is countered by turning; value: "      \
      "thousandths that it falls short, positive the left one, negative the right one")                      \
    X(76, WHEEL_EVEN, OK, drive, "ways straight ahead are straight again; value: 0")                         \
    X(77, CREEPING, WARN, drive,                                                                             \
      "no sonar sees the way, and the operator lets it: creeps on, guided by the bumpers alone; value: "     \
      "mm/s")                                                                                                \
    X(78, NO_ECHO, WARN, drive,                                                                              \
      "no sonar ahead has heard an echo in this session, so nothing shows that one lives: slow until one "   \
      "has; value: mm/s")                                                                                    \
    X(80, RECORD_IGNORED, WARN, record,                                                                      \
      "the stored record is damaged or foreign; value: 1 damaged, 2 version, 3 of another robot")            \
    X(81, EVENTS_LOST, ERROR, events, "the event queue overflowed; value: events lost")                      \
    X(82, ORDER_UNANSWERED, WARN, session,                                                                   \
      "an order was sent again and again, and what the robot reports does not show it; value: its number")   \
    X(83, SPEED_EXCEEDED, WARN, drive,                                                                       \
      "the robot drives faster than it was set: S5 reckons with the speed seen; value: mm/s")                \
    X(90, INVARIANT, ERROR, manager, "an internal invariant does not hold; value: its number")               \
    X(91, STATUS, OK, status, "periodic picture of all that is known")                                       \
    X(92, LINK_SLOW, WARN, link,                                                                             \
      "orders take effect late, or what is read is old: slower, or standing; value: ms from an order until " \
      "it shows")                                                                                            \
    X(93, LINK_PROMPT, OK, link, "orders take effect in time again; value: ms from an order until it shows") \
    X(94, LASER_FAULT, ERROR, laser,                                                                         \
      "the scan of the laser as a whole is off; value: 1 frozen, 2 nothing returned, 3 range cut, 4 late, "  \
      "5 turned about its axis, 6 scaled")                                                                   \
    X(95, SIP_COPIED, WARN, link,                                                                            \
      "a SIP came a second time, behind newer ones: passed over; value: how many so far")

// Of a guard port.
#define ARGUS_GUARD_EVENT_TABLE(X)                                                                           \
    X(100, GUARD_OPEN, OK, guard, "a client opened its session at a guard port; value: 0")                   \
    X(101, GUARD_CLOSED, OK, guard, "the client closed its session; value: packets that it sent")            \
    X(102, GUARD_LOST, ERROR, guard,                                                                         \
      "the client is gone without a word: STOP sent if it drove; value: 1 its connection closed, 2 silent "  \
      "for as long as the robot's watchdog waits, 3 the robot's own session ended")                          \
    X(103, GUARD_DRIVES, WARN, guard, "the client drives: passive, bounds its motion and reports; value: 0") \
    X(104, GUARD_SLOWED, WARN, guard,                                                                        \
      "slower than the client asks, to stand before what is seen (S5); value: mm/s")                         \
    X(105, GUARD_HELD, WARN, guard,                                                                          \
      "not the way that the client asks; value: 1 an object (S2), 2 a way that is not seen (S1), 3 a "       \
      "bumper, "                                                                                             \
      "4 stopped by an operator, or a body that is not known")                                               \
    X(106, GUARD_TURN_HELD, WARN, guard,                                                                     \
      "not the turn that the client asks: the body would meet what is seen (S7); value: degrees, or per s")  \
    X(107, GUARD_FREE, OK, guard, "the client's motion is not bounded any more; value: 0")                   \
    X(108, GUARD_REFUSED, WARN, guard, "a command of the client ends here; value: its number")               \
    X(109, GUARD_LOOKS, OK, guard,                                                                           \
      "a bearing ahead is blind: the heading swings so that others see the way; value: degrees to each "     \
      "side")                                                                                                \
    X(110, GUARD_LIMITED, WARN, guard,                                                                       \
      "a setting of the client is beyond what S5 and S7 count on; value: what passes")                       \
    X(111, GUARD_DROPPED, WARN, guard,                                                                       \
      "the client says more than the robot's line carries, or much that is refused; value: commands that "   \
      "were dropped unsaid in the last second")

// All that may be said. A build without guard ports, as of a board, may leave theirs out.
#ifndef ARGUS_WITHOUT_GUARD
#define ARGUS_EVENT_TABLE(X) ARGUS_CORE_EVENT_TABLE(X) ARGUS_GUARD_EVENT_TABLE(X)
#else
#define ARGUS_EVENT_TABLE(X) ARGUS_CORE_EVENT_TABLE(X)
#endif

// What events are about, each once: most are about the same few.
#define ARGUS_ABOUT_TABLE(X) \
    X(battery)               \
    X(bumper)                \
    X(drive)                 \
    X(events)                \
    X(guard)                 \
    X(health)                \
    X(laser)                 \
    X(link)                  \
    X(manager)               \
    X(object)                \
    X(operator)              \
    X(plan)                  \
    X(record)                \
    X(session)               \
    X(sonar)                 \
    X(status)                \
    X(task)

// The subjects by number.
typedef enum {
#define ARGUS_ABOUT_ENUM(subject) ARGUS_ABOUT_##subject,
    ARGUS_ABOUT_TABLE(ARGUS_ABOUT_ENUM)
#undef ARGUS_ABOUT_ENUM
} argus_about_t;

// The events by number.
typedef enum {
#define ARGUS_EVENT_ENUM(id, name, level, subject, meaning) ARGUS_EV_##name = (id),
    ARGUS_CORE_EVENT_TABLE(ARGUS_EVENT_ENUM) ARGUS_GUARD_EVENT_TABLE(ARGUS_EVENT_ENUM)
#undef ARGUS_EVENT_ENUM
} argus_event_id_t;

// One event, as argus_next_event() gives it.
typedef struct {
    uint32_t t_ms; // time of the call that raised it
    uint16_t id;   // argus_event_id_t
    int8_t sonar;  // 0..15, or ARGUS_NO_SONAR
    uint8_t state; // argus_failure_t when it was raised
    int32_t value; // see the catalogue
} argus_event_t;

// State ----------------------------------------------------------------------------------------------------

// A place in the frame of the course.
typedef struct {
    int32_t x_mm; // ahead of where the course starts
    int32_t y_mm; // to the left of it
} argus_point_t;

// A place and a heading in that frame.
typedef struct {
    int32_t x_mm;         // ahead of where the course starts
    int32_t y_mm;         // to the left of it
    int32_t heading_cdeg; // hundredths of a degree, counter-clockwise, above -18000 and up to 18000
} argus_pose_t;

// The health of a sonar. A program that only wants to know whether to use one looks at its kind.
typedef enum {
    ARGUS_UNKNOWN,   // not judged yet
    ARGUS_HEALTHY,   // judged, no complaint
    ARGUS_SUSPECT,   // disparate, not verified yet or no witness
    ARGUS_DISABLED,  // not used; latched for the mission under `paper`
    ARGUS_PROBATION, // (profile argus) may come back
    ARGUS_STALE,     // has not reported yet, or not for long
    ARGUS_ABSENT     // this robot has not got it: neither judged nor planned with
} argus_health_t;

// Kinds of faults, after the failure words of PX4. The numbers are on the wire (SPEC.md, Events) and in the
// record; they follow each other from 1 on. A row: name, number, word, what the sonar does.
#define ARGUS_FAULT_KIND_TABLE(X)                                 \
    X(OFF, 1, "off", "never an echo: reads 5000")                 \
    X(SILENT, 2, "silent", "yields no reading")                   \
    X(STUCK, 3, "stuck", "one value again and again")             \
    X(WRONG, 4, "wrong", "too far, too near, or beside its axis") \
    X(GARBAGE, 5, "garbage", "leaps")                             \
    X(SLOW, 6, "slow", "readings of some firings ago")            \
    X(INTERMITTENT, 7, "intermittent", "gaps")

// A constant for each row of that table, and NONE: no fault. ARGUS_KINDS is how many there are, NONE
// included.
typedef enum {
    ARGUS_KIND_NONE = 0,
#define ARGUS_FAULT_KIND_CONSTANT(name, number, word, meaning) ARGUS_KIND_##name,
    ARGUS_FAULT_KIND_TABLE(ARGUS_FAULT_KIND_CONSTANT)
#undef ARGUS_FAULT_KIND_CONSTANT
        ARGUS_KINDS
} argus_fault_kind_t;

// The failure state over the forward-facing sonars (paper: Fig. 6).
typedef enum {
    ARGUS_IS_NORMAL,      // none disabled
    ARGUS_IS_MINOR,       // a third of them at most: 1 or 2 of six
    ARGUS_IS_MAJOR,       // more, but not all: 3 to 5 of six
    ARGUS_IS_CATASTROPHIC // all
} argus_failure_t;

#define ARGUS_ROTATIONS_MAX 6 // of one plan: one for each forward-facing sonar

// Rotations by which the healthy sonars cover for the disabled ones (paper: Tables IV and V).
typedef struct {
    argus_mask_t disabled;                     // the fault map it is for: forward-facing sonars only
    argus_mask_t looks;                        // those that may look along their bearings
    uint8_t count;                             // rotations
    int16_t rotation_deg[ARGUS_ROTATIONS_MAX]; // in the order of visit, CCW positive
    bool return_each; // back to the heading after each rotation's reading (policy paper), else one pass
    bool complete;    // every disabled bearing is covered
} argus_plan_t;

// What the manager is doing. Order is not severity.
typedef enum {
    ARGUS_MODE_OFFLINE,   // no session with a robot
    ARGUS_MODE_CHECKING,  // at rest: every forward-facing sonar must report before anything moves (S6)
    ARGUS_MODE_VERIFYING, // a look: turns neighbours onto a suspect's bearing
    ARGUS_MODE_IDLE,      // healthy enough, nothing to do
    ARGUS_MODE_DRIVING,   // normal driving
    ARGUS_MODE_SWEEPING,  // failure mode, at rest: turns through the plan's rotations
    ARGUS_MODE_STEPPING,  // failure mode: one step ahead
    ARGUS_MODE_BACKING,   // backs away from a pressed bumper or a blocked swing circle
    ARGUS_MODE_WAITING,   // cannot go on by itself: bumper, motors off, no way, catastrophic
    ARGUS_MODE_CLOSING,   // shutdown: stopping, then closing the session
    ARGUS_MODE_CLOSED,    // over
    ARGUS_MODE_CREEPING   // no sonar sees the way: slowly, on the bumpers alone
} argus_mode_t;

// How the course stands.
typedef enum {
    ARGUS_MISSION_NONE,
    ARGUS_MISSION_RUNNING,
    ARGUS_MISSION_REACHED,
    ARGUS_MISSION_FAILED
} argus_mission_t;

// Why the manager waits (mode WAITING).
typedef enum {
    ARGUS_WAIT_NONE,
    ARGUS_WAIT_BUMPER,
    ARGUS_WAIT_MOTORS,
    ARGUS_WAIT_TURN,         // the swing circle is blocked (S7)
    ARGUS_WAIT_WAY,          // every heading is blocked
    ARGUS_WAIT_CATASTROPHIC, // all forward-facing sonars are disabled
    ARGUS_WAIT_ECHO          // it touched something while no sonar ahead had ever heard an echo
} argus_wait_t;

// Why the robot that answered may not be driven. A course fails then; ARGUS_OP_ACTIVE takes the last one on.
typedef enum {
    ARGUS_BAR_NONE,
    ARGUS_BAR_UNKNOWN, // its body is not known: the setting `robot` says it
    ARGUS_BAR_UNSAFE,  // the settings are unsafe for it (S5)
    ARGUS_BAR_SONARS   // it lists sonars that its subclass has not got
} argus_bar_t;

// What an operator may ask. The argument is mm for MOVE, degrees for TURN, a sonar (0..15) for RETEST and
// what follows it, else ignored. PIN, UNPIN and DISABLE are for profile argus.
typedef enum {
    ARGUS_OP_STOP = 1, // stop and stay: the course is paused
    ARGUS_OP_GO,       // (re)start the course
    ARGUS_OP_RECHECK,  // full health check, suspects verified
    ARGUS_OP_MOVE,     // jog: at most step_mm ahead or backoff_mm back, with every safety rule in force
    ARGUS_OP_TURN,     // jog: turn on the spot, -180..180
    ARGUS_OP_PASSIVE,  // stop, then only report
    ARGUS_OP_ACTIVE,
    ARGUS_OP_RETEST, // forget the evidence against a sonar and look at it again
    ARGUS_OP_PIN,    // a sonar keeps its health, whatever it reads, until it is unpinned or yields nothing
    ARGUS_OP_UNPIN,  // the evidence decides again
    ARGUS_OP_DISABLE // take a sonar out of use (wrong) and pin it
} argus_op_t;

// A copy of everything a screen, a log or a test wants to see.
typedef struct {
    uint8_t mode;           // argus_mode_t: what it is doing
    uint8_t mission;        // argus_mission_t: how the course stands
    uint8_t wait;           // argus_wait_t: why, in mode WAITING, else ARGUS_WAIT_NONE
    uint8_t bar;            // argus_bar_t: why this robot may not be driven
    uint8_t failure;        // argus_failure_t, of the sonars that face forward
    argus_plan_t plan;      // how the healthy ones cover for those
    argus_pose_t pose;      // by odometry
    int32_t goal_mm;        // straight-line distance to the last waypoint, 0 without a course
    uint16_t waypoint;      // next waypoint, from 0
    uint16_t waypoints;     // of the course
    bool reversed;          // the rear leads; what is in the robot's frame is as it is built nonetheless
    bool active;            // false: passive
    bool paused;            // by the operator's STOP
    bool open;              // there is a session with a robot
    bool online;            // ... and SIPs are coming
    bool motors;            // on, as the robot says
    bool lists_all;         // the server lists every sonar in every SIP
    uint16_t battery_dv;    // decivolts
    int16_t vel_left_mm_s;  // of the left wheel, as the robot says
    int16_t vel_right_mm_s; // of the right one
    uint16_t flags;         // of the SIP
    uint8_t bumpers_front;  // bits 1..5, bit 1 leftmost
    uint8_t bumpers_rear;   // likewise
    uint8_t sonars;         // that are managed, from 0: those beyond are ABSENT
    argus_mask_t forward;   // those that face forward, of the leading end
    int16_t bearing_deg[ARGUS_SONARS]; // whither each looks, robot frame
    uint16_t reading_mm[ARGUS_SONARS]; // as on the wire; 0: never reported, or so read
    uint32_t age_ms[ARGUS_SONARS];     // UINT32_MAX: never reported
    uint32_t readings[ARGUS_SONARS];   // monotonic
    uint8_t health[ARGUS_SONARS];      // argus_health_t, for people; a program looks at kind
    uint8_t kind[ARGUS_SONARS];        // argus_fault_kind_t: ARGUS_KIND_NONE: to be used; else not
    argus_mask_t pinned;               // sonars whose health an operator has fixed, a mask
    uint32_t packets;                  // with a right checksum; monotonic counters, like what follows
    uint32_t sips;                     // of those
    uint32_t bad_checksums;            // packets with a wrong one
    uint32_t skipped_bytes;            // of no packet
    uint32_t stops;                    // STOP and E_STOP that were sent
    const char *robot_name;     // identity from the SYNC2 reply, "" before; they live as long as the instance
    const char *robot_class;    // likewise
    const char *robot_subclass; // likewise
    const char *robot_body;     // whose geometry holds: a choice of the setting `robot`, "" if not known
    bool has_configpac;         // its CONFIGpac came: what follows is its own word, else "" and 0
    const char *robot_version;  // of its firmware
    const char *robot_serial;   // its serial number
    uint16_t robot_watchdog_ms; // after so long a silence it stops by itself
    uint16_t robot_sonar_cycle_ms; // between two pings of one array
} argus_status_t;

// How far the evidence against each sonar is on its way to a verdict (profile argus; else all is 0).
typedef struct {
    uint8_t kind[ARGUS_SONARS];         // argus_fault_kind_t that explains it best so far, NONE: none
    uint8_t percent[ARGUS_SONARS];      // 100: a verdict
    argus_mask_t against[ARGUS_SONARS]; // sonars that contradict it, a mask
} argus_suspicions_t;

// What argus_name() names.
typedef enum {
    ARGUS_NAME_EVENT,   // argus_event_id_t: SONAR_DEAD
    ARGUS_NAME_SUBJECT, // argus_event_id_t: what it is about, sonar
    ARGUS_NAME_LEVEL,   // argus_level_t: WARN
    ARGUS_NAME_MODE,    // argus_mode_t: DRIVING
    ARGUS_NAME_MISSION, // argus_mission_t: running
    ARGUS_NAME_WAIT,    // argus_wait_t: bumper
    ARGUS_NAME_FAILURE, // argus_failure_t: IsMinor
    ARGUS_NAME_HEALTH,  // argus_health_t: SUSPECT
    ARGUS_NAME_KIND,    // argus_fault_kind_t: stuck; "" for none
    ARGUS_NAME_OP,      // argus_op_t: RECHECK
    ARGUS_NAME_BAR      // argus_bar_t: unsafe; "" for none
} argus_name_of_t;

// A ring of the caller's own -------------------------------------------------------------------------------

// What a sonar is for. A number, since it is data: a ring may come out of a file.
#define ARGUS_ROLE_NONE 0   // it is judged, and its readings count as echoes
#define ARGUS_ROLE_AHEAD 1  // sees what the robot drives into
#define ARGUS_ROLE_ASTERN 2 // ... what it backs into
#define ARGUS_ROLE_ABEAM 3  // looks to a side

// Where a sonar stands and looks, in the frame of the robot, whose origin is its centre of rotation.
typedef struct {
    int16_t x_mm;        // ahead
    int16_t y_mm;        // to the left
    int16_t heading_deg; // counter-clockwise, above -180 and up to 180
    uint8_t role;        // ARGUS_ROLE_
} argus_sonar_mount_t;

#define ARGUS_FORWARD_SONARS 6 // that face forward, at most

// X(key, section, default, minimum, maximum, meaning): the figures of a ring. 0 stands for the default; where
// that is 0, too, it is worked out of the others, or it must be given (its minimum is above 0). `section` is
// that of a file.
#define ARGUS_RING_BODY_TABLE(X)                                                                         \
    X(front_mm, body, 0, 1, 3000, "from the centre of rotation to the front of the body")                \
    X(rear_mm, body, 0, 1, 3000, "... to its rear")                                                      \
    X(width_mm, body, 0, 1, 3000, "of the body")                                                         \
    X(swing_radius_mm, body, 0, 0, 4500, "to its farthest corner; else that of a rectangle")             \
    X(sonar_face_mm, body, 0, 0, 3000, "x of the foremost sonars; else that of those that face forward") \
    X(tolerance_centre_mm, body, 0, 0, 3000, "a2 of the paper's eq. 2; else sonar_face_mm")              \
    X(front_bumpers, body, 0, 0, 7, "segments, 0: no bumper")                                            \
    X(rear_bumpers, body, 0, 0, 7, "likewise")                                                           \
    X(decel_mm_s2, motion, 300, 50, 5000, "that the robot brakes with unless set otherwise")             \
    X(track_mm, motion, 0, 0, 3000, "between the wheels; else width_mm")                                 \
    X(dist_conv_um, odometry, 1000, 1, 30000, "what one unit of position is")                            \
    X(min_mm, sonar, 100, 1, 1000, "the least that a sonar reads")                                       \
    X(no_echo_mm, sonar, 5000, 500, 5000, "a reading of this or more: nothing was heard")                \
    X(cone_deg, sonar, 30, 5, 90, "that a sonar sees")                                                   \
    X(cycle_ms, sonar, 40, 20, 120, "between two pings of one array, each after the other")
// ... of a laser beside the sonars, or alone; a build that manages more than 16 sensors takes one.
#define ARGUS_RING_LASER_TABLE(X)                                                                          \
    X(sectors, laser, 0, 0, 32, "of a laser's scan; they are sensors after the last sonar, left to right") \
    X(field_deg, laser, 180, 2, 360, "that they share, whole degrees each")                                \
    X(facing_deg, laser, 0, -180, 180, "middle of it, counter-clockwise from ahead")                       \
    X(ahead_mm, laser, 0, -3000, 3000, "of the laser, from the centre of rotation")                        \
    X(aside_mm, laser, 0, -3000, 3000, "... to the left")                                                  \
    X(guards, laser, 0, 0, 1, "1: they see what the robot drives into; of a laser alone they do")
// All of them.
#define ARGUS_RING_TABLE(X) ARGUS_RING_BODY_TABLE(X) ARGUS_RING_LASER_TABLE(X)

// A ring and the body that carries it.
typedef struct {
    const char *name; // 1 to 15 letters, for status and logs
#define ARGUS_RING_FIELD(key, section, def, min, max, meaning) int32_t key;
    ARGUS_RING_TABLE(ARGUS_RING_FIELD)
#undef ARGUS_RING_FIELD
    const argus_sonar_mount_t *mounts;     // of each sonar; eight in turn are one array, which fires in turn
    uint8_t sonars;                        // how many, up to ARGUS_SONARS
    uint8_t forward[ARGUS_FORWARD_SONARS]; // those that face forward, left to right
    uint8_t forward_count;                 // 2 to 6
} argus_ring_t;

// X(id, NAME, meaning): why a ring is refused.
#define ARGUS_RING_FAULT_TABLE(X)                                                                            \
    X(0, OK, "nothing is wrong")                                                                             \
    X(1, NAME, "a name has 1 to 15 letters")                                                                 \
    X(2, FIGURE, "the figure is missing, or out of its range")                                               \
    X(3, SONARS, "this build manages fewer sonars, or there is none")                                        \
    X(4, BESIDE, "the sonar stands beside the body")                                                         \
    X(5, BEARING, "the sonar's heading is not above -180 and up to 180 degrees")                             \
    X(6, ROLE, "there is no such role")                                                                      \
    X(7, ALIKE, "the sonar stands and looks as one before it")                                               \
    X(8, FORWARD, "forward has 2 to 6 sonars with the role ahead")                                           \
    X(9, ORDER, "forward goes from left to right, with less than 60 degrees between neighbours")             \
    X(10, TURNS, "more than 24 different turns put a sonar onto a bearing ahead: fewer must face forward")   \
    X(11, SWING, "S7: the swing circle is within the body, or farther than the sonars see")                  \
    X(12, UNSAFE,                                                                                            \
      "S5: with these settings the robot meets what it sees before it stands: lower speed_mm_s or step_mm, " \
      "or raise object_range_mm or check_range_mm")                                                          \
    X(13, SECTORS, "sectors of a laser are whole degrees wide, and sonars before them fill arrays of eight")

// The faults by number.
typedef enum {
#define ARGUS_RING_FAULT_ENUM(id, name, meaning) ARGUS_RING_##name = (id),
    ARGUS_RING_FAULT_TABLE(ARGUS_RING_FAULT_ENUM)
#undef ARGUS_RING_FAULT_ENUM
} argus_ring_fault_t;

// What is wrong with a ring.
typedef struct {
    int32_t fault; // argus_ring_fault_t: the first that was found
    int32_t key;   // row of ARGUS_RING_TABLE that it is about, else -1
    int32_t sonar; // that it is about, else -1
} argus_ring_report_t;

// A robot as the manager keeps it, made of a ring.
typedef struct argus_robot argus_robot_t;

// Bytes of one.
#define ARGUS_ROBOT_BYTES (200 + 6 * ARGUS_SONARS)

// Memory of one robot, the caller's: it lives as long as the instance.
typedef union {
    uint64_t align;                   // as strict as any member within
    uint8_t bytes[ARGUS_ROBOT_BYTES]; // the library's own
} argus_robot_storage_t;

// Ranges without ARCOS -------------------------------------------------------------------------------------

// One range of a sonar.
typedef struct {
    uint8_t sonar;     // its number
    uint16_t range_mm; // the robot's no_echo_mm or more: nothing was heard
    uint16_t age_ms;   // since it was measured; one older than ARGUS_RANGE_OLD_MS is left out
} argus_range_t;

#define ARGUS_RANGE_OLD_MS 250 // the robot has moved on since

// What any robot knows of itself at one time.
typedef struct {
    argus_pose_t pose;           // by its odometry; any origin
    int32_t speed_mm_s;          // ahead
    int32_t turn_cdeg_s;         // hundredths of a degree a second, counter-clockwise
    const argus_range_t *ranges; // measured since the last call, each once: what is repeated is no news
    uint8_t count;               // how many
} argus_observation_t;

// Instance -------------------------------------------------------------------------------------------------

// Bytes of one manager.
#define ARGUS_STORAGE_BYTES (14300 + 812 * ARGUS_SONARS + (ARGUS_SONARS > 16 ? 4000 : 0))

// Memory of one manager, the caller's: static, on a stack that is large enough, or part of something else.
// Its contents are the library's own.
typedef union {
    uint64_t align;                     // as strict as any member within
    uint8_t bytes[ARGUS_STORAGE_BYTES]; // the library's own
} argus_storage_t;

// One manager, inside the storage given to argus_init(). Its members are the library's own.
typedef struct argus argus_t;

// Guard port -----------------------------------------------------------------------------------------------

// What a client gets of the readings of sonars that are out.
typedef enum {
    ARGUS_READINGS_WITHHOLD, // nothing: they are left out of the SIP's list
    ARGUS_READINGS_COVER,    // what a trusted sonar has heard within the cone lately; else nothing
    ARGUS_READINGS_PASS      // as they are
} argus_readings_t;

// What has come since the last pass, and room for what goes to the client.
typedef struct {
    uint8_t readings;      // argus_readings_t, of sonars that are out
    bool there;            // a client is at the port
    const uint8_t *client; // its bytes
    size_t client_count;   // how many
    const uint8_t *robot;  // the robot's, which argus_receive() has just taken
    size_t robot_count;    // how many
    uint8_t *out;          // where bytes for the client go
    size_t capacity;       // how many fit
} argus_port_io_t;

// Bytes of one guard port.
#define ARGUS_PORT_BYTES 2600

// Memory of one port, the caller's; all zero at the start.
typedef union {
    uint64_t align;                  // as strict as any member within
    uint8_t bytes[ARGUS_PORT_BYTES]; // the library's own
} argus_port_storage_t;

// Functions ------------------------------------------------------------------------------------------------

// Every setting at its default. Cost: one copy.
void argus_config_default(argus_config_t *config);

// Ranges first, then the two S5 inequalities, for the robot that the setting `robot` names (by-subclass: for
// p3dx-sh; when another one answers, ARGUS_AUTO is worked out and S5 asked again for that one). Cost: a few
// thousand integer operations, once at start.
argus_config_report_t argus_config_check(const argus_config_t *config);

// A symbol with the number of sonars in its name: a program that was built with another ARGUS_SONARS than the
// library does not link.
#define ARGUS_TAG_JOINED(name, sonars) name##_for_##sonars##_sonars

// Likewise, with `sonars` expanded.
#define ARGUS_TAG(name, sonars) ARGUS_TAG_JOINED(name, sonars)

// Tagged: its storage has a size for each number of sonars.
#define argus_init ARGUS_TAG(argus_init, ARGUS_SONARS)

// Starts from nothing: no robot, every sonar UNKNOWN, no course. `config` is copied; it should have passed
// argus_config_check(), otherwise the manager starts passive and stays so. The result is in `storage`. Cost:
// the storage is cleared once.
argus_t *argus_init(argus_storage_t *storage, const argus_config_t *config, uint32_t now_ms);

// After argus_init(), before argus_link_up(): the robot has this ring and body, whatever it says of itself;
// it stands above the setting `robot`. The ring is copied into `storage`. Where the report names a fault
// nothing is changed. Without an instance it only checks, with the settings at their defaults. Cost: a few
// thousand integer operations.
argus_ring_report_t argus_set_ring(argus_t *self, argus_robot_storage_t *storage, const argus_ring_t *ring);

// The course: 1..ARGUS_WAYPOINTS_MAX points in the frame of the robot's odometry at connection (x ahead, y
// left, mm, each |v| <= ARGUS_COURSE_LIMIT_MM). False, and nothing changed, when it does not fit. Driving
// starts by itself when active and checked. Cost: one copy of the points.
bool argus_set_course(argus_t *self, const argus_point_t *points, uint16_t count);

// The wire is open: the manager looks for a robot on it. Cost: constant.
void argus_link_up(argus_t *self, uint32_t now_ms);

// The wire is gone: what waits to be sent is dropped, and the session with it. Cost: constant.
void argus_link_lost(argus_t *self, uint32_t now_ms);

// Takes any number of received bytes, none too. A STOP that they call for is ready in argus_transmit() when
// this returns. Cost: one pass over the bytes, and for each SIP in them the diagnosis: at most some 490,000
// instructions of a Cortex-M4 (docs/flash.md).
void argus_receive(argus_t *self, uint32_t now_ms, const uint8_t *bytes, size_t count);

// Beside argus_receive(), for a robot that speaks no ARCOS: pose, speeds and ranges go in, the same events
// come out. Some ten times a second. The manager only listens then: argus_transmit() has nothing. The body is
// that of argus_set_ring(), or of the setting `robot`. After link_lost_ms without a call the session is lost,
// the next call opens another. False: after argus_shutdown(), or without a body (event SUBCLASS_UNKNOWN), as
// nothing is judged then. Cost: as of a SIP.
bool argus_observe(argus_t *self, uint32_t now_ms, const argus_observation_t *observation);

// Does what time alone makes due; returns the ms (1..100) after which it wants to be called again. Cost: much
// less than a SIP.
uint32_t argus_process(argus_t *self, uint32_t now_ms);

// Next packet to write, whole, at most ARGUS_PACKET_MAX bytes; 0 when there is none. A buffer too small: 0.
// Cost: one copy of the packet.
size_t argus_transmit(argus_t *self, uint8_t *buffer, size_t capacity);

// The oldest event that was not taken yet; false: none. What does not fit the queue is counted,
// and an event says how many. Cost: constant.
bool argus_next_event(argus_t *self, argus_event_t *event);

// False, and no event, when it cannot be done now: after argus_shutdown(), for a sonar that there is not or
// that is pinned (or not), for what the profile has not. Nor is a jog in another mode than IDLE, or while
// passive. Cost: at most one search for a way.
bool argus_operator(argus_t *self, uint32_t now_ms, argus_op_t op, int32_t argument);

// Stops the robot, then sends SONAR 0, STOP, CLOSE. Cost: constant.
void argus_shutdown(argus_t *self, uint32_t now_ms);

// True when the last byte after argus_shutdown() is out, within 3 s of it. Cost: constant.
bool argus_closed(const argus_t *self);

// A port at which another client of the robot is served as by the robot itself, bounded (SPEC.md, Guard
// port). Call it after each argus_receive(), when the client has sent something, and after argus_process();
// then argus_transmit(). Returns the bytes for the client; call again, with no bytes, until 0. Cost: one pass
// over the bytes; for each SIP what argus_guard asks of the way, see bench guardian.
size_t argus_guard_port(argus_t *core, argus_port_storage_t *storage, uint32_t now_ms,
                        const argus_port_io_t *io);

// Cost: one copy of some 500 bytes.
void argus_status(const argus_t *self, argus_status_t *status);

// Apart from the status, so that only a caller that shows it pays. Cost: some twenty comparisons for each
// sonar.
void argus_suspicions(const argus_t *self, argus_suspicions_t *suspicions);

// Writes the persistent record: what is known of every sonar (SPEC.md). Returns its length, 0 if it does not
// fit; ARGUS_RECORD_MAX is enough. Cost: one pass over the sonars and a checksum.
size_t argus_record_save(const argus_t *self, uint8_t *buffer, size_t capacity);

// Takes a record, before a session opens; under `argus` a sonar that was out in it starts on PROBATION. False
// for a damaged or foreign one, which an event tells of. A record of another robot is taken back once a
// session is open. Cost: one pass and a checksum.
bool argus_record_load(argus_t *self, const uint8_t *record, size_t length);

// 0 when every internal invariant holds, else the number of the first that does not. For supervisors, tests,
// fuzzers. Cost: one pass over the sonars.
int argus_invariants_broken(const argus_t *self);

// Names and levels are static data; an unknown number is "?" and ARGUS_LEVEL_ERROR. What else the catalogue
// of events and the table of settings hold a program can build from their X-macros. Cost: one pass over a
// table.
const char *argus_name(argus_name_of_t of, int number);

// Of each event in one number: its id in 7 bits, its level in 2, and what it is about.
#define ARGUS_EVENT_ID_MASK 0x7F
#define ARGUS_EVENT_LEVEL_SHIFT 7 // where the level begins
#define ARGUS_EVENT_ABOUT_SHIFT 9 // where the subject begins
// A row of the catalogue as such a number.
#define ARGUS_EVENT_PACKED(number, name, level, subject, meaning) \
    (number) | ARGUS_LEVEL_##level << ARGUS_EVENT_LEVEL_SHIFT |   \
        ARGUS_ABOUT_##subject << ARGUS_EVENT_ABOUT_SHIFT,

// The level of an event. Cost: one pass over the catalogue.
static inline argus_level_t argus_event_level(uint16_t id) {
    static const uint16_t rows[] = {ARGUS_EVENT_TABLE(ARGUS_EVENT_PACKED)};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if ((rows[i] & ARGUS_EVENT_ID_MASK) == id) {
            return (argus_level_t)(rows[i] >> ARGUS_EVENT_LEVEL_SHIFT & 3);
        }
    }
    return ARGUS_LEVEL_ERROR;
}

#ifdef __cplusplus
}
#endif

#endif
