// SPDX-License-Identifier: MIT
// Rule under attack: no order of events leads to a dead end, and none makes the robot move that must stand:
// each sequence of these inputs up to a depth, from each state of the mode machine that another one has not
// reached.
#include "supervisor/modes.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robot.h"
#include "unity.h"

#define STATES_MOST 20000
#define STEP_MS 1500
#define RELIEF_MS 60000
#define GO_EVERY_MS 15000
#define LINE offsetof(robot_t, line)
#define AFTER_LINE offsetof(robot_t, before_sip)
#define AFTER_LINE_BYTES (offsetof(robot_t, command) - AFTER_LINE)
#define AFTER_OUT offsetof(robot_t, reply)
#define AFTER_OUT_BYTES (sizeof(robot_t) - AFTER_OUT)

typedef enum {
    WAIT,
    FRONT,
    REAR,
    STALL,
    SILENCE,
    LOST,
    BUTTON,
    NEAR,
    ONE_OFF,
    FRONT_OFF,
    COURSE,
    STOP,
    GO,
    RECHECK,
    AHEAD,
    BACK,
    TURN,
    PASSIVE,
    ACTIVE,
    SHUTDOWN,
    INPUTS
} input_t;

// What tells two states apart.
typedef struct {
    uint8_t mode, wait, mission, bar, failure, paused, active, open, online, motors, front, rear, stall, mute,
        button;
    uint8_t near, faults, stands;
} mode_key_t;

typedef struct {
    mode_key_t key;
    uint8_t depth;
    int from;
    input_t by;
    uint8_t *bytes; // of the robot, without what came out
} state_t;

static robot_t robot;
static state_t state[STATES_MOST];
static int states;
static int waiting[ARGUS_WAIT_ECHO + 1]; // states from which it waits for a person, by what for
static bool near;
static char text[600];

static int world(const robot_t *r, int sonar) {
    (void)r;
    return near && (sonar == 3 || sonar == 4) ? 220 : 2600;
}

static uint32_t now(void) {
    return robot.start_ms + robot.t_ms;
}

static mode_key_t key_of(void) {
    argus_status_t status;
    argus_status(&robot.argus, &status);
    mode_key_t key;
    memset(&key, 0, sizeof key);
    key.mode = status.mode, key.wait = status.wait, key.mission = status.mission, key.bar = status.bar;
    key.failure = status.failure, key.paused = status.paused, key.active = status.active,
    key.open = status.open;
    key.online = status.online, key.motors = status.motors, key.front = robot.bumpers_front != 0;
    key.rear = robot.bumpers_rear != 0, key.stall = robot.stall, key.mute = robot.mute;
    key.button = robot.stop_button, key.near = near, key.stands = !robot.moving && !robot.turning;
    for (int i = 0; i < 8; i++) {
        key.faults = (uint8_t)(key.faults + (robot.fault[i] != ROBOT_OK));
    }
    return key;
}

static uint8_t *save(void) {
    uint8_t *bytes = malloc(LINE + AFTER_LINE_BYTES + AFTER_OUT_BYTES + 1);
    TEST_ASSERT_NOT_NULL(bytes);
    memcpy(bytes, &robot, LINE);
    memcpy(bytes + LINE, (uint8_t *)&robot + AFTER_LINE, AFTER_LINE_BYTES);
    memcpy(bytes + LINE + AFTER_LINE_BYTES, (uint8_t *)&robot + AFTER_OUT, AFTER_OUT_BYTES);
    bytes[LINE + AFTER_LINE_BYTES + AFTER_OUT_BYTES] = near;
    return bytes;
}

static void restore(const uint8_t *bytes) {
    memcpy((void *)&robot, bytes, LINE);
    memcpy((uint8_t *)&robot + AFTER_LINE, bytes + LINE, AFTER_LINE_BYTES);
    memcpy((uint8_t *)&robot + AFTER_OUT, bytes + LINE + AFTER_LINE_BYTES, AFTER_OUT_BYTES);
    near = bytes[LINE + AFTER_LINE_BYTES + AFTER_OUT_BYTES] != 0;
    robot.commands = robot.events = 0;
}

