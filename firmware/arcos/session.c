// SPDX-License-Identifier: MIT
// The ARCOS session as one state machine, driven by packets and by time.
#include "arcos/session.h"

#include <string.h>

#include "arcos/arithmetic.h"

#define LISTEN_MS 250
#define FLUSH_MS 100
#define STEP_MS 500
#define HALT_MAX_MS 3000
#define REST_MM_S 5
#define CONFIG_REPEAT_MS 300
#define CONFIG_WAIT_MS 1000
#define PAUSE_FIRST_MS 500
#define LEAVE_MS 250       // SIPs that come later than a CLOSE tell that it got lost
#define LEAVE_AGAIN_MS 150 // what is on the line comes meanwhile
#define LEAVE_MAX_MS 1500
#define DISLODGE_MAX 3
#define OPENING_SIPS 2
#define PULSES 4u // in the time that the robot's watchdog waits
#define OPENING_ROWS (1u << ARGUS_SETUP_HALT | 1u << ARGUS_SETUP_HALT_TURN | 1u << ARGUS_SETUP_ZERO)

static uint32_t in_state_ms(const argus_session_t *self, uint32_t now_ms) {
    return argus_elapsed_ms(now_ms, self->since_ms);
}

static void enter(argus_session_t *self, uint32_t now_ms, argus_session_state_t state) {
    self->state = state;
    self->since_ms = now_ms;
}

void argus_session_init(argus_session_t *self) {
    memset(self, 0, sizeof *self);
    self->pause_ms = PAUSE_FIRST_MS;
}

static void begin_attempt(argus_session_t *self, uint32_t now_ms) {
    argus_outbox_clear(&self->outbox);
    self->dislodged = 0;
    self->stalled = false;
    if (self->attempts < UINT16_MAX) {
        self->attempts++;
    }
    enter(self, now_ms, ARGUS_SESSION_LISTEN);
}

void argus_session_link_up(argus_session_t *self, uint32_t now_ms) {
    if (self->state != ARGUS_SESSION_DOWN) {
        return;
    }
    self->attempts = 0;
    self->pause_ms = PAUSE_FIRST_MS;
    argus_parser_flush(&self->parser);
    begin_attempt(self, now_ms);
}

void argus_session_link_down(argus_session_t *self) {
    argus_outbox_clear(&self->outbox);
    argus_parser_flush(&self->parser);
    if (self->state == ARGUS_SESSION_LEAVING) {
        self->state = ARGUS_SESSION_CLOSED;
    } else if (self->state != ARGUS_SESSION_CLOSED) {
        self->state = ARGUS_SESSION_DOWN;
    }
}

static unsigned fail(argus_session_t *self, uint32_t now_ms) {
    argus_outbox_clear(&self->outbox);
    enter(self, now_ms, ARGUS_SESSION_PAUSE);
    return ARGUS_SESSION_NO_ANSWER;
}

static unsigned lose(argus_session_t *self, uint32_t now_ms) {
    self->attempts = 0;
    if (self->observed) {
        enter(self, now_ms, ARGUS_SESSION_DOWN);
        return ARGUS_SESSION_DID_LOSE;
    }
    begin_attempt(self, now_ms);
    return ARGUS_SESSION_DID_LOSE;
}

static bool is_syncing(const argus_session_t *self) {
    return self->state >= ARGUS_SESSION_SYNC0 && self->state <= ARGUS_SESSION_SYNC2;
}

static void stop_wheels(argus_session_t *self) {
    argus_outbox_int(&self->outbox, ARCOS_CMD_VEL, 0);
    argus_outbox_int(&self->outbox, ARCOS_CMD_RVEL, 0);
}

static unsigned dislodge(argus_session_t *self, uint32_t now_ms) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_LISTEN || self->state == ARGUS_SESSION_HALT ||
                 is_syncing(self));
    argus_outbox_clear(&self->outbox);
    if (self->dislodged >= DISLODGE_MAX) {
        return fail(self, now_ms);
    }
    self->dislodged++;
    stop_wheels(self);
    argus_outbox_plain(&self->outbox, ARCOS_CMD_CLOSE);
    enter(self, now_ms, ARGUS_SESSION_DISLODGE);
    return ARGUS_SESSION_DID_DISLODGE;
}

