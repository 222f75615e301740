// SPDX-License-Identifier: MIT
// The session of a guard port's client, and what passes either way.
#include "guardian/client.h"

#include <string.h>

#include "guardian/rewrite.h"
#include "guardian/send.h"
#include "knowledge/angle.h"
#include "supervisor/orders.h"

#define WATCHDOG_MS 2000u // where CONFIGpac has not come
#define ALL_ARRAYS 0x0Fu
#define ORIGIN_SIPS 3    // in which SETO shows
#define PART_MS 3000u    // after which the motors are cut, at rest or not
#define SESSION_BYTES 60 // to the robot as a session begins and ends
#define PARTED_RESET 3
#define PARTED_SILENT 2
#define PARTED_CLOSED 1

_Static_assert(sizeof(argus_port_t) <= sizeof(argus_port_storage_t), "ARGUS_PORT_BYTES is too small");

static uint32_t watchdog_ms(const argus_t *const core) {
    const uint32_t configured_ms = core->session.has_robot ? core->session.robot.watchdog_ms : 0;
    return configured_ms > 0 ? configured_ms : WATCHDOG_MS;
}

// The client goes -------------------------------------------------------------------------------------------

// What it had the robot send beside the SIPs, and how it had it move, ends with it.
static void give_back(const argus_grant_t *const grant, argus_port_t *const self) {
    argus_send_streams_off(grant, self->streams);
    self->streams = 0;
    if (self->drives) {
        argus_outbox_urgent(grant->out, ARCOS_CMD_STOP);
        argus_send_own_settings(grant);
        self->parting = true;
        self->parted_ms = grant->core->now_ms;
    }
    self->drives = false;
    self->motors = ARGUS_PORT_MOTORS_AS_THEY_ARE;
    argus_hold_forget(&self->hold);
}

static void close_session(const argus_grant_t *const grant, argus_port_t *const self) {
    ARGUS_ASSERT(self->phase == ARGUS_PORT_OPEN);
    argus_emit(grant->events, ARGUS_EV_GUARD_CLOSED, (int32_t)(self->packets & 0x7FFFFFFFu));
    give_back(grant, self);
    self->phase = ARGUS_PORT_WAIT;
}

// Without a word.
static void lose(const argus_grant_t *const grant, argus_port_t *const self, const int32_t why) {
    if (self->phase == ARGUS_PORT_OPEN) {
        argus_emit(grant->events, ARGUS_EV_GUARD_LOST, why);
        give_back(grant, self);
    }
    self->phase = ARGUS_PORT_WAIT;
    argus_parser_flush(&self->from_client);
    self->out_length = 0;
}

// As at the end of a robot's own session, the motors go off; not if the manager drives by now.
static void part(const argus_grant_t *const grant, argus_port_t *const self) {
    const bool due =
        argus_at_rest(&grant->core->knowledge) || grant->core->now_ms - self->parted_ms >= PART_MS;
    ARGUS_ASSERT(!self->drives); // whoever drives parts no more
    if (!grant->core->orders.passive) {
        self->parting = false;
    } else if (due) {
        self->parting = !argus_outbox_int(grant->out, ARCOS_CMD_ENABLE, 0);
    }
}

// What ends here --------------------------------------------------------------------------------------------

static void refuse(const argus_grant_t *const grant, argus_port_t *const self, const uint8_t command) {
    self->refused++;
    if (argus_limit_word(&self->limit)) {
        argus_emit(grant->events, ARGUS_EV_GUARD_REFUSED, command);
    }
}

// How many were dropped, so that a flood is seen though not every command of it is.
static void tell_dropped(const argus_grant_t *const grant, argus_port_t *const self) {
    const uint32_t dropped = argus_limit_second(&self->limit, grant->core->now_ms);
    if (dropped > 0) {
        argus_emit(grant->events, ARGUS_EV_GUARD_DROPPED, (int32_t)(dropped & 0x7FFFFFFFu));
    }
}