static void set_faults(int from, int to) {
    const robot_fault_t fault = robot.fault[from] == ROBOT_OK ? ROBOT_OFF : ROBOT_OK;
    for (int i = from; i <= to; i++) {
        robot.fault[i] = fault;
    }
}

static void operate(argus_op_t op, int32_t argument) {
    argus_operator(&robot.argus, now(), op, argument);
    robot_drain(&robot);
}

static void touch(const input_t input) {
    switch (input) {
    case FRONT:
        robot.bumpers_front = robot.bumpers_front != 0 ? 0 : 0x08;
        break;
    case REAR:
        robot.bumpers_rear = robot.bumpers_rear != 0 ? 0 : 0x08;
        break;
    case STALL:
        robot.stall = !robot.stall;
        break;
    case SILENCE:
        robot.mute = !robot.mute;
        break;
    case BUTTON:
        robot.stop_button = !robot.stop_button;
        robot.motors = robot.motors && !robot.stop_button;
        break;
    case NEAR:
        near = !near;
        break;
    case ONE_OFF:
        set_faults(3, 3);
        break;
    case FRONT_OFF:
        set_faults(0, 7);
        break;
    default:
        break;
    }
}

static void order(const input_t input) {
    static const argus_op_t ops[INPUTS] = {
        [STOP] = ARGUS_OP_STOP,       [GO] = ARGUS_OP_GO,        [RECHECK] = ARGUS_OP_RECHECK,
        [AHEAD] = ARGUS_OP_MOVE,      [BACK] = ARGUS_OP_MOVE,    [TURN] = ARGUS_OP_TURN,
        [PASSIVE] = ARGUS_OP_PASSIVE, [ACTIVE] = ARGUS_OP_ACTIVE};
    static const int32_t arguments[INPUTS] = {[AHEAD] = 200, [BACK] = -150, [TURN] = 90};
    if (input == COURSE) {
        robot_goal(&robot, 20000, 0);
    } else if (input == LOST) {
        argus_link_lost(&robot.argus, now());
        robot_drain(&robot);
    } else if (input == SHUTDOWN) {
        argus_shutdown(&robot.argus, now());
        robot_drain(&robot);
    } else if (ops[input] != 0) {
        operate(ops[input], arguments[input]);
    }
}

// The inputs that led here.
static void tell_way(int at, const char *what) {
    int length = snprintf(text, sizeof text, "%s; inputs, last first:", what);
    for (; at > 0 && length < 500; at = state[at].from) {
        length += snprintf(text + length, sizeof text - (size_t)length, " %d", (int)state[at].by);
    }
}

static int motions(void) {
    int count = 0;
    for (int i = 0; i < robot.commands; i++) {
        const robot_command_t *c = &robot.command[i];
        count += c->command == ARCOS_CMD_MOVE || c->command == ARCOS_CMD_HEAD ||
                 c->command == ARCOS_CMD_DHEAD ||
                 ((c->command == ARCOS_CMD_VEL || c->command == ARCOS_CMD_RVEL) && c->argument != 0);
    }
    return count;
}

// The operator's stop, passive, an unknown body: before and after such a step nothing may have been moved in
// it. An operator's own step or turn may be under way, or wait for a check.
static bool must_stand(const mode_key_t *k) {
    const bool rests = k->stands && (k->mode == ARGUS_MODE_IDLE || k->mode == ARGUS_MODE_WAITING);
    return k->mode == ARGUS_MODE_OFFLINE || k->mode == ARGUS_MODE_CLOSED ||
           (rests && (k->paused || !k->active || k->bar != 0));
}

static void check(const mode_key_t *before, const input_t input, const int at) {
    const mode_key_t after = key_of();
    const bool jogs = input == AHEAD || input == BACK || input == TURN;
    tell_way(at, robot.violation);
    (void)snprintf(text + strlen(text), 20, ", then %d", (int)input);
    TEST_ASSERT_TRUE_MESSAGE(robot.violation[0] == '\0', text);
    TEST_ASSERT_EQUAL_MESSAGE(0, argus_invariants_broken(&robot.argus), text);
    tell_way(at, "a motion while it must stand");
    TEST_ASSERT_TRUE_MESSAGE(!(must_stand(before) && must_stand(&after) && !jogs) || motions() == 0, text);
    tell_way(at, "an order ahead with the front bumper pressed");
    const bool pressed = before->front && after.front;
    for (int i = 0; i < robot.commands; i++) {
        TEST_ASSERT_FALSE_MESSAGE(
            pressed && robot.command[i].command == ARCOS_CMD_MOVE && robot.command[i].argument > 0, text);
    }
}

