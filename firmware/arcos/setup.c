// SPDX-License-Identifier: MIT
// Keeps the orders that set the robot up: sends again what it does not report.
#include "arcos/setup.h"

#include <string.h>

#include "arcos/arithmetic.h"

#define COMMAND_AT ARCOS_FRAME_OVERHEAD
#define TYPE_AT (COMMAND_AT + 1)
#define VALUE_AT (COMMAND_AT + 2)
#define INT_TOTAL (ARCOS_FRAME_OVERHEAD + 4 + 2)
#define WAIT_MOST_MS 8000
#define UNTOLD_MOST 2 // times that it is sent again while the robot tells nothing of it
#define AWAY_AFTER 4  // times after which it is said that it stays away
#define REST_MM_S 5
#define NEAR_ZERO 60      // units of position; SETO goes out at rest
#define NEAR_ZERO_TURN 60 // of 4096: 5 degrees
#define LATE_MS 150       // what was listed before the order came is listed still
#define ROUNDS 2          // of an array, before what is listed tells of its order
#define ALL_OF_ARRAY 7    // listed in one SIP: the server does not list what fired
#define SONAR_FLAGS (ARCOS_FLAG_SONAR1 | ARCOS_FLAG_SONAR2 | ARCOS_FLAG_SONAR3 | ARCOS_FLAG_SONAR4)

typedef enum { SLOWING, REST, ORIGIN, TOLD, SETTING, SPEED, SONARS, MOTORS, FIRING } proof_t;
typedef enum { UNTOLD, YES, NO } answer_t;

#define COMMAND(name, command, sign, proof, again_ms) ARCOS_CMD_##command,
#define SIGN(name, command, sign, proof, again_ms) (sign),
#define PROOF(name, command, sign, proof, again_ms) (proof),
#define AGAIN(name, command, sign, proof, again_ms) (again_ms),
static const uint8_t command_of[] = {ARGUS_SETUP_TABLE(COMMAND)};
static const int8_t sign_of[] = {ARGUS_SETUP_TABLE(SIGN)};
static const uint8_t proof_of[] = {ARGUS_SETUP_TABLE(PROOF)};
static const uint16_t again_ms_of[] = {ARGUS_SETUP_TABLE(AGAIN)};

void argus_setup_init(argus_setup_t *self) {
    memset(self, 0, sizeof *self);
    memset(self->share, 1, sizeof self->share); // each session begins with the robot's own order
}

// What goes out
// ------------------------------------------------------------------------------------------------

static bool is_of_row(argus_setup_row_t row, uint8_t command, int32_t value) {
    const int sign = sign_of[row];
    return command_of[row] == command && (sign == 0 || (sign > 0) == (value >= 0));
}

static void note_polling(argus_setup_t *self, const uint8_t *order, size_t count) {
    const bool same = count == self->polling_count && memcmp(order, self->polling, count) == 0;
    if (same || count > sizeof self->polling) {
        return;
    }
    self->polling_count = (uint8_t)count;
    memcpy(self->polling, order, count);
    memcpy(self->share_before, self->share, sizeof self->share);
    memset(self->share, 0, sizeof self->share);
    for (size_t i = 0; i < count; i++) {
        if (order[i] > 0 && order[i] <= ARGUS_SETUP_SONARS) {
            self->share[order[i] - 1]++;
        }
    }
    self->order[ARGUS_SETUP_POLLING].sent = false; // another one than before
}

static void note(argus_setup_t *self, argus_setup_row_t row, uint32_t now_ms, int32_t value) {
    argus_setup_order_t *const order = &self->order[row];
    const bool news = !order->sent || order->value != value;
    if (news) {
        order->again = 0;
        order->wait_ms = again_ms_of[row];
        order->said = false;
    }
    // One that the robot has told of stays confirmed; a SIP soon tells of the others anew.
    order->open = news || order->open || proof_of[row] >= SONARS || proof_of[row] <= TOLD;
    order->sent = true;
    order->value = (int16_t)value;
    order->sent_ms = now_ms;
}

