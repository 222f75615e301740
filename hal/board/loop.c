// SPDX-License-Identifier: MIT
// The loop of a board: the robot's bytes first, then time, events, orders, the store, the watchdog.
#include <string.h>

#include "board/board.h"
#include "board/bus.h"
#include "board/config.h"
#include "board/memory.h"
#include "board/orders.h"
#include "board/report.h"
#include "board/word.h"

// A robot that was left driving is stopped by its own watchdog (2 s by default) before it is spoken to.
#define QUIET_MS 2500u
#define READ_BYTES 64
#define READS_PER_PASS 8 // a flood must not keep time from passing
#define ORDER_BYTES 64
#define STATUS_MS 1000u
#define SAVE_MS 60000u // between two saves of its own accord: flash bears 10,000 erasures of a slot
#define LATE_MS 200u   // a pass that takes longer does not feed the watchdog

typedef struct {
    argus_t *core;
    board_ring_t *out;
    uint32_t start_ms;
    uint32_t status_ms;
    uint32_t saved_ms;
    int32_t telling; // next setting to be told, BOARD_CONFIG_COUNT: none
    bool quiet;      // the robot is not spoken to yet
    bool broken;     // an invariant does not hold: nothing is sent any more
    bool closing;    // the session is being closed, by order
    bool wants_status;
    argus_config_t config; // for the next start
    board_memory_t memory;
    board_orders_t orders;
    argus_storage_t storage;
} loop_t;

static loop_t self;

static uint32_t since_start_ms(void) {
    return board_now_ms() - self.start_ms;
}

static void note(const char *name, const char *what, const char *text) {
    if (!board_report_note(self.out, since_start_ms(), name, what, text) && self.out != NULL) {
        self.out->lost++;
    }
    board_console_kick();
}

static BOARD_APART void transmit(void) {
    uint8_t packet[ARGUS_PACKET_MAX];
    while (!self.broken && board_room() >= sizeof packet) {
        const size_t count = argus_transmit(self.core, packet, sizeof packet);
        if (count == 0) {
            return;
        }
        board_send(packet, count);
    }
}

static BOARD_APART void receive(void) {
    uint8_t bytes[READ_BYTES];
    for (int i = 0; i < READS_PER_PASS; i++) {
        const size_t count = board_receive(bytes, sizeof bytes);
        if (count == 0) {
            return;
        }
        if (!self.quiet) {
            argus_receive(self.core, board_now_ms(), bytes, count);
            transmit();
        }
    }
}

static void end_quiet(void) {
    if (self.quiet && since_start_ms() >= QUIET_MS) {
        self.quiet = false;
        argus_link_up(self.core, board_now_ms());
    }
}

// Events wait in the manager until there is room for their lines; what it loses meanwhile it tells.
static void tell_events(void) {
    argus_event_t event;
    while ((self.out == NULL || board_ring_room(self.out) >= BOARD_EVENT_LINE_MAX) &&
           argus_next_event(self.core, &event)) {
        board_bus_event(self.core, &event);
        board_report_event(self.out, &event, event.t_ms - self.start_ms);
        board_console_kick();
    }
}

static BOARD_APART void tell_status(void) {
    argus_status_t status;
    const bool due = self.wants_status || board_now_ms() - self.status_ms >= STATUS_MS;
    if (!due || self.out == NULL || board_ring_room(self.out) < BOARD_STATUS_LINE_MAX) {
        return;
    }
    self.wants_status = false;
    self.status_ms = board_now_ms();
    argus_status(self.core, &status);
    board_report_status(self.out, &status, since_start_ms());
    board_console_kick();
}

static void tell_settings(void) {
    if (self.telling < BOARD_CONFIG_COUNT &&
        board_report_setting(self.out, since_start_ms(), board_config_key(self.telling),
                             board_config_value(&self.config, self.telling))) {
        self.telling++;
        board_console_kick();
    }
}

static BOARD_APART bool is_at_rest(void) {
    argus_status_t status;
    argus_status(self.core, &status);
    const bool may_move = status.mode != ARGUS_MODE_IDLE && status.mode != ARGUS_MODE_WAITING &&
                          status.mode != ARGUS_MODE_OFFLINE && status.mode != ARGUS_MODE_CLOSED;
    return !may_move && status.vel_left_mm_s == 0 && status.vel_right_mm_s == 0;
}

