// SPDX-License-Identifier: MIT
// Which telemetry frame is due and what is in it, and which orders are taken.
#include "hal/can_telemetry.h"

#include <string.h>

#define GROUP 4 // sonars in a frame of readings
#define ARRAY 8 // and in a frame of health
#define SONARS_LEAST 16

typedef enum { HEARTBEAT, HEALTH, READINGS, PLAN } content_t;

// The frames that repeat, in the order of their ids: what they hold, and of which sonars from one on.
typedef struct {
    content_t content;
    uint8_t first;
} slot_t;

static const slot_t slots[] = {{HEARTBEAT, 0}, {HEALTH, 0},    {HEALTH, 8},    {READINGS, 0}, {READINGS, 4},
                               {READINGS, 8},  {READINGS, 12}, {PLAN, 0},      {HEALTH, 16},  {HEALTH, 24},
                               {READINGS, 16}, {READINGS, 20}, {READINGS, 24}, {READINGS, 28}};
_Static_assert(sizeof slots / sizeof slots[0] == HAL_TELEMETRY_FRAMES + HAL_TELEMETRY_UPPER,
               "each frame has its slot");

// Nonces
// -----------------------------------------------------------------------------------------------------

static uint32_t mix(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7FEB352Du;
    x ^= x >> 15;
    x *= 0x846CA68Bu;
    return x ^ x >> 16;
}

// A Feistel network: one to one, so that no nonce comes again before all 65,536 were used.
static uint16_t nonce_of(uint32_t key, uint16_t number) {
    uint32_t left = number >> 8;
    uint32_t right = number & 0xFFu;
    for (uint32_t round = 0; round < 6; round++) {
        const uint32_t next = left ^ (mix(key ^ round << 24 ^ right) & 0xFFu);
        left = right;
        right = next;
    }
    return (uint16_t)(left << 8 | right);
}

static uint16_t next_nonce(hal_telemetry_t *self, uint32_t now_ms) {
    const uint16_t value = nonce_of(self->key, self->number);
    self->number++;
    self->newest = (uint8_t)((self->newest + 1u) % HAL_TELEMETRY_NONCES);
    self->nonce[self->newest] =
        (hal_telemetry_nonce_t){.value = value, .sent_ms = now_ms, .use = HAL_TELEMETRY_GOOD};
    return value;
}

static hal_telemetry_nonce_t *find_nonce(hal_telemetry_t *self, uint16_t value, uint32_t now_ms) {
    for (unsigned i = 0; i < HAL_TELEMETRY_NONCES; i++) {
        hal_telemetry_nonce_t *const nonce = &self->nonce[i];
        if (nonce->use != HAL_TELEMETRY_NEVER && nonce->value == value &&
            now_ms - nonce->sent_ms <= HAL_TELEMETRY_NONCE_MS) {
            return nonce;
        }
    }
    return NULL;
}

// It and all before it: an order that was overtaken must not be carried out after the later one.
static void use_up(hal_telemetry_t *self, const hal_telemetry_nonce_t *used, uint32_t now_ms) {
    const uint32_t age_ms = now_ms - used->sent_ms;
    for (unsigned i = 0; i < HAL_TELEMETRY_NONCES; i++) {
        if (self->nonce[i].use == HAL_TELEMETRY_GOOD && now_ms - self->nonce[i].sent_ms >= age_ms) {
            self->nonce[i].use = HAL_TELEMETRY_USED;
        }
    }
}

// Orders
// -----------------------------------------------------------------------------------------------------

static uint16_t crc_add(uint16_t crc, uint8_t byte) {
    unsigned sum = crc ^ (unsigned)byte << 8;
    for (int bit = 0; bit < 8; bit++) {
        sum = (sum & 0x8000u) != 0 ? sum << 1 ^ 0x1021u : sum << 1;
    }
    return (uint16_t)(sum & 0xFFFFu);
}

uint16_t hal_telemetry_crc(uint16_t id, const uint8_t data[HAL_DBC_LENGTH]) {
    uint16_t crc = crc_add(crc_add(0xFFFFu, (uint8_t)(id & 0xFFu)), (uint8_t)(id >> 8));
    for (int i = 0; i < HAL_DBC_LENGTH - 2; i++) {
        crc = crc_add(crc, data[i]);
    }
    return crc;
}

uint16_t hal_telemetry_command_id(const hal_telemetry_t *self) {
    return (uint16_t)(HAL_DBC_COMMAND_ID + self->robot * HAL_DBC_STEP_OTHER);
}