static bool sets_off(uint8_t command, int32_t value) {
    static const uint8_t motions[] = {ARCOS_CMD_MOVE,  ARCOS_CMD_HEAD,   ARCOS_CMD_VEL2,
                                      ARCOS_CMD_DHEAD, ARCOS_CMD_DCHEAD, ARCOS_CMD_ROTATE};
    bool found = (command == ARCOS_CMD_VEL || command == ARCOS_CMD_RVEL) && value != 0;
    for (size_t i = 0; i < sizeof motions; i++) {
        found = found || motions[i] == command;
    }
    return found;
}

void argus_setup_sent(argus_setup_t *self, uint32_t now_ms, const uint8_t *packet, size_t length) {
    const uint8_t command = packet[COMMAND_AT];
    int32_t value = 0;
    if (length == INT_TOTAL && command != ARCOS_CMD_POLLING) {
        value = packet[VALUE_AT] | packet[VALUE_AT + 1] << 8;
        value = packet[TYPE_AT] == ARCOS_ARG_NEGATIVE ? -value : value;
    }
    if (command == ARCOS_CMD_POLLING) {
        note_polling(self, packet + VALUE_AT + 1, packet[VALUE_AT]);
        memset(self->listed, 0, sizeof self->listed);
    }
    // It is to move: no stop is due. And this is said once, as a stop may have overtaken it by then.
    if (sets_off(command, value)) {
        for (int row = 0; row <= ARGUS_SETUP_HALT_TURN; row++) {
            argus_setup_drop(self, (argus_setup_row_t)row);
        }
        return;
    }
    for (int row = 0; row < ARGUS_SETUP_ROWS; row++) {
        if (is_of_row((argus_setup_row_t)row, command, value)) {
            note(self, (argus_setup_row_t)row, now_ms, value);
        }
    }
}

// What comes back
// ----------------------------------------------------------------------------------------------

static answer_t firing_answer(const argus_setup_t *self, int array) {
    const int first = array * ARCOS_TIMING_TRANSDUCERS_PER_ARRAY;
    int32_t total = 0, slots = 0, slots_before = 0, off = 0, off_before = 0;
    for (int i = first; i < first + ARCOS_TIMING_TRANSDUCERS_PER_ARRAY; i++) {
        total += self->listed[i];
        slots += self->share[i];
        slots_before += self->share_before[i];
    }
    if (slots == 0 || slots_before == 0 || total < ROUNDS * slots) {
        return slots == 0 ? YES : UNTOLD; // an array that is not named keeps its order
    }
    for (int i = first; i < first + ARCOS_TIMING_TRANSDUCERS_PER_ARRAY; i++) {
        off += argus_abs(self->listed[i] * slots - total * self->share[i]) * slots_before;
        off_before += argus_abs(self->listed[i] * slots_before - total * self->share_before[i]) * slots;
    }
    return off <= off_before ? YES : NO;
}

static answer_t firing(const argus_setup_t *self) {
    answer_t all = YES;
    for (int array = 0; array < ARCOS_TIMING_ARRAYS_MAX && !self->lists_all; array++) {
        const answer_t answer = firing_answer(self, array);
        if (answer == NO) {
            return NO;
        }
        all = answer == UNTOLD ? UNTOLD : all;
    }
    return self->lists_all ? UNTOLD : all;
}

static int32_t speed_of(const argus_sip_t *sip) {
    return argus_abs(sip->vel_left_mm_s + sip->vel_right_mm_s) / 2;
}

static int32_t wheel_of(const argus_sip_t *sip) {
    const int32_t left = argus_abs(sip->vel_left_mm_s);
    const int32_t right = argus_abs(sip->vel_right_mm_s);
    return left > right ? left : right;
}

static int32_t around_zero(uint16_t raw) {
    const int32_t at = raw & 0x7FFF; // only 15 bits are sure
    return at < 0x4000 ? at : 0x8000 - at;
}

static bool is_at_origin(const argus_sip_t *sip) {
    return around_zero(sip->x_raw) <= NEAR_ZERO && around_zero(sip->y_raw) <= NEAR_ZERO &&
           argus_abs(sip->heading_raw) <= NEAR_ZERO_TURN;
}

// Slower than its speed a robot may be for many reasons.
static answer_t shows_speed(const argus_sip_t *sip, int32_t value) {
    return argus_abs(speed_of(sip) - value) <= value / 8 ? YES : UNTOLD;
}

static bool are_on(const argus_sip_t *sip, int32_t value) {
    return (value & 1) == 0 || (sip->flags & SONAR_FLAGS) != 0 || sip->sonar_count > 0;
}