static void save(void) {
    if (!is_at_rest()) {
        return;
    }
    self.saved_ms = board_now_ms();
    const hal_store_error_t saved = board_memory_save(&self.memory, self.core, &self.config);
    if (saved != HAL_STORE_EMPTY && saved != HAL_STORE_NO_PLACE) {
        note("STORE", "save", hal_store_error_text(saved));
    }
}

static BOARD_APART const char *obey_save(void) {
    const argus_config_report_t report = argus_config_check(&self.config);
    if (report.fault != ARGUS_CONFIG_OK) {
        return board_config_fault_text((argus_config_fault_t)report.fault);
    }
    if (!is_at_rest()) {
        return "not while it moves";
    }
    const hal_store_error_t saved = board_memory_save(&self.memory, self.core, &self.config);
    self.saved_ms = board_now_ms();
    return saved == HAL_STORE_EMPTY ? "nothing is new" : hal_store_error_text(saved);
}

static const char *obey_wish(board_wish_t wish, const char *answer) {
    switch (wish) {
    case BOARD_WISH_SAVE:
        return obey_save();
    case BOARD_WISH_STATUS:
        self.wants_status = true;
        return answer;
    case BOARD_WISH_SETTINGS:
        self.telling = 0;
        return answer;
    case BOARD_WISH_SHUTDOWN:
        self.closing = true;
        argus_shutdown(self.core, board_now_ms());
        return answer;
    case BOARD_WISH_RESTART:
        if (!is_at_rest()) {
            return "not while it moves";
        }
        board_restart();
        return answer;
    case BOARD_WISH_NONE:
    default:
        return answer;
    }
}

static BOARD_APART const char *ask(board_wish_t *wish) {
    return board_orders_obey(&self.orders, self.core, board_now_ms(), &self.config, wish);
}

static void obey(void) {
    board_wish_t wish = BOARD_WISH_NONE;
    const char *const answer = ask(&wish);
    transmit();
    note("ORDER", self.orders.line, obey_wish(wish, answer));
}

// One order in a pass, however many have come.
static void take_orders(void) {
    uint8_t byte = 0;
    for (int i = 0; i < ORDER_BYTES && board_console_read(&byte, 1) == 1; i++) {
        if (board_orders_take(&self.orders, byte)) {
            obey();
            return;
        }
    }
}

static void keep(void) {
    if (self.closing && argus_closed(self.core)) {
        self.closing = false;
        save();
        note("CLOSED", "shutdown", "restart begins anew");
    } else if (board_now_ms() - self.saved_ms >= SAVE_MS) {
        save();
        self.saved_ms = board_now_ms();
    }
}

static void feed(uint32_t began_ms) {
    const int invariant = argus_invariants_broken(self.core);
    if (invariant != 0 && !self.broken) {
        self.broken = true;
        board_keep_invariant(invariant);
    }
    if (!self.broken && board_now_ms() - began_ms <= LATE_MS) {
        board_feed();
    }
}

// In the order of board_settings_t.
static const char *origin_of(board_settings_t settings) {
    return board_word_nth("built\0stored\0damaged\0outdated\0refused\0", (int)settings);
}

static BOARD_APART void begin(void) {
    self.out = board_console_out();
    board_memory_init(&self.memory);
    const board_settings_t settings = board_memory_settings(&self.memory, &self.config);
    board_open((uint32_t)self.config.baud);
    self.start_ms = board_now_ms();
    self.status_ms = self.start_ms;
    self.saved_ms = self.start_ms;
    self.quiet = true;
    self.telling = BOARD_CONFIG_COUNT;
    self.core = argus_init(&self.storage, &self.config, self.start_ms);
    board_memory_load(&self.memory, self.core);
    board_bus_open(&self.config, self.start_ms);
    board_report_start(self.out, board_config_digest(&self.config), origin_of(settings));
    board_console_kick();
}

void board_run(void) {
    begin();
    for (;;) {
        const uint32_t began_ms = board_now_ms();
        receive();
        end_quiet();
        const uint32_t wait_ms = argus_process(self.core, board_now_ms());
        transmit();
        tell_events();
        take_orders();
        board_bus_process(self.core, board_now_ms());
        transmit();
        tell_settings();
        tell_status();
        feed(began_ms);
        keep();
        board_wait(self.telling < BOARD_CONFIG_COUNT ? 1 : wait_ms);
    }
}