static bool pass(const argus_grant_t *const grant, argus_port_t *const self, const argus_said_t *const said) {
    const bool passed = argus_send_robot(grant, said->packet);
    self->refused += passed ? 0 : 1;
    self->limit.dropped += passed ? 0 : 1;
    return passed;
}

static bool may_pass(const argus_grant_t *const grant, argus_port_t *const self, const uint16_t cost) {
    if (argus_limit_pass(&self->limit, grant->core->now_ms, cost)) {
        return true;
    }
    self->refused++;
    return false;
}

// The client comes ------------------------------------------------------------------------------------------

static void open_session(const argus_grant_t *const grant, argus_port_t *const self) {
    self->phase = ARGUS_PORT_OPEN;
    self->arrays = ALL_ARRAYS;
    self->packets = 0;
    self->denied = false;
    self->parting = false;
    memset(&self->settings, 0, sizeof self->settings);
    argus_hold_forget(&self->hold);
    argus_emit(grant->events, ARGUS_EV_GUARD_OPEN, 0);
}

static void answer_identity(const argus_t *const core, argus_port_t *const self) {
    const char *const texts[] = {core->session.name, core->session.robot_class, core->session.subclass};
    uint8_t data[1 + 3 * ARGUS_NAME_MAX];
    size_t count = 0;
    data[count++] = ARCOS_SYNC_SYNC2;
    for (int i = 0; i < 3; i++) {
        for (const char *c = texts[i]; *c != '\0'; c++) {
            data[count++] = (uint8_t)*c;
        }
        data[count++] = 0;
    }
    argus_send_client(self, data, count);
}

// The next SYNC or the same again; SYNC0 always begins anew, any other out of its order does, too.
static void take_sync(const argus_grant_t *const grant, argus_port_t *const self,
                      const argus_packet_t *const packet) {
    const uint8_t sync = packet->data[0];
    if (sync == ARCOS_CMD_OPEN && self->phase == ARGUS_PORT_SYNC2) {
        if (may_pass(grant, self, SESSION_BYTES)) {
            open_session(grant, self);
        }
    } else if (sync <= ARCOS_SYNC_SYNC2 &&
               (sync == ARCOS_SYNC_SYNC0 || sync == self->phase || sync + 1 == self->phase)) {
        self->phase = (uint8_t)(ARGUS_PORT_SYNC0 + sync);
        if (sync == ARCOS_SYNC_SYNC2) {
            answer_identity(grant->core, self);
        } else {
            argus_send_client(self, packet->data, 1);
        }
    } else if (sync <= ARCOS_SYNC_SYNC2) {
        self->phase = ARGUS_PORT_WAIT;
    }
}

// Its commands ----------------------------------------------------------------------------------------------

// The first motion that it asks for; true: it may.
static bool take_wheel(const argus_grant_t *const grant, argus_port_t *const self) {
    if (self->drives) {
        return true;
    }
    if (self->denied) {
        return false;
    }
    self->drives = true;
    self->parting = false;
    argus_emit(grant->events, ARGUS_EV_GUARD_DRIVES, 0);
    argus_send_settings(grant, &self->settings);
    self->hold.setv_mm_s = self->settings.setv_mm_s;
    self->hold.given.setv_mm_s = self->settings.setv_mm_s;
    return true;
}

static int32_t raw_deg(const argus_knowledge_t *const knowledge) {
    const int32_t cdeg =
        argus_angle_wrap(knowledge->pose.heading_cdeg - argus_heading_offset_cdeg(knowledge));
    return (cdeg + (cdeg >= 0 ? 50 : -50)) / 100;
}