static void send_sync(argus_session_t *self, uint32_t now_ms, uint8_t sync) {
    ARGUS_ASSERT(sync <= ARCOS_SYNC_SYNC2);
    argus_outbox_clear(&self->outbox);
    argus_outbox_plain(&self->outbox, sync);
    enter(self, now_ms, (argus_session_state_t)(ARGUS_SESSION_SYNC0 + sync));
}

static void ask_config(argus_session_t *self, uint32_t now_ms) {
    argus_outbox_plain(&self->outbox, ARCOS_CMD_CONFIG);
    self->tried_ms = now_ms;
}

static void open_robot(argus_session_t *self, uint32_t now_ms) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_SYNC2);
    argus_outbox_clear(&self->outbox);
    memset(&self->robot, 0, sizeof self->robot);
    self->has_robot = false;
    self->opening_sips = 0;
    argus_setup_init(&self->setup);
    self->zeros_due = 0;
    self->heard_ms = now_ms;
    argus_outbox_plain(&self->outbox, ARCOS_CMD_OPEN);
    stop_wheels(self);
    argus_outbox_plain(&self->outbox, ARCOS_CMD_SETO);
    self->origin_due = true;
    ask_config(self, now_ms);
    enter(self, now_ms, ARGUS_SESSION_OPENING);
}

static void set_up(argus_session_t *self, const argus_config_t *config) {
    ARGUS_ASSERT(config->decel_mm_s2 > 0 && config->sonar_cycle_ms > 0);
    argus_outbox_t *outbox = &self->outbox;
    argus_outbox_int(outbox, ARCOS_CMD_SETV, config->speed_mm_s);
    argus_outbox_int(outbox, ARCOS_CMD_SETA, config->accel_mm_s2);
    argus_outbox_int(outbox, ARCOS_CMD_SETA, -config->decel_mm_s2);
    argus_outbox_int(outbox, ARCOS_CMD_SETRV, config->turn_speed_deg_s);
    argus_outbox_int(outbox, ARCOS_CMD_SETRA, config->turn_accel_deg_s2);
    argus_outbox_int(outbox, ARCOS_CMD_SETRA, -config->turn_accel_deg_s2);
    argus_outbox_int(outbox, ARCOS_CMD_SONAR, 1);
    if (!self->has_robot || self->robot.sonar_cycle_ms != config->sonar_cycle_ms) {
        argus_outbox_int(outbox, ARCOS_CMD_SONAR_CYCLE, config->sonar_cycle_ms);
    }
}

static bool is_sip(const argus_packet_t *packet) {
    ARGUS_ASSERT(packet->count > 0);
    return packet->data[0] == ARCOS_TYPE_SIP_STATIONARY || packet->data[0] == ARCOS_TYPE_SIP_MOVING;
}

static bool is_reset_notice(const argus_packet_t *packet) {
    ARGUS_ASSERT(packet->count > 0);
    return packet->data[0] == ARCOS_TYPE_RESET_NOTICE || packet->data[0] == ARCOS_TYPE_RESET_NOTICE2;
}

// True when a SIP was decoded into self->sip.
static bool take_sip(argus_session_t *self, uint32_t now_ms, const argus_packet_t *packet) {
    if (!argus_sip_decode(&self->sip, packet)) {
        self->bad_sips++;
        return false;
    }
    self->sips++;
    self->heard_ms = now_ms;
    argus_setup_sip(&self->setup, now_ms, &self->sip);
    return true;
}

static void take_identity(argus_session_t *self, const argus_packet_t *packet) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_SYNC2);
    size_t offset = 1;
    self->name[0] = self->robot_class[0] = self->subclass[0] = '\0';
    if (argus_packet_string(packet, &offset, self->name) &&
        argus_packet_string(packet, &offset, self->robot_class)) {
        argus_packet_string(packet, &offset, self->subclass);
    }
}

