// SPDX-License-Identifier: MIT
// What a program that cannot read C headers needs of them: sizes, names, and fields by number.
#include <stddef.h>
#include <string.h>

#include "arcos/frame.h"
#include "supervisor/manager.h"

size_t argus_shim_core_size(void);
size_t argus_shim_config_size(void);
const char *argus_shim_config_key(uint32_t row);
const char *argus_shim_config_choices(uint32_t row);
int32_t argus_shim_config_get(const argus_config_t *config, uint32_t row);
void argus_shim_config_set(argus_config_t *config, uint32_t row, int32_t value);
int32_t argus_shim_config_check(const argus_config_t *config, int32_t *row);
const char *argus_shim_ring_key(uint32_t row);
const char *argus_shim_ring_section(uint32_t row);
const char *argus_shim_ring_fault(int fault);
size_t argus_shim_robot_size(void);
void argus_shim_set_ring(argus_t *core, argus_robot_storage_t *storage, const char *name,
                         const int32_t *figures, const int32_t *mounts, uint8_t sonars,
                         const int32_t *forward, uint8_t forward_count, int32_t *report);
bool argus_shim_observe(argus_t *core, uint32_t now_ms, const int32_t *motion, const uint16_t *ranges,
                        uint8_t count);
bool argus_shim_is_open(const argus_t *core);
bool argus_shim_event(argus_t *core, int32_t *fields);
const char *argus_shim_event_field(uint32_t field);
const char *argus_shim_event_meaning(uint16_t id);
int argus_shim_event_level(uint16_t id);
const char *argus_shim_status_field(uint32_t field);
const char *argus_shim_sonar_field(uint32_t field);
void argus_shim_status(const argus_t *core, int64_t *fields, int64_t *sonars);
size_t argus_shim_brief_size(void);
void argus_shim_brief(const argus_t *core, uint8_t *bytes);
size_t argus_shim_replay(argus_t *core, const uint32_t *t_ms, const uint16_t *length, size_t packets,
                         const uint8_t *bytes, uint32_t *changes, size_t capacity);
size_t argus_shim_said_size(void);
size_t argus_shim_feed(argus_t *core, uint32_t *now_ms, const uint32_t *t_ms, const uint16_t *length,
                       size_t packets, const uint8_t *data, uint32_t *said, size_t *count);

size_t argus_shim_core_size(void) {
    return sizeof(argus_storage_t);
}

size_t argus_shim_config_size(void) {
    return sizeof(argus_config_t);
}

// Settings, by their row in the table; NULL or 0 beyond its end.

typedef struct {
    const char *key;
    const char *choices;
    size_t offset;
} row_t;

static const row_t rows[] = {
#define ROW(key, def, min, max, unit, choices, meaning) {#key, choices, offsetof(argus_config_t, key)},
    ARGUS_CONFIG_TABLE(ROW)
#undef ROW
};

#define ROWS (sizeof rows / sizeof rows[0])

const char *argus_shim_config_key(uint32_t row) {
    return row < ROWS ? rows[row].key : NULL;
}

const char *argus_shim_config_choices(uint32_t row) {
    return row < ROWS ? rows[row].choices : NULL;
}

int32_t argus_shim_config_get(const argus_config_t *config, uint32_t row) {
    int32_t value = 0;
    if (row < ROWS) {
        memcpy(&value, (const char *)config + rows[row].offset, sizeof value);
    }
    return value;
}

void argus_shim_config_set(argus_config_t *config, uint32_t row, int32_t value) {
    if (row < ROWS) {
        memcpy((char *)config + rows[row].offset, &value, sizeof value);
    }
}

// argus_config_fault_t; `*row` is the setting out of its range, or -1.
int32_t argus_shim_config_check(const argus_config_t *config, int32_t *row) {
    const argus_config_report_t report = argus_config_check(config);
    *row = report.key;
    return (int32_t)report.fault;
}

// A ring of the caller's own. The figures by their row in the table, NULL beyond its end.

typedef struct {
    const char *key;
    const char *section;
    size_t offset;
} figure_t;

