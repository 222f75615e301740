// SPDX-License-Identifier: MIT
// An independent monitor of the safety rules S1 to S8: it sees the wire and the truth, and knows nothing of
// the manager. It is written from SPEC.md, DESIGN.md and docs/driving.md alone; docs/safety-monitor.md has
// its bounds.
#ifndef SAFETY_MONITOR_H
#define SAFETY_MONITOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SAFETY_SONARS 32
#define SAFETY_RAYS 400
#define SAFETY_KEPT 32
#define SAFETY_HEADINGS 16
#define SAFETY_REASON 112
#define SAFETY_BUFFER 512

// number, name, what is broken. The tens of a number are the rule S1 to S8; 9x are orders of an operator.
#define SAFETY_RULES(X)                                                               \
    X(11, S1_UNSEEN, "more than a step with a bearing ahead blind and not looked at") \
    X(12, S1_NO_SONAR, "it translates with no sonar left")                            \
    X(21, S2_BUMPER, "a bumper was pressed in motion, and no STOP followed")          \
    X(22, S2_STALL, "a wheel stalled in motion, and no STOP followed")                \
    X(23, S2_OBJECT, "an object in range on the way, and no STOP followed")           \
    X(24, S2_SILENT, "a sonar ahead fell silent, and no STOP followed")               \
    X(25, S2_NO_SIP, "no SIP, and no STOP followed")                                  \
    X(26, S2_RESUME, "SIPs came again, and old set points were not cancelled first")  \
    X(31, S3_WATCHDOG, "nobody speaks to the robot, and it moves")                    \
    X(41, S4_HEADING, "after a sweep it drives on another heading than before")       \
    X(51, S5_SPEED, "faster than it could stop before what is seen")                  \
    X(52, S5_NO_ECHO, "faster than a step before a sonar ahead has heard an echo")    \
    X(53, S5_BODY, "a body that is not known was told to move")                       \
    X(54, S5_CONTACT, "the body met something on its way")                            \
    X(55, S5_CEILING, "a speed above the highest setting was asked for")              \
    X(61, S6_UNHEARD, "a translation before every sonar ahead had reported")          \
    X(71, S7_BUMPER, "a turn with a bumper pressed")                                  \
    X(72, S7_ECHO, "a turn in which the body would meet what is seen")                \
    X(73, S7_CONTACT, "the body met something in a turn")                             \
    X(74, S7_CIRCLE, "a turn at rest with an echo within the swing circle")           \
    X(81, S8_FRAME, "bytes to the robot that are no packet")                          \
    X(82, S8_COMMAND, "a command that is never sent, or with such an argument")       \
    X(91, STANDS, "it was told to move while an operator holds it")

enum {
#define SAFETY_ENUM(number, name, meaning) SAFETY_##name = (number),
    SAFETY_RULES(SAFETY_ENUM)
#undef SAFETY_ENUM
};

typedef enum { SAFETY_FROM_ROBOT, SAFETY_TO_ROBOT } safety_way_t;

typedef struct {
    double x_mm, y_mm, bearing_deg;
} safety_mount_t;

typedef struct {
    char subclass[16];
    double front_mm, rear_mm, half_mm, mm_per_unit;
    uint32_t sonars;
    uint32_t ahead, astern; // sonars that look there, as bits
    safety_mount_t mount[SAFETY_SONARS];
} safety_body_t;

extern const safety_body_t safety_bodies[];
extern const unsigned safety_body_count;

// What the manager was told; each field is one setting of SPEC.md, but those that say otherwise.
typedef struct {
    int32_t object_range_mm, step_mm, step_speed_mm_s, speed_mm_s, speed_max_mm_s, creep_mm_s;
    int32_t stale_ms, link_stall_ms, sonar_cycle_ms, baud;
    int32_t sonars;    // that the build manages
    int32_t body;      // whose body it has, a row of safety_bodies; -1: that of the subclass that it says
    int32_t guard;     // 1: a client drives by a guard port, so that its velocities pass
    int32_t paper;     // 1: the rules of the paper, whose speed is fixed
    int32_t within_ms; // so long after a SIP the answer to it may stand on this wire; 0: in the same call
    int32_t contact;   // 1: a contact of the body is a violation, also with what no sonar saw
} safety_settings_t;

typedef struct {
    int32_t rule;
    uint32_t t_ms;
    char reason[SAFETY_REASON];
} safety_violation_t;

typedef struct {
    double x, y, deg; // of the odometry; deg is not wrapped
} safety_pose_t;