// What it runs with after the set-up is ours, not its own.
static void take_late_config(argus_session_t *self, const argus_configpac_t *robot) {
    if (self->has_robot) {
        memcpy(self->robot.serial, robot->serial, sizeof self->robot.serial);
        return;
    }
    self->robot = *robot;
    self->robot.vel_max_mm_s = self->robot.rotvel_max_deg_s = 0;
    self->robot.accel_mm_s2 = self->robot.decel_mm_s2 = 0;
    self->robot.rotaccel_deg_s2 = self->robot.rotdecel_deg_s2 = 0;
}

static void take_config(argus_session_t *self, uint32_t now_ms, const argus_packet_t *packet) {
    ARGUS_ASSERT(packet->data[0] == ARCOS_TYPE_CONFIGPAC);
    argus_configpac_t robot;
    if (!argus_configpac_decode(&robot, packet)) {
        self->unknown_packets++;
        return;
    }
    const bool opening = self->state == ARGUS_SESSION_OPENING;
    argus_setup_told(&self->setup, now_ms, &robot, opening);
    if (opening) {
        self->robot = robot;
    } else {
        take_late_config(self, &robot);
    }
    self->has_robot = true;
    if (self->subclass[0] == '\0') { // some answer SYNC2 with a bare echo
        memcpy(self->name, robot.name, sizeof self->name);
        memcpy(self->robot_class, robot.robot_class, sizeof self->robot_class);
        memcpy(self->subclass, robot.robot_subclass, sizeof self->subclass);
    }
}

static bool turns(int32_t mm_s) {
    return mm_s > REST_MM_S || mm_s < -REST_MM_S;
}

// The old session's SIPs still tell where the robot gets to: it ends when the robot rests, or after some
// time.
static unsigned on_old_session(argus_session_t *self, uint32_t now_ms, const argus_packet_t *packet) {
    const unsigned got = take_sip(self, now_ms, packet) ? ARGUS_SESSION_GOT_SIP : 0;
    if (got == 0 || (!turns(self->sip.vel_left_mm_s) && !turns(self->sip.vel_right_mm_s))) {
        return dislodge(self, now_ms) | got;
    }
    const bool again = self->state == ARGUS_SESSION_HALT;
    if (!again || argus_elapsed_ms(now_ms, self->spoke_ms) >= STEP_MS) { // the first one may have got lost
        argus_outbox_clear(&self->outbox);
        stop_wheels(self);
    }
    if (!again) {
        enter(self, now_ms, ARGUS_SESSION_HALT);
    }
    return got;
}

static unsigned on_sync(argus_session_t *self, uint32_t now_ms, const argus_packet_t *packet) {
    ARGUS_ASSERT(is_syncing(self));
    const int step = (int)self->state - (int)ARGUS_SESSION_SYNC0;
    if (is_sip(packet)) {
        return on_old_session(self, now_ms, packet);
    }
    if (packet->data[0] != step) {
        self->unknown_packets++;
        return 0;
    }
    self->pause_ms = PAUSE_FIRST_MS; // a robot is there
    if (self->state == ARGUS_SESSION_SYNC2) {
        take_identity(self, packet);
        open_robot(self, now_ms);
    } else {
        send_sync(self, now_ms, (uint8_t)(step + 1));
    }
    return 0;
}

static unsigned meet(argus_session_t *self) {
    const char *const texts[ARGUS_IDENTITY_PARTS] = {self->name, self->robot_class, self->subclass,
                                                     self->has_robot ? self->robot.serial : NULL};
    self->differs = (uint8_t)argus_identity_meet(&self->identity, texts);
    if (self->differs == 0) {
        return 0;
    }
    ARGUS_ASSERT(self->differs <= ARGUS_IDENTITY_PARTS);
    return ARGUS_SESSION_OTHER_ROBOT;
}

static unsigned finish_opening(argus_session_t *self, const argus_config_t *config, uint32_t now_ms) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_OPENING && self->opening_sips <= OPENING_SIPS);
    if (self->opening_sips < OPENING_SIPS ||
        (!self->has_robot && in_state_ms(self, now_ms) < CONFIG_WAIT_MS)) {
        return 0;
    }
    const unsigned other = meet(self);
    set_up(self, config);
    self->stalled = false;
    self->pause_ms = PAUSE_FIRST_MS;
    enter(self, now_ms, ARGUS_SESSION_OPEN);
    self->copies = (argus_copies_t){.count = 0};
    self->origin_due = false;
    return ARGUS_SESSION_DID_OPEN | other;
}