static answer_t says(bool holds) {
    return holds ? YES : NO;
}

static answer_t shown_by_sip(const argus_setup_t *self, argus_setup_row_t row, const argus_sip_t *sip) {
    const int32_t value = self->order[row].value;
    switch ((proof_t)proof_of[row]) {
    case SLOWING:
    case REST:
        return says(wheel_of(sip) <= REST_MM_S);
    case ORIGIN:
        return says(is_at_origin(sip));
    case SPEED:
        return shows_speed(sip, value);
    case SONARS:
        return says(are_on(sip, value));
    case MOTORS:
        return says((value != 0) == ((sip->flags & ARCOS_FLAG_MOTORS) != 0));
    case FIRING:
        return firing(self);
    case TOLD:
    case SETTING:
    default:
        return UNTOLD;
    }
}

static void note_listed(argus_setup_t *self, uint32_t now_ms, const argus_sip_t *sip) {
    int of_array[ARCOS_TIMING_ARRAYS_MAX] = {0};
    const bool counts = now_ms - self->order[ARGUS_SETUP_POLLING].sent_ms >= LATE_MS;
    for (int i = 0; i < sip->sonar_count; i++) {
        const int sonar = sip->sonar[i].number;
        if (sonar >= ARGUS_SETUP_SONARS) {
            continue;
        }
        of_array[sonar / ARCOS_TIMING_TRANSDUCERS_PER_ARRAY]++;
        if (counts && self->listed[sonar] < UINT8_MAX) {
            self->listed[sonar]++;
        }
    }
    for (int array = 0; array < ARCOS_TIMING_ARRAYS_MAX; array++) {
        self->lists_all = self->lists_all || of_array[array] >= ALL_OF_ARRAY;
    }
}

void argus_setup_sip(argus_setup_t *self, uint32_t now_ms, const argus_sip_t *sip) {
    if (self->order[ARGUS_SETUP_POLLING].open) {
        note_listed(self, now_ms, sip);
    }
    for (int row = 0; row < ARGUS_SETUP_ROWS; row++) {
        argus_setup_order_t *const order = &self->order[row];
        if (order->open && shown_by_sip(self, (argus_setup_row_t)row, sip) == YES) {
            order->open = false;
        }
        if (proof_of[row] == SLOWING && wheel_of(sip) < self->wheel_mm_s) {
            order->sent_ms = now_ms; // it obeys
            order->again = 0;
        }
    }
    self->wheel_mm_s = wheel_of(sip);
    // A button cuts the motors, and a person lets them go on: that is no order that got lost.
    if ((sip->flags & (ARCOS_FLAG_ESTOP | ARCOS_FLAG_ESTALL)) != 0) {
        self->order[ARGUS_SETUP_ENABLE].open = false;
    }
}

static uint16_t field_of(const argus_configpac_t *told, argus_setup_row_t row) {
    switch (row) {
    case ARGUS_SETUP_SPEED:
        return told->vel_max_mm_s;
    case ARGUS_SETUP_ACCEL:
        return told->accel_mm_s2;
    case ARGUS_SETUP_DECEL:
        return told->decel_mm_s2;
    case ARGUS_SETUP_TURN_SPEED:
        return told->rotvel_max_deg_s;
    case ARGUS_SETUP_TURN_ACCEL:
        return told->rotaccel_deg_s2;
    case ARGUS_SETUP_TURN_DECEL:
        return told->rotdecel_deg_s2;
    case ARGUS_SETUP_CYCLE:
        return told->sonar_cycle_ms;
    default:
        return 0;
    }
}

void argus_setup_told(argus_setup_t *self, uint32_t now_ms, const argus_configpac_t *told, bool before) {
    self->order[ARGUS_SETUP_TELL].open = false;
    self->told = true;
    self->told_ms = now_ms;
    for (int row = 0; row < ARGUS_SETUP_ROWS; row++) {
        argus_setup_order_t *const order = &self->order[row];
        const uint16_t field = field_of(told, (argus_setup_row_t)row);
        self->last[row] = field;
        if (before) {
            self->first[row] = field;
        } else if (field != 0 && field == argus_abs(order->value)) {
            self->follows = self->follows || field != self->first[row];
            order->open = false;
        }
    }
}