static bool makes_sense(const hal_dbc_command_t *order) {
    if (order->order == HAL_DBC_ORDER_RETEST) {
        return order->sonar < ARGUS_SONARS;
    }
    return order->order >= HAL_DBC_ORDER_STOP && order->order <= HAL_DBC_ORDER_ACTIVE && order->sonar == 0;
}

static hal_telemetry_verdict_t judge(hal_telemetry_t *self, const uint8_t *data, size_t length,
                                     uint32_t now_ms, hal_dbc_command_t *order) {
    if (length != HAL_DBC_LENGTH) {
        return HAL_TELEMETRY_BAD_LENGTH;
    }
    hal_dbc_command_unpack(order, data);
    if (order->crc != hal_telemetry_crc(hal_telemetry_command_id(self), data)) {
        return HAL_TELEMETRY_BAD_CRC;
    }
    if (order->reserved != 0) {
        return HAL_TELEMETRY_BAD_RESERVED;
    }
    const hal_telemetry_nonce_t *const nonce = find_nonce(self, order->nonce, now_ms);
    if (nonce == NULL) {
        return HAL_TELEMETRY_BAD_UNKNOWN_NONCE;
    }
    if (nonce->use == HAL_TELEMETRY_USED) {
        return HAL_TELEMETRY_BAD_USED_NONCE;
    }
    use_up(self, nonce, now_ms);
    return makes_sense(order) ? HAL_TELEMETRY_TAKEN : HAL_TELEMETRY_BAD_ORDER;
}

hal_telemetry_verdict_t hal_telemetry_take(hal_telemetry_t *self, const uint8_t *data, size_t length,
                                           uint32_t now_ms, hal_dbc_command_t *order) {
    const hal_telemetry_verdict_t verdict = judge(self, data, length, now_ms, order);
    self->verdicts[verdict]++;
    return verdict;
}

const char *hal_telemetry_verdict_text(hal_telemetry_verdict_t verdict) {
    static const char *const texts[] = {"taken",
#define REFUSAL_TEXT(name, text) text,
                                        HAL_TELEMETRY_REFUSAL_TABLE(REFUSAL_TEXT)
#undef REFUSAL_TEXT
    };
    return (unsigned)verdict < HAL_TELEMETRY_VERDICTS ? texts[verdict] : "?";
}

// Emergencies
// ------------------------------------------------------------------------------------------------

static bool is_alarm(const argus_event_t *event) {
    const argus_level_t level = argus_event_level(event->id);
    return level == ARGUS_LEVEL_ERROR || level == ARGUS_LEVEL_STALE || event->id == ARGUS_EV_LINK_STALLED;
}

static bool has_sonar(const argus_event_t *event) {
    return event->sonar >= 0 && event->sonar < ARGUS_SONARS;
}

// The event's sonar as a mask; 0 where it is about none.
static argus_mask_t sonar_bit(const argus_event_t *event) {
    return has_sonar(event) ? (argus_mask_t)((argus_mask_t)1 << event->sonar) : 0;
}

// The other edge. A sonar that is judged healthy is news only if something was said about it.
static bool is_end(const hal_telemetry_t *self, const argus_event_t *event) {
    switch (event->id) {
    case ARGUS_EV_SONAR_HEALTHY:
        return (self->alarmed & sonar_bit(event)) != 0;
    case ARGUS_EV_SESSION_OPEN:
        return self->link_alarmed;
    case ARGUS_EV_LINK_RESUMED:
    case ARGUS_EV_MOTORS_ON:
    case ARGUS_EV_BUMPER_CLEAR:
    case ARGUS_EV_FAILURE_STATE:
        return true;
    default:
        return false;
    }
}

static void enqueue(hal_telemetry_t *self, const hal_dbc_emergency_t *emergency) {
    if (self->queued == HAL_TELEMETRY_EDGE_QUEUE) {
        self->queue_head = (uint8_t)((self->queue_head + 1u) % HAL_TELEMETRY_EDGE_QUEUE);
        self->queued--;
    }
    hal_telemetry_frame_t *const frame =
        &self->queue[(self->queue_head + self->queued) % HAL_TELEMETRY_EDGE_QUEUE];
    self->queued++;
    frame->id = (uint16_t)(HAL_DBC_EMERGENCY_ID + self->robot * HAL_DBC_STEP_OTHER);
    frame->length = HAL_DBC_LENGTH;
    hal_dbc_emergency_pack(frame->data, emergency);
}