static unsigned on_opening(argus_session_t *self, const argus_config_t *config, uint32_t now_ms,
                           const argus_packet_t *packet) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_OPENING);
    unsigned got = 0;
    if (is_sip(packet)) {
        got = take_sip(self, now_ms, packet) ? ARGUS_SESSION_GOT_SIP : 0;
        if (got != 0 && self->opening_sips < OPENING_SIPS) {
            self->opening_sips++;
        }
    } else if (packet->data[0] == ARCOS_TYPE_CONFIGPAC) {
        take_config(self, now_ms, packet);
    } else if (is_reset_notice(packet)) {
        return fail(self, now_ms);
    } else {
        self->unknown_packets++;
    }
    const unsigned opened = finish_opening(self, config, now_ms);
    return opened != 0 ? opened | got : 0;
}

static unsigned resume(argus_session_t *self, uint32_t gap_ms) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_OPEN);
    self->stalled = false;
    self->gap_ms = gap_ms;
    self->zeros_due = 2;
    argus_outbox_drop_motion(&self->outbox);
    return ARGUS_SESSION_DID_RESUME;
}

// A gap may also end before any timer saw it: when it was our own host that stood still.
static unsigned after_gap(argus_session_t *self, const argus_config_t *config, uint32_t gap_ms) {
    if (self->stalled) {
        return ARGUS_SESSION_GOT_SIP | resume(self, gap_ms);
    }
    if (gap_ms >= (uint32_t)config->link_stall_ms) {
        return ARGUS_SESSION_GOT_SIP | ARGUS_SESSION_DID_STALL | resume(self, gap_ms);
    }
    return ARGUS_SESSION_GOT_SIP;
}

static unsigned on_open_sip(argus_session_t *self, const argus_config_t *config, uint32_t now_ms,
                            const argus_packet_t *packet) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_OPEN && is_sip(packet));
    const uint32_t gap_ms = argus_elapsed_ms(now_ms, self->heard_ms);
    if (argus_copies_has(&self->copies, packet)) {
        self->sips++;
        return ARGUS_SESSION_GOT_COPY;
    }
    return take_sip(self, now_ms, packet) ? after_gap(self, config, gap_ms) : 0;
}

static unsigned on_open(argus_session_t *self, const argus_config_t *config, uint32_t now_ms,
                        const argus_packet_t *packet) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_OPEN);
    const uint8_t type = packet->data[0];
    if (is_sip(packet)) {
        return on_open_sip(self, config, now_ms, packet);
    }
    // A robot that answers our PULSE as a SYNC0 has been switched off and on.
    if (is_reset_notice(packet) || (self->stalled && type == ARCOS_TYPE_SYNC0)) {
        self->gap_ms = argus_elapsed_ms(now_ms, self->heard_ms);
        return lose(self, now_ms);
    }
    if (type == ARCOS_TYPE_CONFIGPAC) { // late: its serial number may be news
        take_config(self, now_ms, packet);
        return meet(self);
    }
    self->unknown_packets++;
    return 0;
}

// It still reports: CLOSE did not arrive.
static unsigned close_again(argus_session_t *self, uint32_t now_ms, const argus_packet_t *packet) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_LEAVING);
    if (is_sip(packet) && self->outbox.length == 0 &&
        argus_elapsed_ms(now_ms, self->spoke_ms) >= LEAVE_AGAIN_MS) {
        argus_outbox_plain(&self->outbox, ARCOS_CMD_STOP);
        argus_outbox_plain(&self->outbox, ARCOS_CMD_CLOSE);
    }
    return 0;
}

static unsigned on_packet(argus_session_t *self, const argus_config_t *config, uint32_t now_ms,
                          const argus_packet_t *packet) {
    switch (self->state) {
    case ARGUS_SESSION_LISTEN:
    case ARGUS_SESSION_HALT:
        return is_sip(packet) ? on_old_session(self, now_ms, packet) : 0;
    case ARGUS_SESSION_SYNC0:
    case ARGUS_SESSION_SYNC1:
    case ARGUS_SESSION_SYNC2:
        return on_sync(self, now_ms, packet);
    case ARGUS_SESSION_OPENING:
        return on_opening(self, config, now_ms, packet);
    case ARGUS_SESSION_OPEN:
        return on_open(self, config, now_ms, packet);
    case ARGUS_SESSION_LEAVING:
        return close_again(self, now_ms, packet);
    default:
        return 0;
    }
}