static const figure_t ring_figures[] = {
#define FIGURE(key, section, def, min, max, meaning) {#key, #section, offsetof(argus_ring_t, key)},
    ARGUS_RING_TABLE(FIGURE)
#undef FIGURE
};

#define FIGURES (sizeof ring_figures / sizeof ring_figures[0])

const char *argus_shim_ring_key(uint32_t row) {
    return row < FIGURES ? ring_figures[row].key : NULL;
}

const char *argus_shim_ring_section(uint32_t row) {
    return row < FIGURES ? ring_figures[row].section : NULL;
}

const char *argus_shim_ring_fault(const int fault) {
    switch (fault) {
#define MEANING(id, name, meaning) \
    case id:                       \
        return meaning;
        ARGUS_RING_FAULT_TABLE(MEANING)
#undef MEANING
    default:
        return "";
    }
}

size_t argus_shim_robot_size(void) {
    return sizeof(argus_robot_storage_t);
}

// `mounts`: x, y, heading and role of each sonar; `report`: fault, key, sonar. `core` may be NULL.
void argus_shim_set_ring(argus_t *core, argus_robot_storage_t *storage, const char *name,
                         const int32_t *figures, const int32_t *mounts, uint8_t sonars,
                         const int32_t *forward, uint8_t forward_count, int32_t *report) {
    argus_sonar_mount_t poses[UINT8_MAX];
    argus_ring_t ring = {.name = name, .mounts = poses, .sonars = sonars, .forward_count = forward_count};
    for (size_t i = 0; i < FIGURES; i++) {
        memcpy((char *)&ring + ring_figures[i].offset, &figures[i], sizeof figures[i]);
    }
    for (size_t i = 0; i < sonars; i++) {
        const int32_t *const at = &mounts[4 * i];
        poses[i] = (argus_sonar_mount_t){(int16_t)at[0], (int16_t)at[1], (int16_t)at[2], (uint8_t)at[3]};
    }
    for (size_t i = 0; i < forward_count && i < ARGUS_FORWARD_SONARS; i++) {
        ring.forward[i] = (uint8_t)forward[i];
    }
    const argus_ring_report_t found = argus_set_ring(core, storage, &ring);
    report[0] = found.fault;
    report[1] = found.key;
    report[2] = found.sonar;
}

// `motion`: x, y, heading, speed, turn; `ranges`: sonar, mm and age of each.
bool argus_shim_observe(argus_t *core, uint32_t now_ms, const int32_t *motion, const uint16_t *ranges,
                        uint8_t count) {
    argus_range_t taken[UINT8_MAX];
    for (size_t i = 0; i < count; i++) {
        const uint16_t *const from = &ranges[3 * i];
        taken[i] = (argus_range_t){(uint8_t)from[0], from[1], from[2]};
    }
    const argus_observation_t observation = {.pose = {motion[0], motion[1], motion[2]},
                                             .speed_mm_s = motion[3],
                                             .turn_cdeg_s = motion[4],
                                             .ranges = taken,
                                             .count = count};
    return argus_observe(core, now_ms, &observation);
}

bool argus_shim_is_open(const argus_t *core) {
    return argus_session_is_open(&core->session);
}

// Fields, by number; the names end with NULL.

#define EVENT_TABLE(X) X(t_ms) X(id) X(sonar) X(state) X(value)

static const char *const event_names[] = {
#define NAME(field) #field,
    EVENT_TABLE(NAME)
#undef NAME
};

const char *argus_shim_event_field(uint32_t field) {
    return field < sizeof event_names / sizeof event_names[0] ? event_names[field] : NULL;
}

bool argus_shim_event(argus_t *core, int32_t *fields) {
    argus_event_t event;
    if (!argus_next_event(core, &event)) {
        return false;
    }
    size_t at = 0;
#define PUT(field) fields[at++] = (int32_t)event.field;
    EVENT_TABLE(PUT)
#undef PUT
    return true;
}

int argus_shim_event_level(const uint16_t id) {
    return (int)argus_event_level(id);
}

const char *argus_shim_event_meaning(uint16_t id) {
    switch (id) {
#define MEANING(number, name, level, subject, meaning) \
    case number:                                       \
        return meaning;
        ARGUS_EVENT_TABLE(MEANING)
#undef MEANING
    default:
        return "";
    }
}

