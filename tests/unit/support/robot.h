// SPDX-License-Identifier: MIT
// A robot in memory for the manager's tests: ARCOS session, simple kinematics, sonar schedule, and a watch
// over the invariants.
#ifndef TEST_ROBOT_H
#define TEST_ROBOT_H

#include "supervisor/manager.h"

#define ROBOT_COMMANDS_MAX 40000
#define ROBOT_EVENTS_MAX 40000
#define ROBOT_SEGMENTS_MAX 64
#define ROBOT_SIP_MAX 195
#define ROBOT_LATE_MAX 8192

#define ROBOT_PAST 8
#define ROBOT_HARMS_MAX 8
#define ROBOT_LINE_MAX 8192

// Percent for SCALE and DROPOUT, mm for VALUE, firings (1 to ROBOT_PAST) for SLOW.
typedef enum {
    ROBOT_OK,
    ROBOT_OFF,
    ROBOT_SILENT,
    ROBOT_SCALE,
    ROBOT_VALUE,
    ROBOT_STUCK,
    ROBOT_GARBAGE,
    ROBOT_SLOW,
    ROBOT_DROPOUT
} robot_fault_t;

typedef struct {
    uint32_t t_ms; // since the start
    uint8_t command;
    bool has_argument;
    int32_t argument;
} robot_command_t;

// What happens to one byte on its way; with LATENCY to those behind it, too.
typedef enum {
    ROBOT_DROP,
    ROBOT_FLIP,
    ROBOT_DUPLICATE,
    ROBOT_INSERT,
    ROBOT_DELAY,
    ROBOT_LATENCY,
    ROBOT_HARMS
} robot_harm_kind_t;
// The latter two lie between a client and its guard port (client.h).
typedef enum { ROBOT_TO_ROBOT, ROBOT_TO_MANAGER, ROBOT_TO_GUARD, ROBOT_TO_CLIENT, ROBOT_WAYS } robot_way_t;

typedef struct {
    robot_harm_kind_t kind;
    robot_way_t way;
    uint32_t at; // the byte, on CAN the frame, from the start of the run
    uint32_t
        with; // the bits that FLIP turns, the byte that INSERT puts before it, the ms of DELAY and LATENCY
    uint32_t lasts_ms; // of LATENCY
    uint32_t since_ms; // ... it came up
} robot_harm_t;

// A line between robot and manager that a test may harm, byte by byte; what a robot cannot read it passes
// over.
typedef struct {
    robot_harm_t harm[ROBOT_HARMS_MAX];
    int harms;
    bool can;                     // packets go over ISO-TP
    uint32_t passed[ROBOT_WAYS];  // bytes that entered, or frames
    uint32_t last_ms[ROBOT_WAYS]; // until the last of them arrives: none overtakes another
    size_t held[ROBOT_WAYS];
    uint8_t bytes[ROBOT_WAYS][ROBOT_LINE_MAX];
    uint32_t due_ms[ROBOT_WAYS][ROBOT_LINE_MAX];
    argus_parser_t parser;
    uint32_t heard_ms; // by the robot, for its watchdog
} robot_line_t;

typedef struct robot robot_t;