// More of them than the robot's line carries: the last ones go out with the next SIP.
static void take_motion(const argus_grant_t *const grant, argus_port_t *const self,
                        const argus_said_t *const said) {
    if (!self->drives && !argus_wish_moves(said)) {
        return; // it stands as far as the client is concerned
    }
    if (!take_wheel(grant, self)) {
        refuse(grant, self, said->command);
        return;
    }
    const bool turns = said->topic == ARGUS_TOPIC_TURN;
    self->stopped = 0;
    argus_wish_take(&self->hold.wish, said, grant->core->knowledge.odometer_mm,
                    raw_deg(&grant->core->knowledge));
    if (!argus_limit_order(&self->limit)) {
        *(turns ? &self->hold.turn_due : &self->hold.way_due) = true;
    } else if (turns) {
        argus_hold_turn(grant, &self->hold);
    } else {
        argus_hold_way(grant, &self->hold);
    }
}

static uint8_t stop_of(const argus_said_t *const said) {
    return said->command == ARCOS_CMD_STOP ? ARCOS_CMD_STOP : ARCOS_CMD_E_STOP;
}

// The same again while nothing was ordered since, and no SIP has come, is once.
static void take_stop(const argus_grant_t *const grant, argus_port_t *const self,
                      const argus_said_t *const said) {
    const uint8_t command = stop_of(said);
    argus_hold_forget(&self->hold);
    if (self->stopped == command) {
        return;
    }
    self->stopped = command;
    argus_outbox_urgent(grant->out, command);
}

// Motors on are held and given again as a motion is. Where they go off nothing is wanted of the wheels, and a
// robot that keeps its set points has none when they are on again.
static void give_motors(const argus_grant_t *const grant, argus_port_t *const self) {
    argus_outbox_t *const out = grant->out;
    const argus_ask_t ask = {.mover = ARGUS_MOVER_CLIENT, .wants = ARGUS_WANTS_MOTORS};
    const argus_permit_t permit = argus_permit(grant->core, ask);
    const bool on = self->motors == ARGUS_PORT_MOTORS_ON;
    if (on && permit != ARGUS_PERMIT_GIVEN) {
        argus_hold_tell(grant, &self->hold, permit);
    } else if (self->motors != ARGUS_PORT_MOTORS_AS_THEY_ARE &&
               argus_outbox_int(out, ARCOS_CMD_ENABLE, on ? 1 : 0) &&
               (on || argus_outbox_plain(out, ARCOS_CMD_STOP))) {
        self->motors = ARGUS_PORT_MOTORS_AS_THEY_ARE;
    }
}

static void take_enable(const argus_grant_t *const grant, argus_port_t *const self,
                        const argus_said_t *const said) {
    const bool on = said->argument != 0;
    if (!on && !self->drives) {
        return;
    }
    if (!take_wheel(grant, self)) {
        refuse(grant, self, said->command);
        return;
    }
    self->stopped = 0;
    self->motors = on ? ARGUS_PORT_MOTORS_ON : ARGUS_PORT_MOTORS_OFF;
    if (!on) {
        argus_hold_forget(&self->hold);
    }
    if (argus_limit_order(&self->limit)) {
        give_motors(grant, self);
    } else if (!on) {
        argus_hold_still(grant, &self->hold);
    }
}

static void take_setting(const argus_grant_t *const grant, argus_port_t *const self,
                         const argus_said_t *const said) {
    const int32_t passed = argus_send_limited(grant->core, said->command, said->argument);
    if (passed != said->argument) {
        argus_emit(grant->events, ARGUS_EV_GUARD_LIMITED, passed);
    }
    argus_send_note(&self->settings, said->command, passed);
    if (self->drives) {
        argus_outbox_int(grant->out, said->command, passed);
        self->hold.setv_mm_s = self->settings.setv_mm_s;
        self->hold.given.setv_mm_s =
            said->command == ARCOS_CMD_SETV ? self->settings.setv_mm_s : self->hold.given.setv_mm_s;
    }
}

static void take_origin(const argus_grant_t *const grant, argus_port_t *const self,
                        const argus_said_t *const said) {
    if (!grant->core->orders.passive) {
        refuse(grant, self, said->command); // the manager steers by it
        return;
    }
    if (pass(grant, self, said)) {
        argus_knowledge_origin_due(grant->knowledge);
        self->origin = true;
        self->origin_sips = 0;
        self->hold.wish.heading_taken = false;
    }
}