static unsigned drain(argus_session_t *self, const argus_config_t *config, uint32_t now_ms) {
    argus_packet_t packet;
    unsigned bits = 0;
    while (bits == 0 && argus_parser_next(&self->parser, now_ms, &packet)) {
        bits = on_packet(self, config, now_ms, &packet);
    }
    return bits;
}

static bool is_deaf(const argus_session_t *self) {
    return self->state == ARGUS_SESSION_DOWN || self->state == ARGUS_SESSION_CLOSED;
}

unsigned argus_session_receive(argus_session_t *self, const argus_config_t *config, uint32_t now_ms,
                               const uint8_t *bytes, size_t count, size_t *taken) {
    *taken = is_deaf(self) ? count : 0;
    unsigned bits = drain(self, config, now_ms);
    while (bits == 0 && *taken < count) {
        *taken += argus_parser_push(&self->parser, now_ms, bytes + *taken, count - *taken);
        bits = drain(self, config, now_ms);
    }
    ARGUS_ASSERT(*taken <= count);
    return bits;
}

// No order that is lost alone lets the robot's watchdog stop it.
static uint32_t pulse_ms(const argus_session_t *self, const argus_config_t *config) {
    const uint32_t most_ms = self->has_robot ? self->robot.watchdog_ms / PULSES : 0u;
    return most_ms > 0 && most_ms < (uint32_t)config->pulse_ms ? most_ms : (uint32_t)config->pulse_ms;
}

static void pulse(argus_session_t *self, const argus_config_t *config, uint32_t now_ms) {
    if (self->outbox.length > 0 || argus_elapsed_ms(now_ms, self->spoke_ms) < pulse_ms(self, config)) {
        return;
    }
    if (self->stalled) {
        argus_outbox_plain(&self->outbox, ARCOS_CMD_STOP);
    }
    argus_outbox_plain(&self->outbox, ARCOS_CMD_PULSE);
}

static unsigned pause_timer(argus_session_t *self, const argus_config_t *config, uint32_t now_ms) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_PAUSE && config->retry_max_ms > 0);
    const uint32_t longest_ms = (uint32_t)config->retry_max_ms;
    if (in_state_ms(self, now_ms) < self->pause_ms && in_state_ms(self, now_ms) < longest_ms) {
        return 0;
    }
    self->pause_ms = self->pause_ms < longest_ms / 2 ? self->pause_ms * 2 : longest_ms;
    begin_attempt(self, now_ms);
    return 0;
}

static unsigned quiet_timer(argus_session_t *self, uint32_t now_ms, uint32_t wait_ms) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_LISTEN || self->state == ARGUS_SESSION_DISLODGE);
    if (in_state_ms(self, now_ms) >= wait_ms) {
        argus_parser_flush(&self->parser);
        send_sync(self, now_ms, ARCOS_SYNC_SYNC0);
    }
    return 0;
}

// What it was told before it is set up. Another SETO: positions are counted from that one.
static void keep_opening(argus_session_t *self, uint32_t now_ms) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_OPENING);
    const uint8_t before = self->setup.order[ARGUS_SETUP_ZERO].again;
    argus_setup_resend(&self->setup, &self->outbox, now_ms, OPENING_ROWS);
    if (self->setup.order[ARGUS_SETUP_ZERO].again != before) {
        self->opening_sips = 0;
    }
}

static unsigned opening_timer(argus_session_t *self, const argus_config_t *config, uint32_t now_ms) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_OPENING);
    const uint32_t waited_ms = in_state_ms(self, now_ms);
    if (argus_elapsed_ms(now_ms, self->heard_ms) >= (uint32_t)config->link_lost_ms) {
        return fail(self, now_ms);
    }
    if (!self->has_robot && waited_ms < CONFIG_WAIT_MS &&
        argus_elapsed_ms(now_ms, self->tried_ms) >= CONFIG_REPEAT_MS) {
        ask_config(self, now_ms);
    }
    if (waited_ms < CONFIG_WAIT_MS) {
        keep_opening(self, now_ms);
    }
    pulse(self, config, now_ms);
    return finish_opening(self, config, now_ms);
}