// Again
// --------------------------------------------------------------------------------------------------------

void argus_setup_drop(argus_setup_t *self, argus_setup_row_t row) {
    self->order[row].open = false;
}

void argus_setup_doubt(argus_setup_t *self, argus_setup_row_t row) {
    argus_setup_order_t *const order = &self->order[row];
    if (!order->sent || order->open) {
        return;
    }
    order->open = true;
    order->again = 0;
    order->wait_ms = again_ms_of[row];
}

bool argus_setup_is_open(const argus_setup_t *self, argus_setup_row_t row) {
    return self->order[row].open;
}

// What the robot has told so far of an order that is open.
static answer_t told_of(const argus_setup_t *self, argus_setup_row_t row) {
    const proof_t proof = (proof_t)proof_of[row];
    if (proof == FIRING) {
        return firing(self);
    }
    if (proof == TOLD) {
        return self->told ? NO : UNTOLD; // one that has answered before
    }
    if (proof != SETTING && proof != SPEED) {
        return NO; // each SIP tells
    }
    const bool is_told = self->told && (int32_t)(self->told_ms - self->order[row].sent_ms) > 0;
    return is_told && self->follows && self->last[row] != 0 ? NO : UNTOLD;
}

static bool wants_told(const argus_setup_t *self) {
    bool wanted = false;
    for (int row = 0; row < ARGUS_SETUP_ROWS; row++) {
        const argus_setup_order_t *const order = &self->order[row];
        const bool is_told = (int32_t)(self->told_ms - order->sent_ms) > 0;
        wanted = wanted || (order->open && (proof_of[row] == SETTING || proof_of[row] == SPEED) && !is_told);
    }
    return wanted && self->told; // one that does not answer is not asked for ever
}

static void send(argus_setup_t *self, argus_setup_row_t row, argus_outbox_t *outbox) {
    const uint8_t command = command_of[row];
    if (proof_of[row] == SLOWING) {
        argus_outbox_urgent(outbox, command);
    } else if (row == ARGUS_SETUP_POLLING) {
        argus_outbox_string(outbox, command, self->polling, self->polling_count);
    } else if (row == ARGUS_SETUP_TELL || row == ARGUS_SETUP_ZERO) {
        argus_outbox_plain(outbox, command);
    } else {
        argus_outbox_int(outbox, command, self->order[row].value);
    }
}

// The number of its command when it is time to say that it stays away.
static int send_again(argus_setup_t *self, argus_setup_row_t row, argus_outbox_t *outbox, uint32_t now_ms) {
    argus_setup_order_t *const order = &self->order[row];
    const answer_t answer = told_of(self, row);
    if (answer == UNTOLD && order->again >= UNTOLD_MOST) {
        order->open = false; // the robot does not tell: there is no more to be known
        return -1;
    }
    send(self, row, outbox);
    order->again = (uint8_t)(order->again < UINT8_MAX ? order->again + 1 : order->again);
    if (proof_of[row] != SLOWING) {
        order->wait_ms = (uint16_t)(order->wait_ms < WAIT_MOST_MS / 2 ? order->wait_ms * 2 : WAIT_MOST_MS);
    }
    order->sent_ms = now_ms;
    if (answer == NO && order->again >= AWAY_AFTER && !order->said) {
        order->said = true;
        return command_of[row];
    }
    return -1;
}

int argus_setup_resend(argus_setup_t *self, argus_outbox_t *outbox, uint32_t now_ms, unsigned rows) {
    argus_setup_order_t *const tell = &self->order[ARGUS_SETUP_TELL];
    if (outbox->length > 0) {
        return -1; // first what waits
    }
    if (!tell->open && tell->sent && wants_told(self)) {
        argus_setup_doubt(self, ARGUS_SETUP_TELL);
    }
    for (int row = 0; row < ARGUS_SETUP_ROWS; row++) {
        const argus_setup_order_t *const order = &self->order[row];
        const uint32_t since_ms = now_ms - order->sent_ms;
        if (order->open && (rows >> row & 1u) != 0 && since_ms < UINT32_C(0x80000000) &&
            since_ms >= order->wait_ms) {
            return send_again(self, (argus_setup_row_t)row, outbox, now_ms);
        }
    }
    return -1;
}
