// SPDX-License-Identifier: MIT
// Ties the fault manager to a link and a clock: bytes and time in, packets out, and a lost link found again.
#ifndef ARGUSD_DRIVER_H
#define ARGUSD_DRIVER_H

#include "argus/argus.h"
#include "hal/clock.h"
#include "hal/links.h"

// Sees all bytes that pass, from the robot or to it. Must not wait.
typedef struct {
    void (*see)(void *context, bool from_robot, const uint8_t *bytes, size_t count); // NULL: none
    void *context;
} driver_tap_t;

// Changes the robot's bytes before any other part sees them, when some came and now and then without. Returns
// how many there are at `out`, which has room for `count` and DRIVER_FILTER_HOLD more. Must not wait.
#define DRIVER_FILTER_HOLD 512
typedef struct {
    size_t (*alter)(void *context, uint32_t now_ms, const uint8_t *bytes, size_t count, uint8_t *out);
    void *context;
} driver_filter_t; // alter NULL: none

#define DRIVER_WORDS_MAX 64
#define DRIVER_TELNET                                                                                \
    "a telnet server is there, which doubles each byte FF: let it pass bytes as they are (ser2net: " \
    "accepter "                                                                                      \
    "tcp,PORT without telnet), or take the port that does"

typedef struct {
    argus_storage_t memory;
    argus_t *core; // in `memory`
    hal_clock_t clock;
    hal_link_spec_t spec;
    hal_transport_t *transport; // NULL: a link lost is not opened again
    hal_link_t link;
    driver_tap_t tap;
    driver_tap_t after; // sees what the robot sent once the manager has taken it, before answers go out
    driver_filter_t filter;
    bool up;
    int cancel_fd;           // becomes readable when opening is to be given up; -1: none
    hal_link_error_t error;  // why the link is not up
    bool failed;             // ... since an attempt to open it failed
    bool tried;              // to open it, since a reason was looked for
    uint32_t told_sum;       // of the words told last
    hal_link_error_t told;   // the reason told last; HAL_LINK_OK: none is to be told as over
    uint32_t bytes_before;   // bytes_in when the link came up
    uint32_t packets_before; // likewise those of a robot
    uint32_t fruitless;      // times in a row that the link closed and no packet had come
    bool telnet_told;        // that a telnet server is at the other end
    size_t words;            // first bytes of an opening that said something
    uint8_t word[DRIVER_WORDS_MAX];
    uint32_t retry_ms;  // pause before the next attempt to open
    uint32_t lost_ms;   // when the last attempt failed
    uint32_t looked_ms; // last look at where the link's name leads
    bool settles;       // the link is up, which the manager is not told yet
    uint32_t up_ms;     // when the link came up
    uint32_t reopened;  // monotonic
    uint32_t bytes_in;  // over all openings
    size_t held;        // a packet that the link would not take yet
    uint8_t packet[HAL_LINK_PACKET_MAX];
} driver_t;

// `transport` stays the caller's, initialised, open or not.
void driver_init(driver_t *self, const argus_config_t *config, hal_clock_t clock, const hal_link_spec_t *spec,
                 hal_transport_t *transport);

// One attempt, at most `timeout_ms` long where opening has to wait for the other end.
hal_link_error_t driver_open(driver_t *self, int timeout_ms);

// Takes a link that is open already.
void driver_attach(driver_t *self, hal_link_t link);

// Call when the link can be read: what a SIP calls for is written before this returns.
void driver_receive(driver_t *self);

// Call when time has passed or the link can be written; returns the ms to wait at most. Opens a lost link
// again.
uint32_t driver_process(driver_t *self);

// Writes what the manager has to send, as far as the link takes it.
void driver_transmit(driver_t *self);

// Why the link stays away, or that it is back: each once. False: nothing new.
bool driver_reason(driver_t *self, char *text, size_t capacity);

// One line about that, see below.
void driver_explain_turned_away(const driver_t *self, char *text, size_t capacity);

// Whether the first bytes of the opening are a telnet server's negotiation.
bool driver_meets_telnet(const driver_t *self);

// Whether the other end takes the link and closes it before a robot answers, time and again.
bool driver_is_turned_away(const driver_t *self);

bool driver_wants_write(const driver_t *self);
void driver_close(driver_t *self);

#endif