// Twice the array, and 1 for on; array 0: all. The robot's own go on.
static void take_sonar(argus_port_t *const self, const int32_t argument) {
    const unsigned array = (unsigned)argument >> 1 & 7u;
    const unsigned mask = array == 0 ? ALL_ARRAYS : 1u << (array - 1) & ALL_ARRAYS;
    self->arrays = (uint8_t)((argument & 1) != 0 ? self->arrays | mask : self->arrays & ~mask);
}

// One that the robot has not got, or does not show, leaves the one before.
static void take_analog(argus_port_t *const self, const int32_t argument) {
    if (argument >= 0 && argument < ARGUS_ANALOG_PORTS) {
        self->analog.wants = (uint8_t)argument;
    }
}

static void take_rest(const argus_grant_t *const grant, argus_port_t *const self,
                      const argus_said_t *const said) {
    switch ((argus_topic_t)said->topic) { // GCOV_EXCL_BR_LINE: the default, lines tell of the rest
    case ARGUS_TOPIC_SETTING:
        take_setting(grant, self, said);
        break;
    case ARGUS_TOPIC_ORIGIN:
        take_origin(grant, self, said);
        break;
    case ARGUS_TOPIC_STREAM:
        self->streams |= pass(grant, self, said) ? argus_send_stream(said->command, said->argument) : 0;
        break;
    case ARGUS_TOPIC_PASSED:
        pass(grant, self, said);
        break;
    default:   // GCOV_EXCL_LINE: none is left; one that is forgotten here passes nothing
        break; // GCOV_EXCL_LINE
    }
}

static void take_session(const argus_grant_t *const grant, argus_port_t *const self, const uint8_t command) {
    if (command == ARCOS_CMD_CLOSE || command == ARCOS_CMD_RESET) {
        close_session(grant, self);
    }
}

static void take_command(const argus_grant_t *const grant, argus_port_t *const self,
                         const argus_said_t *const said) {
    switch ((argus_topic_t)said->topic) { // GCOV_EXCL_BR_LINE: the default, lines tell of the rest
    case ARGUS_TOPIC_SESSION:
        take_session(grant, self, said->command);
        break;
    case ARGUS_TOPIC_WAY:
    case ARGUS_TOPIC_TURN:
    case ARGUS_TOPIC_BOTH:
        take_motion(grant, self, said);
        break;
    case ARGUS_TOPIC_STOP:
        take_stop(grant, self, said);
        break;
    case ARGUS_TOPIC_ENABLE:
        take_enable(grant, self, said);
        break;
    case ARGUS_TOPIC_SONAR:
        take_sonar(self, said->argument);
        break;
    case ARGUS_TOPIC_ANALOG:
        take_analog(self, said->argument);
        break;
    default:
        if (may_pass(grant, self, said->cost)) {
            take_rest(grant, self, said);
        }
        break;
    }
}

static bool asks_for_wheels(const argus_said_t *const said) {
    const bool moves =
        said->topic == ARGUS_TOPIC_WAY || said->topic == ARGUS_TOPIC_TURN || said->topic == ARGUS_TOPIC_BOTH;
    return moves ? argus_wish_moves(said) : said->topic == ARGUS_TOPIC_ENABLE && said->argument != 0;
}

// The first motion that a client asks for ends the manager's own course. Any client that sees that the robot
// must stand is heard.
static void clear_way(argus_t *const core, const argus_port_t *const self, const argus_said_t *const said) {
    if (core->orders.passive) {
        return;
    }
    if (said->topic == ARGUS_TOPIC_STOP && self->stopped != stop_of(said)) {
        argus_stop_for_client(core);
    } else if (!self->drives && !self->denied && asks_for_wheels(said)) {
        argus_yield_to_client(core);
    }
}