typedef struct {
    uint32_t t_ms;
    int32_t sonar, range_mm;
    safety_pose_t from;
    double v_mm_s, w_deg_s; // at that time
} safety_ray_t;

// What the manager owes since a SIP: a STOP, or a speed that is not above a limit.
typedef struct {
    int32_t rule;
    uint32_t since_ms;
    double limit_mm_s;
    double free_mm; // a MOVE that is not renewed and ends before that is let be
    char reason[SAFETY_REASON];
} safety_debt_t;

typedef struct {
    uint8_t bytes[SAFETY_BUFFER];
    size_t length;
} safety_stream_t;

typedef struct {
    safety_settings_t set;
    const safety_body_t *body;
    safety_stream_t from, to;
    uint32_t now_ms;
    // The session, and the robot as the last SIP shows it.
    bool open, answered, has_sip, has_pose;
    uint32_t opened_ms, sip_ms, checked_ms; // checked_ms: from when on every sonar ahead must report
    int32_t raw_x, raw_y, raw_deg;
    int32_t origin_sips; // so many more SIPs may be the first that counts from a new origin (SETO)
    safety_pose_t pose;
    double v_mm_s, w_deg_s;
    uint32_t bumpers, stalls; // front segments << 8 | rear; bit 0 left, bit 1 right
    double bumper_deg;        // the heading when the first of them was pressed
    bool reported[SAFETY_SONARS], heard[SAFETY_SONARS];
    uint32_t reported_ms[SAFETY_SONARS];
    safety_ray_t last[SAFETY_SONARS];
    safety_ray_t rays[SAFETY_RAYS];
    uint32_t ray_count;
    // What the robot was told.
    double setv_mm_s, speed_mm_s, rest_mm; // speed and rest have the sign of the way
    bool moves, is_move, turns;
    uint32_t moved_ms; // the last order to move
    bool reversed;     // the rear leads
    double target_deg;
    bool has_spoken;
    uint32_t spoke_ms;
    // What is owed: S2 and S5.
    safety_debt_t debt[6];
    bool resumes, vel_cancelled, rvel_cancelled, stopped_since_sip;
    uint32_t silent; // sonars ahead whose silence was seen
    // S1, S3, S4
    uint32_t lost, doubted, blind;
    double unseen_mm[SAFETY_SONARS], allowed_mm[SAFETY_SONARS];
    double alone_mm;
    bool silence;
    double silence_mm_s;
    bool swept, spoiled;
    double stand_deg[SAFETY_HEADINGS]; // at which it stood since it last drove: the first, then those ordered
    uint32_t stand_count;
    bool held, touching;
    // What was found.
    uint32_t count;
    uint32_t by_rule[100];
    safety_violation_t kept[SAFETY_KEPT];
} safety_t;

// The defaults of SPEC.md.
safety_settings_t safety_defaults(void);
void safety_init(safety_t *self, const safety_settings_t *settings);

// Bytes on the wire, whole packets or parts of them, in the order of time.
void safety_feed(safety_t *self, uint32_t t_ms, safety_way_t way, const uint8_t *bytes, size_t length);

// The robot as it really is: its speeds, the distance of its body to the nearest thing, and whether it
// touches one.
void safety_truth(safety_t *self, uint32_t t_ms, double v_mm_s, double w_deg_s, double gap_mm, bool contact);

// Sonars that are out of use (DISABLED, PROBATION, STALE, ABSENT), and doubted ones (SUSPECT with a kind), as
// bits. What the manager says of itself: without it only sonars that are silent on the wire count as blind.
void safety_health(safety_t *self, uint32_t out, uint32_t doubted);

// An event that the manager says, by its number in SPEC.md: what S4 is about, and which end leads.
void safety_event(safety_t *self, uint32_t t_ms, int32_t id, int32_t value);

// An operator holds it, or the manager is passive: nothing may be told to move from now on, until it is let
// go.
void safety_hold(safety_t *self, uint32_t t_ms, bool holds);

// Time passes: what is owed and late is found.
void safety_tick(safety_t *self, uint32_t t_ms);

const char *safety_meaning(int32_t rule);

// For callers that cannot read this header.
size_t safety_size(void);
size_t safety_settings_size(void);
int32_t safety_body_row(const char *subclass);
uint32_t safety_count(const safety_t *self);
uint32_t safety_count_of(const safety_t *self, int32_t rule);
const safety_violation_t *safety_kept(const safety_t *self, uint32_t index);

#endif