static unsigned open_timer(argus_session_t *self, const argus_config_t *config, uint32_t now_ms) {
    ARGUS_ASSERT(config->link_stall_ms > 0 && config->link_lost_ms > 0);
    const uint32_t silent_ms = argus_elapsed_ms(now_ms, self->heard_ms);
    if (silent_ms >= (uint32_t)config->link_lost_ms) {
        self->gap_ms = silent_ms;
        return lose(self, now_ms);
    }
    if (silent_ms >= (uint32_t)config->link_stall_ms && !self->stalled) {
        self->stalled = true;
        self->gap_ms = silent_ms;
        return ARGUS_SESSION_DID_STALL;
    }
    pulse(self, config, now_ms);
    return 0;
}

static unsigned leaving_timer(argus_session_t *self, uint32_t now_ms) {
    ARGUS_ASSERT(self->state == ARGUS_SESSION_LEAVING);
    const uint32_t waited_ms = in_state_ms(self, now_ms);
    const bool drained = self->outbox.length == 0 && argus_elapsed_ms(now_ms, self->spoke_ms) >= LEAVE_MS;
    if (waited_ms >= LEAVE_MAX_MS || (drained && waited_ms >= LEAVE_MS)) {
        argus_outbox_clear(&self->outbox);
        enter(self, now_ms, ARGUS_SESSION_CLOSED);
    }
    return 0;
}

static unsigned say_closed(argus_session_t *self) {
    if (self->state != ARGUS_SESSION_CLOSED || self->closed_said) {
        return 0;
    }
    self->closed_said = true;
    return ARGUS_SESSION_DID_CLOSE;
}

// What comes before SYNC0.
static unsigned old_session_timer(argus_session_t *self, uint32_t now_ms) {
    if (self->state == ARGUS_SESSION_HALT) {
        return in_state_ms(self, now_ms) >= HALT_MAX_MS ? dislodge(self, now_ms) : 0;
    }
    return quiet_timer(self, now_ms, self->state == ARGUS_SESSION_LISTEN ? LISTEN_MS : FLUSH_MS);
}

static unsigned run_timer(argus_session_t *self, const argus_config_t *config, uint32_t now_ms) {
    if (is_syncing(self)) {
        return in_state_ms(self, now_ms) >= STEP_MS ? fail(self, now_ms) : 0;
    }
    if (self->state >= ARGUS_SESSION_LISTEN && self->state <= ARGUS_SESSION_DISLODGE) {
        return old_session_timer(self, now_ms);
    }
    switch (self->state) {
    case ARGUS_SESSION_PAUSE:
        return pause_timer(self, config, now_ms);
    case ARGUS_SESSION_OPENING:
        return opening_timer(self, config, now_ms);
    case ARGUS_SESSION_OPEN:
        return open_timer(self, config, now_ms);
    case ARGUS_SESSION_LEAVING:
        return leaving_timer(self, now_ms);
    default:
        return 0;
    }
}

static unsigned open_observed(argus_session_t *self, uint32_t now_ms) {
    argus_outbox_clear(&self->outbox);
    argus_setup_init(&self->setup);
    self->observed = true;
    self->stalled = false;
    self->zeros_due = 0;
    self->attempts = 1;
    enter(self, now_ms, ARGUS_SESSION_OPEN);
    return ARGUS_SESSION_DID_OPEN;
}

unsigned argus_session_observe(argus_session_t *self, const argus_config_t *config, uint32_t now_ms) {
    if (self->state == ARGUS_SESSION_LEAVING || self->state == ARGUS_SESSION_CLOSED) {
        return 0;
    }
    const bool opens = self->state != ARGUS_SESSION_OPEN;
    const uint32_t gap_ms = opens ? 0 : argus_elapsed_ms(now_ms, self->heard_ms);
    self->sips++;
    self->heard_ms = now_ms;
    return opens ? open_observed(self, now_ms) | ARGUS_SESSION_GOT_SIP : after_gap(self, config, gap_ms);
}