void hal_telemetry_event(hal_telemetry_t *self, const argus_status_t *status, const argus_event_t *event) {
    const argus_mask_t bit = sonar_bit(event);
    const bool alarm = is_alarm(event);
    if (!alarm && !is_end(self, event)) {
        return;
    }
    self->alarmed = (argus_mask_t)(alarm ? self->alarmed | bit : self->alarmed & ~bit);
    if (event->id == ARGUS_EV_LINK_LOST || event->id == ARGUS_EV_SESSION_OPEN) {
        self->link_alarmed = alarm;
    }
    const hal_dbc_emergency_t emergency = {
        .event = event->id,
        .level = (uint8_t)argus_event_level(event->id),
        .failure = event->state,
        .about = has_sonar(event) ? HAL_DBC_ABOUT_SONAR : HAL_DBC_ABOUT_ROBOT,
        .sonar = has_sonar(event) ? (uint8_t)event->sonar : 0,
        .fault = has_sonar(event) ? (uint8_t)status->kind[event->sonar] : 0,
        .roll = self->edge_roll,
        .value = event->value,
    };
    self->edge_roll++;
    enqueue(self, &emergency);
}

static void earn_edges(hal_telemetry_t *self, uint32_t now_ms) {
    const uint32_t earned = (now_ms - self->edge_ms) / HAL_TELEMETRY_EDGE_MS;
    if (self->edges + earned >= HAL_TELEMETRY_EDGE_BURST) {
        self->edges = HAL_TELEMETRY_EDGE_BURST;
        self->edge_ms = now_ms;
        return;
    }
    self->edges = (uint8_t)(self->edges + earned);
    self->edge_ms += earned * HAL_TELEMETRY_EDGE_MS;
}

static bool take_edge(hal_telemetry_t *self, uint32_t now_ms, hal_telemetry_frame_t *frame) {
    earn_edges(self, now_ms);
    if (self->queued == 0 || self->edges == 0) {
        return false;
    }
    *frame = self->queue[self->queue_head];
    self->queue_head = (uint8_t)((self->queue_head + 1u) % HAL_TELEMETRY_EDGE_QUEUE);
    self->queued--;
    self->edges--;
    return true;
}

// Contents
// ---------------------------------------------------------------------------------------------------

static uint8_t state_of(const argus_status_t *status) {
    switch ((int)status->mode) {
    case ARGUS_MODE_OFFLINE:
        return HAL_DBC_STATE_OFFLINE;
    case ARGUS_MODE_CLOSING:
    case ARGUS_MODE_CLOSED:
        return HAL_DBC_STATE_CLOSED;
    default:
        return status->active ? HAL_DBC_STATE_ACTIVE : HAL_DBC_STATE_PASSIVE;
    }
}

uint32_t hal_telemetry_refused(const hal_telemetry_t *self) {
    uint32_t sum = 0;
    for (int i = HAL_TELEMETRY_TAKEN + 1; i < HAL_TELEMETRY_VERDICTS; i++) {
        sum += self->verdicts[i];
    }
    return sum;
}

static uint8_t forward_disabled(const argus_status_t *status) {
    uint8_t count = 0;
    for (int i = 0; i < status->sonars; i++) {
        const bool forward = (status->forward >> i & 1u) != 0;
        count = (uint8_t)(count + (forward && status->health[i] == ARGUS_DISABLED));
    }
    return count;
}

static void fill_heartbeat(const hal_telemetry_t *self, const argus_status_t *status, uint8_t state,
                           uint16_t nonce, uint8_t *data) {
    const hal_dbc_heartbeat_t heartbeat = {
        .mode = (uint8_t)status->mode,
        .state = state,
        .failure = (uint8_t)status->failure,
        .mission = (uint8_t)status->mission,
        .wait = (uint8_t)status->wait,
        .disabled = forward_disabled(status),
        .roll = self->roll & 0xFu,
        .stops = status->stops & 0xFu,
        .taken = self->verdicts[HAL_TELEMETRY_TAKEN] & 0xFu,
        .refused = hal_telemetry_refused(self) & 0xFu,
        .uptime = (uint16_t)(self->uptime_s & 0xFFFFu),
        .nonce = nonce,
    };
    hal_dbc_heartbeat_pack(data, &heartbeat);
}

static void fill_health(const hal_telemetry_t *self, const argus_status_t *status, int first, uint8_t *data) {
    hal_dbc_health_t health = {0};
    for (int i = 0; i < ARRAY && first + i < ARGUS_SONARS; i++) {
        health.health[i] = (uint8_t)status->health[first + i];
        health.fault[i] = (uint8_t)status->kind[first + i];
        health.injected[i] = self->injected >> (first + i) & 1u;
    }
    hal_dbc_health_pack(data, &health);
}