static void take_packet(argus_t *const core, const argus_grant_t *const grant, argus_port_t *const self,
                        const argus_packet_t *const packet) {
    argus_said_t said;
    self->packets++;
    if (argus_admit(packet, &said)) {
        clear_way(core, self, &said);
        take_command(grant, self, &said);
    } else {
        refuse(grant, self, said.command);
    }
}

static bool is_robot_there(const argus_t *const core) {
    return argus_session_is_open(&core->session) && !core->orders.shutdown;
}

static void take_client(argus_t *const core, const argus_grant_t *const grant, argus_port_t *const self,
                        const argus_packet_t *const packet) {
    self->heard_ms = core->now_ms;
    if (!is_robot_there(core)) {
        return; // as a robot without power
    }
    if (self->phase == ARGUS_PORT_OPEN) {
        take_packet(core, grant, self, packet);
    } else {
        take_sync(grant, self, packet);
    }
}

static void hear_client(argus_t *const core, const argus_grant_t *const grant, argus_port_t *const self,
                        const argus_port_io_t *const io) {
    argus_packet_t packet;
    size_t taken = 0;
    for (;;) {
        while (argus_parser_next(&self->from_client, core->now_ms, &packet)) {
            take_client(core, grant, self, &packet);
        }
        if (taken >= io->client_count) {
            return;
        }
        taken +=
            argus_parser_push(&self->from_client, core->now_ms, io->client + taken, io->client_count - taken);
    }
}

// The robot's packets ---------------------------------------------------------------------------------------

static bool is_for_client(const uint8_t type) {
    return type > ARCOS_SYNC_SYNC2 && type != ARCOS_TYPE_RESET_NOTICE && type != ARCOS_TYPE_RESET_NOTICE2;
}

static bool is_sip(const uint8_t type) {
    return type == ARCOS_TYPE_SIP_STATIONARY || type == ARCOS_TYPE_SIP_MOVING;
}

static void pass_sip(const argus_grant_t *const grant, argus_port_t *const self,
                     const argus_packet_t *const packet, const argus_readings_t readings) {
    uint8_t data[ARCOS_FRAME_COUNT_MAX];
    const argus_rewrite_t how = {.readings = readings, .arrays = self->arrays, .analog = &self->analog};
    const size_t count = argus_rewrite_sip(grant->core, &how, packet->data, packet->count, data);
    if (count > 0 && argus_send_client(self, data, count)) {
        self->sips++;
    }
}

static void count_origin(const argus_grant_t *const grant, argus_port_t *const self) {
    self->origin_sips++;
    if (self->origin && self->origin_sips > ORIGIN_SIPS) {
        grant->knowledge->origin_due = false;
        self->origin = false;
    }
}

// An operator has made the manager active: the robot is its own again.
static void yield(const argus_grant_t *const grant, argus_port_t *const self) {
    if (self->drives && !grant->core->orders.passive) {
        self->drives = false;
        self->denied = true;
        argus_outbox_urgent(grant->out, ARCOS_CMD_STOP);
        argus_hold_forget(&self->hold);
        argus_send_own_settings(grant);
    }
}

static void take_robot(const argus_grant_t *const grant, argus_port_t *const self,
                       const argus_packet_t *const packet, const argus_readings_t readings) {
    const uint8_t type = packet->data[0];
    if (is_sip(type)) {
        argus_rewrite_note_analog(&self->analog, packet->data, packet->count);
    }
    if (self->phase != ARGUS_PORT_OPEN || !is_for_client(type)) {
        return;
    }
    if (is_sip(type)) {
        pass_sip(grant, self, packet, readings);
        count_origin(grant, self);
    } else {
        argus_send_client(self, packet->data, packet->count);
    }
}

static bool hear_robot(const argus_grant_t *const grant, argus_port_t *const self,
                       const argus_port_io_t *const io) {
    argus_packet_t packet;
    size_t taken = 0;
    bool news = false;
    for (;;) {
        while (argus_parser_next(&self->from_robot, grant->core->now_ms, &packet)) {
            news = news || is_sip(packet.data[0]);
            take_robot(grant, self, &packet, io->readings);
        }
        if (taken >= io->robot_count) {
            return news;
        }
        taken += argus_parser_push(&self->from_robot, grant->core->now_ms, io->robot + taken,
                                   io->robot_count - taken);
    }
}