struct robot {
    argus_t argus;
    uint32_t start_ms;
    uint32_t t_ms;
    // body
    double x, y, th; // mm, radians
    double v, w;     // mm/s, rad/s
    double pushed_w; // rad/s: somebody turns it, and its wheels follow
    double left_mm;  // of a MOVE, signed
    double heading;  // HEAD's target
    bool moving, turning;
    double vel, rvel; // of VEL and RVEL, while neither MOVE nor HEAD
    double setv, accel, decel, setrv, setra, turn_decel;
    double x0, y0, th0; // odometry origin
    double unit_mm;     // per position unit
    uint16_t position_mask;
    double races_mm_s; // a MOVE runs at this, whatever SETV says; 0: it keeps to that
    bool motors, stop_button, stuck_wheels;
    bool deny_motors; // ENABLE 1 has no effect
    bool e_stop_cuts_motors;
    uint8_t bumpers_front, bumpers_rear;
    bool stall;
    // session
    int phase;             // 0..2 SYNC, 3 open
    bool opened;           // with a line: OPEN has come
    bool mute;             // no power, or the wire is cut
    bool ignores[256];     // commands that have no effect
    const uint8_t *config; // data of its CONFIGpac, NULL: it does not answer CONFIG
    size_t config_count;
    bool config_before_sync2, config_after_sync2; // sends it unasked round its answer to SYNC2
    bool tells_settings;                          // answers CONFIG with what it runs with
    int sonar_cycle_ms;                           // of its arrays
    bool has_line; // what is said goes over `line`, and the robot has a watchdog
    robot_line_t line;
    void (*before_sip)(robot_t *robot); // delivers other packets
    size_t (*alter_sip)(uint8_t *data,
                        size_t count); // other data, up to ROBOT_SIP_MAX, instead of the standard
    void (*after)(robot_t *robot, const uint8_t *bytes,
                  size_t count); // sees what the manager has taken; a client then drives, unwatched
    bool host_asleep;            // what it says waits in `late` for robot_wake()
    uint8_t late[ROBOT_LATE_MAX];
    size_t late_count;
    bool sonar_on;
    uint8_t anport; // the analog port that it shows
    const char *subclass;
    uint32_t next_sip_ms;
    uint32_t sips;
    // sonars
    uint8_t order[2][64];
    int order_count[2];
    int order_at[2];
    uint32_t next_ping_ms;
    int pending[16]; // reading not yet reported, -1 none
    int shown[16];   // last reading delivered, -1 none
    bool lists_all;
    int noise_mm;
    robot_fault_t fault[16];
    int fault_value[16];
    int past[16][ROBOT_PAST];                      // what it would have read, newest first
    int (*world)(const robot_t *robot, int sonar); // the truth, mm
    double segment[ROBOT_SEGMENTS_MAX][4];
    int segments;
    uint32_t seed;
    // what came out
    robot_command_t command[ROBOT_COMMANDS_MAX];
    int commands;
    argus_event_t event[ROBOT_EVENTS_MAX];
    int events;
    uint8_t reply[ARGUS_FRAME_TOTAL_MAX]; // first packet after the last SIP
    size_t reply_length;
    // the watch
    bool checked; // HEALTH_CHECK since the session opened or resumed
    bool swept;   // SWEEP since the last step ahead
    uint16_t bumpers_seen;
    int32_t speed_asked_mm_s; // the last SETV
    double closest_mm;        // of any segment to the body's edge
    char violation[256];
};

void robot_init(robot_t *robot, const argus_config_t *config, uint32_t start_ms);
argus_config_t robot_config(void); // the paper's rules
argus_config_t robot_config_of(int32_t profile);
void robot_tick(robot_t *robot); // 10 ms
void robot_run(robot_t *robot, uint32_t ms);
void robot_next_sip(robot_t *robot); // up to and including the delivery of one SIP, and nothing after it
bool robot_until_mode(robot_t *robot, argus_mode_t mode, uint32_t ms);
bool robot_until_event(robot_t *robot, int id, uint32_t ms); // one more such event than there is now
int robot_count_events(const robot_t *robot, int id, int from);
int robot_count_commands(const robot_t *robot, int command, int from);
const robot_command_t *robot_last_command(const robot_t *robot, int command);
const argus_event_t *robot_last_event(const robot_t *robot, int id);
bool robot_goal(robot_t *robot, int x_mm, int y_mm);
void robot_box(robot_t *robot, double x1, double y1, double x2, double y2); // four walls
// Begins in a box that its sonars see, with what robot_config_of() gives for a profile.
void robot_in_box(robot_t *robot, int32_t profile, double x1, double y1, double x2, double y2);
double robot_heading_deg(const robot_t *robot);
uint32_t robot_random(robot_t *robot, uint32_t below);
void robot_deliver(robot_t *robot, const uint8_t *bytes, size_t count);
void robot_drain(robot_t *robot);
void robot_say(robot_t *robot, const uint8_t *data, size_t count);                   // one packet
void robot_put(robot_t *robot, robot_way_t way, const uint8_t *bytes, size_t count); // on the line
size_t robot_taken(robot_t *robot, robot_way_t way, uint8_t *bytes); // up to ROBOT_LINE_MAX that have arrived
void robot_wake(robot_t *robot); // the host reads in one go what came while it was asleep

// Worlds.
int robot_world_far(const robot_t *robot, int sonar); // 2600 mm whatever the bearing: too far to tell slip by
int robot_world_segments(const robot_t *robot, int sonar); // rays to the segments
int robot_world_smooth(const robot_t *r, int sonar); // the first segment: heard where looked at squarely

#endif