static uint8_t validity_of(const hal_telemetry_t *self, const argus_status_t *status, int sonar) {
    if (status->age_ms[sonar] == UINT32_MAX) {
        return HAL_DBC_VALIDITY_NEVER;
    }
    if (status->health[sonar] == ARGUS_DISABLED) {
        return HAL_DBC_VALIDITY_DISABLED;
    }
    if (status->age_ms[sonar] > self->stale_ms) {
        return HAL_DBC_VALIDITY_OLD;
    }
    return status->readings[sonar] != self->readings[sonar] ? HAL_DBC_VALIDITY_FRESH : HAL_DBC_VALIDITY_HELD;
}

static void fill_readings(const hal_telemetry_t *self, const argus_status_t *status, int first,
                          uint8_t *data) {
    hal_dbc_readings_t readings = {0};
    for (int i = 0; i < GROUP && first + i < ARGUS_SONARS; i++) {
        const bool reported = status->age_ms[first + i] != UINT32_MAX;
        readings.range[i] = reported ? status->reading_mm[first + i] : (uint16_t)HAL_DBC_RANGE_NONE;
        readings.validity[i] = validity_of(self, status, first + i);
    }
    hal_dbc_readings_pack(data, &readings);
}

static int8_t degrees(int16_t value) {
    return (int8_t)(value > INT8_MAX ? INT8_MAX : value < INT8_MIN ? INT8_MIN : value);
}

static void fill_plan(const argus_status_t *status, uint8_t roll, uint8_t *data) {
    const argus_plan_t *const from = &status->plan;
    hal_dbc_plan_t plan = {.count = from->count,
                           .complete = from->complete,
                           .return_each = from->return_each,
                           .roll = roll & 0xFu};
    for (int i = 0; i < ARGUS_ROTATIONS_MAX && i < from->count; i++) {
        plan.rotation[i] = degrees(from->rotation_deg[i]);
    }
    size_t blind = 0; // one for each that faces forward, in the order of their numbers
    for (int i = 0; i < status->sonars; i++) {
        if ((status->forward >> i & 1u) != 0 && blind < sizeof plan.blind / sizeof plan.blind[0]) {
            plan.blind[blind++] = from->disabled >> i & 1u;
        }
    }
    hal_dbc_plan_pack(data, &plan);
}

// Schedule
// ---------------------------------------------------------------------------------------------------

// A build may manage fewer sonars than there are frames.
static int end_of_group(int first) {
    return first + GROUP < ARGUS_SONARS ? first + GROUP : ARGUS_SONARS;
}

static bool has_news(const hal_telemetry_t *self, const argus_status_t *status, int first) {
    for (int i = first; i < end_of_group(first); i++) {
        if (status->readings[i] != self->readings[i]) {
            return true;
        }
    }
    return false;
}

// Fills the frame of a slot as it would be now, and says how long after the last one it is due.
static uint32_t fill(hal_telemetry_t *self, const argus_status_t *status, unsigned slot, uint8_t *data) {
    const int first = slots[slot].first;
    switch (slots[slot].content) {
    case HEALTH:
        fill_health(self, status, first, data);
        break;
    case PLAN:
        fill_plan(status, self->plan_roll, data);
        break;
    case READINGS:
        fill_readings(self, status, first, data);
        if (!has_news(self, status, first)) {
            return HAL_TELEMETRY_PERIOD_MS;
        }
        return status->lists_all ? HAL_TELEMETRY_ALL_MS : HAL_TELEMETRY_READING_MS;
    case HEARTBEAT:
    default:
        return HAL_TELEMETRY_PERIOD_MS; // the heartbeat is filled when it goes, for its nonce
    }
    return memcmp(data, self->sent[slot].data, HAL_DBC_LENGTH) != 0 ? HAL_TELEMETRY_CHANGE_MS
                                                                    : HAL_TELEMETRY_PERIOD_MS;
}