#define STATUS_TABLE(X) \
    X(mode)             \
    X(failure)          \
    X(online)           \
    X(battery_dv)       \
    X(flags)            \
    X(bumpers_front)    \
    X(bumpers_rear)     \
    X(sips)             \
    X(bad_checksums)    \
    X(skipped_bytes)    \
    X(stops)            \
    X(goal_mm)          \
    X(sonars)
#define SONAR_TABLE(X) X(reading_mm) X(age_ms) X(health) X(kind)

static const char *const status_names[] = {
#define NAME(field) #field,
    STATUS_TABLE(NAME)
#undef NAME
};

static const char *const sonar_names[] = {
#define NAME(field) #field,
    SONAR_TABLE(NAME)
#undef NAME
};

const char *argus_shim_status_field(uint32_t field) {
    return field < sizeof status_names / sizeof status_names[0] ? status_names[field] : NULL;
}

const char *argus_shim_sonar_field(uint32_t field) {
    return field < sizeof sonar_names / sizeof sonar_names[0] ? sonar_names[field] : NULL;
}

// `sonars` gets its fields for sonar 0, then for sonar 1, ...
void argus_shim_status(const argus_t *core, int64_t *fields, int64_t *sonars) {
    argus_status_t status;
    size_t at = 0;
    argus_status(core, &status);
#define PUT(field) fields[at++] = (int64_t)status.field;
    STATUS_TABLE(PUT)
#undef PUT
    at = 0;
    for (size_t k = 0; k < ARGUS_SONARS; k++) {
#define PUT(field) sonars[at++] = (int64_t)status.field[k];
        SONAR_TABLE(PUT)
#undef PUT
    }
}

// What a simulator looks at after every call: mode, mission, then health and kind of each sonar, a byte each.
#define BRIEF_HEAD ((size_t)2)

size_t argus_shim_brief_size(void) {
    return BRIEF_HEAD + 2 * (size_t)ARGUS_SONARS;
}

void argus_shim_brief(const argus_t *core, uint8_t *bytes) {
    bytes[0] = (uint8_t)core->mode;
    bytes[1] = (uint8_t)core->mission;
    for (size_t k = 0; k < ARGUS_SONARS; k++) {
        bytes[BRIEF_HEAD + k] = (uint8_t)core->knowledge.sonar[k].health;
        bytes[BRIEF_HEAD + ARGUS_SONARS + k] = (uint8_t)core->knowledge.sonar[k].kind;
    }
}

// A whole recording at once, for programs that judge many. The packets of a robot, `length[i]` of `bytes`
// each at t_ms[i] (rising), go into a manager that was just made at 0 ms. What it says and sends is thrown
// away. `changes` gets four values for each change of a sonar, as far as there is room: ms, sonar, health,
// kind. Returns how many there were.

typedef struct {
    argus_t *core;
    uint32_t *changes;
    size_t capacity;
    size_t count;
    uint8_t health[ARGUS_SONARS];
    uint8_t kind[ARGUS_SONARS];
} replay_t;

static void note_changes(replay_t *const self, const uint32_t now_ms) {
    for (size_t k = 0; k < ARGUS_SONARS; k++) {
        const argus_sonar_t *const sonar = &self->core->knowledge.sonar[k];
        if (self->health[k] == (uint8_t)sonar->health && self->kind[k] == (uint8_t)sonar->kind) {
            continue;
        }
        self->health[k] = (uint8_t)sonar->health;
        self->kind[k] = (uint8_t)sonar->kind;
        if (self->count < self->capacity) {
            uint32_t *const row = &self->changes[4 * self->count];
            row[0] = now_ms;
            row[1] = (uint32_t)k;
            row[2] = self->health[k];
            row[3] = self->kind[k];
        }
        self->count++;
    }
}

static uint32_t serve(replay_t *const self, const uint32_t now_ms) {
    uint8_t packet[UINT8_MAX];
    argus_event_t event;
    const uint32_t wait_ms = argus_process(self->core, now_ms);
    while (argus_transmit(self->core, packet, sizeof packet) > 0) {
    }
    while (argus_next_event(self->core, &event)) {
    }
    note_changes(self, now_ms);
    return now_ms + (wait_ms > 0 ? wait_ms : 1);
}