// One pass --------------------------------------------------------------------------------------------------

static void watch_client(const argus_grant_t *const grant, argus_port_t *const self, const bool there) {
    if (self->there && !there) {
        lose(grant, self, PARTED_CLOSED);
    }
    self->there = there;
    if (self->phase == ARGUS_PORT_OPEN && !is_robot_there(grant->core)) {
        lose(grant, self, PARTED_RESET);
    }
}

static bool wants(const argus_hold_client_t *const hold) {
    return hold->wish.way != ARGUS_WISH_REST || hold->wish.turn != ARGUS_WISH_STRAIGHT || hold->given.rolls;
}

// A robot's own watchdog leaves the session open; so does this one.
static void watch_silence(const argus_grant_t *const grant, argus_port_t *const self) {
    const bool silent = grant->core->now_ms - self->heard_ms >= watchdog_ms(grant->core);
    if (self->phase == ARGUS_PORT_OPEN && self->drives && wants(&self->hold) && silent) {
        argus_emit(grant->events, ARGUS_EV_GUARD_LOST, PARTED_SILENT);
        argus_outbox_urgent(grant->out, ARCOS_CMD_STOP);
        argus_hold_forget(&self->hold);
    }
}

// S2, with no SIP. When they come again the robot's own session sends VEL 0 and RVEL 0.
static void stand(const argus_grant_t *const grant, argus_port_t *const self) {
    if (wants(&self->hold)) {
        argus_outbox_urgent(grant->out, ARCOS_CMD_STOP);
    }
    argus_hold_forget(&self->hold);
}

static void watch_driver(const argus_grant_t *const grant, argus_port_t *const self, const bool stays,
                         const bool news) {
    if (grant->core->stalled) {
        stand(grant, self);
    } else if (stays) {
        argus_hold_still(grant, &self->hold);
        argus_hold_watch(grant, &self->hold);
    } else if (news) {
        argus_hold_watch(grant, &self->hold);
        give_motors(grant, self);
    }
}

static void watch_motion(const argus_grant_t *const grant, argus_port_t *const self, const bool news) {
    const bool stays = grant->core->orders.stay && !self->stayed;
    self->stayed = grant->core->orders.stay;
    yield(grant, self);
    if (self->phase == ARGUS_PORT_OPEN && self->drives) {
        watch_driver(grant, self, stays, news);
    }
    if (self->parting && news) {
        part(grant, self);
    }
}

static size_t hand_out(argus_port_t *const self, const argus_port_io_t *const io) {
    const size_t count = self->out_length < io->capacity ? self->out_length : io->capacity;
    if (count > 0) {
        memcpy(io->out, self->out, count);
        self->out_length = (uint16_t)(self->out_length - count);
        memmove(self->out, self->out + count, self->out_length);
    }
    return count;
}

size_t argus_guard_port(argus_t *const core, argus_port_storage_t *const storage, const uint32_t now_ms,
                        const argus_port_io_t *const io) {
    argus_port_t *const self = (argus_port_t *)storage;
    const argus_grant_t granted = {.core = core,
                                   .out = &core->session.outbox,
                                   .events = &core->events,
                                   .motion = &core->motion,
                                   .knowledge = &core->knowledge};
    const argus_grant_t *const grant = &granted;
    argus_set_now(core, now_ms);
    watch_client(grant, self, io->there);
    hear_client(core, grant, self, io);
    const bool news = hear_robot(grant, self, io);
    if (news) {
        argus_limit_sip(&self->limit);
        self->stopped = 0;
    }
    tell_dropped(grant, self);
    watch_silence(grant, self);
    watch_motion(grant, self, news);
    return hand_out(self, io);
}