static void sent(hal_telemetry_t *self, const argus_status_t *status, unsigned slot, uint32_t now_ms,
                 hal_telemetry_frame_t *frame) {
    hal_telemetry_sent_t *const s = &self->sent[slot];
    const content_t content = slots[slot].content;
    if (content == HEARTBEAT) {
        fill_heartbeat(self, status, state_of(status), next_nonce(self, now_ms), frame->data);
        self->roll++;
    } else if (content == PLAN && s->ever && memcmp(frame->data, s->data, HAL_DBC_LENGTH) != 0) {
        self->plan_roll++;
        fill_plan(status, self->plan_roll, frame->data);
    } else if (content == READINGS) {
        const int first = slots[slot].first;
        for (int i = first; i < end_of_group(first); i++) {
            self->readings[i] = status->readings[i];
        }
    }
    frame->id = (uint16_t)(HAL_DBC_HEARTBEAT_ID + self->robot * HAL_DBC_STEP_TELEMETRY + slot);
    frame->length = HAL_DBC_LENGTH;
    memcpy(s->data, frame->data, HAL_DBC_LENGTH);
    // What repeats keeps its beat, unless it comes much too late.
    const uint32_t late_ms = now_ms - s->sent_ms - s->wait_ms;
    s->sent_ms = s->ever && late_ms < HAL_TELEMETRY_READING_MS ? s->sent_ms + s->wait_ms : now_ms;
    s->wait_ms = HAL_TELEMETRY_PERIOD_MS;
    s->ever = true;
}

// Of sonars that the robot has not there is no frame.
static bool is_there(const hal_telemetry_t *self, unsigned slot) {
    return slots[slot].first < self->sonars;
}

static void tick(hal_telemetry_t *self, uint32_t now_ms) {
    const uint32_t passed_s = (now_ms - self->second_ms) / 1000u;
    self->uptime_s += passed_s;
    self->second_ms += passed_s * 1000u;
}

bool hal_telemetry_next(hal_telemetry_t *self, const argus_status_t *status, uint32_t now_ms,
                        hal_telemetry_frame_t *frame) {
    tick(self, now_ms);
    if (take_edge(self, now_ms, frame)) {
        return true;
    }
    self->sonars = status->sonars > SONARS_LEAST ? status->sonars : SONARS_LEAST;
    for (unsigned slot = 0; slot < HAL_TELEMETRY_SLOTS; slot++) {
        hal_telemetry_sent_t *const s = &self->sent[slot];
        if (!is_there(self, slot)) {
            continue;
        }
        s->wait_ms = fill(self, status, slot, frame->data);
        if (!s->ever || now_ms - s->sent_ms >= s->wait_ms) {
            sent(self, status, slot, now_ms, frame);
            return true;
        }
    }
    return false;
}

void hal_telemetry_farewell(hal_telemetry_t *self, const argus_status_t *status, uint32_t now_ms,
                            hal_telemetry_frame_t *frame) {
    tick(self, now_ms);
    sent(self, status, HEARTBEAT, now_ms, frame);
    self->roll--; // filled anew, but the same heartbeat
    fill_heartbeat(self, status, HAL_DBC_STATE_CLOSED, self->nonce[self->newest].value, frame->data);
    self->roll++;
}

static uint32_t sooner(uint32_t due_ms, uint32_t wait_ms, uint32_t passed_ms) {
    const uint32_t left_ms = passed_ms < wait_ms ? wait_ms - passed_ms : 0;
    return left_ms < due_ms ? left_ms : due_ms;
}

uint32_t hal_telemetry_due_ms(const hal_telemetry_t *self, uint32_t now_ms) {
    uint32_t due_ms = HAL_TELEMETRY_PERIOD_MS;
    for (unsigned slot = 0; slot < HAL_TELEMETRY_SLOTS; slot++) {
        const hal_telemetry_sent_t *const s = &self->sent[slot];
        if (!is_there(self, slot)) {
            continue;
        }
        due_ms = sooner(due_ms, s->ever ? s->wait_ms : 0, now_ms - s->sent_ms);
    }
    if (self->queued > 0) {
        due_ms = self->edges > 0 ? 0 : sooner(due_ms, HAL_TELEMETRY_EDGE_MS, now_ms - self->edge_ms);
    }
    return due_ms;
}

void hal_telemetry_init(hal_telemetry_t *self, uint8_t robot, uint32_t stale_ms, uint64_t seed,
                        uint32_t now_ms) {
    memset(self, 0, sizeof *self);
    self->robot = robot;
    self->sonars = SONARS_LEAST;
    self->stale_ms = stale_ms;
    self->second_ms = now_ms;
    self->edge_ms = now_ms;
    self->edges = HAL_TELEMETRY_EDGE_BURST;
    self->key = mix((uint32_t)seed) ^ mix((uint32_t)(seed >> 32) ^ 0x9E3779B9u);
    self->number = (uint16_t)(mix(self->key) & 0xFFFFu);
}