static void add(const int from, const input_t by, const uint8_t depth) {
    const mode_key_t key = key_of();
    for (int i = 0; i < states; i++) {
        if (memcmp(&state[i].key, &key, sizeof key) == 0) {
            return;
        }
    }
    TEST_ASSERT_TRUE(states < STATES_MOST);
    state[states++] = (state_t){.key = key, .depth = depth, .from = from, .by = by, .bytes = save()};
}

static bool is_fine(const mode_key_t *key) {
    return key->mode == ARGUS_MODE_DRIVING || key->mode == ARGUS_MODE_STEPPING ||
           key->mission == ARGUS_MISSION_REACHED;
}

// All is let go, and the operator wants it to drive: it does, stands and states for what it waits, or is
// over.
static void relieve(const int at) {
    restore(state[at].bytes);
    robot.bumpers_front = robot.bumpers_rear = 0;
    robot.stall = robot.mute = robot.stop_button = near = false;
    memset(robot.fault, 0, sizeof robot.fault);
    argus_link_up(&robot.argus, now());
    operate(ARGUS_OP_ACTIVE, 0);
    robot_goal(&robot, 20000, 0);
    bool fine = state[at].key.mode >= ARGUS_MODE_CLOSING && state[at].key.mode <= ARGUS_MODE_CLOSED;
    for (uint32_t ms = 0; ms < RELIEF_MS && !fine; ms += STEP_MS) {
        if (ms % GO_EVERY_MS == 0) {
            operate(ARGUS_OP_GO, 0);
        }
        robot_run(&robot, STEP_MS);
        const mode_key_t key = key_of();
        fine = is_fine(&key);
    }
    const mode_key_t key = key_of();
    const bool waits =
        key.open && key.stands && key.mode == ARGUS_MODE_WAITING && key.wait != ARGUS_WAIT_NONE;
    char what[80];
    snprintf(what, sizeof what, "a dead end: mode %d, wait %d, mission %d, bar %d", key.mode, key.wait,
             key.mission, key.bar);
    tell_way(at, what);
    TEST_ASSERT_TRUE_MESSAGE(fine || waits, text);
    if (!fine) {
        waiting[key.wait]++;
    }
}

static void begin(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 0xFFFFF000u);
    robot.world = world;
    near = false;
    robot_run(&robot, 4000);
    states = 0;
    memset(waiting, 0, sizeof waiting);
    add(0, WAIT, 0);
}

static void enumerate(const uint8_t depth) {
    begin();
    for (int at = 0; at < states; at++) {
        for (input_t input = WAIT; state[at].depth < depth && input < INPUTS; input++) {
            restore(state[at].bytes);
            touch(input);
            order(input);
            robot_run(&robot, STEP_MS);
            check(&state[at].key, input, at);
            add(at, input, (uint8_t)(state[at].depth + 1));
        }
    }
    for (int at = 0; at < states; at++) {
        relieve(at);
    }
    bool seen[ARGUS_MODE_CREEPING + 1] = {false};
    for (int at = 0; at < states; at++) {
        seen[state[at].key.mode] = true;
        free(state[at].bytes);
    }
    printf("depth %d, %d inputs: %d states, modes", depth, (int)INPUTS, states);
    for (int mode = 0; mode <= ARGUS_MODE_CREEPING; mode++) {
        if (seen[mode]) {
            printf(" %d", mode);
        }
    }
    printf("; wait for a person:");
    for (int wait = 0; wait <= ARGUS_WAIT_ECHO; wait++) {
        printf(" %d", waiting[wait]);
    }
    printf("\n");
}

void test_two_inputs_lead_to_no_dead_end(void) {
    enumerate(2);
}

void test_four_inputs_lead_to_no_dead_end(void) { // soak
    enumerate(4);
}