unsigned argus_session_process(argus_session_t *self, const argus_config_t *config, uint32_t now_ms) {
    const unsigned bits = drain(self, config, now_ms);
    return bits != 0 ? bits : run_timer(self, config, now_ms) | say_closed(self);
}

void argus_session_leave(argus_session_t *self, uint32_t now_ms) {
    if (self->state == ARGUS_SESSION_LEAVING || self->state == ARGUS_SESSION_CLOSED) {
        return;
    }
    if (self->state != ARGUS_SESSION_DISLODGE) { // that one's CLOSE must still go out
        argus_outbox_clear(&self->outbox);
    }
    const bool opened = self->state == ARGUS_SESSION_OPENING || self->state == ARGUS_SESSION_OPEN;
    if (!self->observed && (self->state == ARGUS_SESSION_HALT || opened)) {
        argus_outbox_int(&self->outbox, ARCOS_CMD_SONAR, 0);
        argus_outbox_plain(&self->outbox, ARCOS_CMD_STOP);
        argus_outbox_int(&self->outbox, ARCOS_CMD_ENABLE, 0);
        argus_outbox_plain(&self->outbox, ARCOS_CMD_CLOSE);
    }
    enter(self, now_ms, self->outbox.length > 0 ? ARGUS_SESSION_LEAVING : ARGUS_SESSION_CLOSED);
}

static bool is_silent(const argus_session_t *self) {
    return self->observed || is_deaf(self) || self->state == ARGUS_SESSION_PAUSE ||
           self->state == ARGUS_SESSION_LISTEN;
}

// VEL 0 and RVEL 0 after a gap. They are not in the outbox, because STOP would overtake or drop them there.
static size_t fetch_zero(argus_session_t *self, uint8_t *packet, size_t capacity) {
    ARGUS_ASSERT(self->zeros_due <= 2);
    if (self->zeros_due == 0 || self->state != ARGUS_SESSION_OPEN ||
        argus_outbox_first(&self->outbox) == ARCOS_CMD_E_STOP) {
        return 0;
    }
    const uint8_t command = self->zeros_due == 2 ? ARCOS_CMD_VEL : ARCOS_CMD_RVEL;
    const size_t length = argus_command_int(packet, capacity, command, 0);
    self->zeros_due = (uint8_t)(self->zeros_due - (length > 0 ? 1 : 0));
    return length;
}

size_t argus_session_transmit(argus_session_t *self, uint32_t now_ms, uint8_t *packet, size_t capacity) {
    if (is_silent(self)) {
        argus_outbox_clear(&self->outbox);
        return 0;
    }
    size_t length = fetch_zero(self, packet, capacity);
    if (length == 0) {
        length = argus_outbox_fetch(&self->outbox, packet, capacity);
    }
    ARGUS_ASSERT(length <= capacity);
    if (length > 0) {
        self->spoke_ms = now_ms;
        argus_setup_sent(&self->setup, now_ms, packet, length);
    }
    return length;
}

int argus_session_resend(argus_session_t *self, uint32_t now_ms, unsigned rows) {
    const bool may = self->state == ARGUS_SESSION_OPEN && !self->stalled && !self->observed;
    return may ? argus_setup_resend(&self->setup, &self->outbox, now_ms, rows) : -1;
}

bool argus_session_is_open(const argus_session_t *self) {
    return self->state == ARGUS_SESSION_OPEN;
}

static bool subclass_is(const argus_session_t *self, const char *name, size_t size) {
    char lower[ARGUS_NAME_MAX];
    memcpy(lower, self->subclass, sizeof lower);
    for (size_t i = 0; i < sizeof lower; i++) {
        if (lower[i] >= 'A' && lower[i] <= 'Z') {
            lower[i] = (char)(lower[i] + ('a' - 'A'));
        }
    }
    return memcmp(lower, name, size) == 0;
}

int32_t argus_session_distance_um(const argus_session_t *self, int32_t usual_um) {
    static const char older[] = "p3dx";
    return subclass_is(self, older, sizeof older) ? ARCOS_SIP_OLD_UNIT_UM : usual_um;
}