size_t argus_shim_replay(argus_t *core, const uint32_t *t_ms, const uint16_t *length, size_t packets,
                         const uint8_t *bytes, uint32_t *changes, size_t capacity) {
    replay_t self = {.core = core, .changes = changes, .capacity = capacity};
    argus_link_up(core, 0);
    uint32_t due_ms = serve(&self, 0);
    for (size_t i = 0; i < packets; i++) {
        while (due_ms < t_ms[i]) {
            due_ms = serve(&self, due_ms);
        }
        argus_receive(core, t_ms[i], bytes, length[i]);
        bytes += length[i];
        due_ms = serve(&self, t_ms[i]);
    }
    return self.count;
}

// A part of a recording at once, for a manager in a session. The data parts of a robot's packets, `length[i]`
// of `data` each, come at t_ms[i] (none before `*now_ms`, which goes with them). What the manager sends is
// thrown away; what it reports goes to `said`: the packet's number, the time, then the event's fields. It
// ends behind the packet that closes the session or leaves no room. Returns how many packets were taken.

#define SAID_ROWS ((size_t)1024)
#define SAID_FIELDS ((size_t)7)

typedef struct {
    argus_t *core;
    uint32_t *said;
    size_t count;
    uint32_t packet;
    uint32_t now_ms;
} feed_t;

size_t argus_shim_said_size(void) {
    return SAID_ROWS * SAID_FIELDS;
}

static void drain(feed_t *const self) {
    uint8_t packet[UINT8_MAX];
    int32_t fields[SAID_FIELDS];
    while (argus_transmit(self->core, packet, sizeof packet) > 0) {
    }
    while (self->count < SAID_ROWS && argus_shim_event(self->core, fields)) {
        uint32_t *const row = &self->said[SAID_FIELDS * self->count++];
        row[0] = self->packet;
        row[1] = self->now_ms;
        memcpy(&row[2], fields, (SAID_FIELDS - 2) * sizeof fields[0]);
    }
}

static void feed_packet(feed_t *const self, const uint8_t *const data, const uint16_t length) {
    uint8_t wire[ARGUS_FRAME_TOTAL_MAX] = {ARCOS_FRAME_HEADER0, ARCOS_FRAME_HEADER1, (uint8_t)(length + 2)};
    const uint16_t checksum = argus_frame_checksum(data, length);
    memcpy(&wire[ARCOS_FRAME_OVERHEAD], data, length);
    wire[ARCOS_FRAME_OVERHEAD + length] = (uint8_t)(checksum >> 8);
    wire[ARCOS_FRAME_OVERHEAD + length + 1] = (uint8_t)(checksum & UINT8_MAX);
    argus_receive(self->core, self->now_ms, wire, (size_t)ARCOS_FRAME_OVERHEAD + length + 2);
    argus_process(self->core, self->now_ms);
    drain(self);
}

static void feed_time(feed_t *const self, const uint32_t until_ms) {
    while ((int32_t)(until_ms - self->now_ms) > 0 && argus_shim_is_open(self->core)) {
        const uint32_t wait_ms = argus_process(self->core, self->now_ms);
        const uint32_t left_ms = until_ms - self->now_ms;
        const uint32_t step_ms = wait_ms > 0 ? wait_ms : 1;
        self->now_ms += step_ms < left_ms ? step_ms : left_ms;
        drain(self);
    }
}

size_t argus_shim_feed(argus_t *core, uint32_t *now_ms, const uint32_t *t_ms, const uint16_t *length,
                       size_t packets, const uint8_t *data, uint32_t *said, size_t *count) {
    feed_t self = {.core = core, .said = said, .now_ms = *now_ms};
    size_t taken = 0;
    while (taken < packets && argus_shim_is_open(core) && self.count <= SAID_ROWS / 2) {
        self.packet = (uint32_t)taken;
        feed_time(&self, t_ms[taken]);
        feed_packet(&self, data, length[taken]);
        data += length[taken];
        taken++;
    }
    *now_ms = self.now_ms;
    *count = self.count;
    return taken;
}
