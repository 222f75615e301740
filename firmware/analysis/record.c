// SPDX-License-Identifier: MIT
// The persistent record: what is remembered of every sonar between missions (SPEC.md, Record).
#include "analysis/record.h"

#include <string.h>

#include "awareness/evidence.h"
#include "knowledge/angle.h"

#define VERSION 2
#define HEAD_BYTES 12 // "ARGR", version, sonars, robot, tests, SLOPES
#define SONAR_BYTES 43
#define SONARS_MAX 32 // of any build, which manages whole arrays
#define ARRAY 8
#define CHECK_BYTES 2
#define AT_SCORES 6
#define AT_UNUSED 18
#define SLOPES 3 // of statistics that are kept no more; 0 is written, whatever is read
#define SLOPE_BYTES 7
#define MISSION_MM 10000u // with less way a mission without a name is no sign of health

#define V1 1
#define V1_HEAD_BYTES 6  // "ARGR", version, sonars
#define V1_SONAR_BYTES 4 // health, kind, disabled_times lo hi

_Static_assert(ARGUS_RECORD_BYTES == HEAD_BYTES + ARGUS_SONARS * SONAR_BYTES + CHECK_BYTES,
               "length of the record");
_Static_assert(AT_UNUSED == AT_SCORES + 2 * ARGUS_KEPT, "scores");
_Static_assert(SONAR_BYTES == AT_UNUSED + 4 + SLOPE_BYTES * SLOPES, "slopes");

static const uint8_t magic[4] = {'A', 'R', 'G', 'R'};

// CRC-16/CCITT-FALSE.
static uint16_t crc16(const uint8_t *const data, const size_t count) {
    unsigned crc = 0xFFFFu;
    for (size_t i = 0; i < count; i++) {
        crc ^= (unsigned)data[i] << 8;
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc & 0x8000u) != 0 ? (crc << 1 ^ 0x1021u) & 0xFFFFu : crc << 1 & 0xFFFFu;
        }
    }
    return (uint16_t)crc;
}

static void put16(uint8_t *const at, const unsigned value) {
    at[0] = (uint8_t)(value & 0xFFu);
    at[1] = (uint8_t)(value >> 8 & 0xFFu);
}

static int16_t get_signed(const uint8_t *const at) {
    const int32_t value = argus_u16_at(at);
    return (int16_t)(value > INT16_MAX ? value - 0x10000 : value);
}

// FNV-1a, 32 bits; the end of each text counts.
static uint32_t mix(uint32_t hash, const char *const text) {
    size_t i = 0;
    do {
        hash = (hash ^ (uint8_t)text[i]) * 16777619u;
    } while (text[i++] != '\0');
    return hash;
}

uint32_t argus_record_robot(const char *const name, const char *const robot_class,
                            const char *const subclass) {
    const uint32_t hash = mix(mix(mix(2166136261u, name), robot_class), subclass);
    return hash == 0 ? 1 : hash;
}

// A mission without a fault makes up for one relapse.
static uint8_t relapses_of(const argus_sonar_t *const s) {
    const bool forgiven = s->relapses > 0 && s->disabled_times == 0 && s->health == ARGUS_HEALTHY;
    return (uint8_t)(s->relapses - (forgiven ? 1 : 0));
}

static void put_history(uint8_t *const at, const argus_sonar_t *const s) {
    const uint32_t sum = (uint32_t)s->disabled_times + s->disabled_before;
    const bool out = s->health == ARGUS_DISABLED || s->health == ARGUS_PROBATION;
    at[0] = (uint8_t)s->health;
    at[1] = (uint8_t)(out ? s->kind : s->kind_before);
    put16(at + 2, sum > UINT16_MAX ? UINT16_MAX : sum);
    at[4] = relapses_of(s);
}

static void put_evidence(uint8_t *const at, const argus_evidence_t *const evidence, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    for (int i = 0; i < ARGUS_KEPT; i++) {
        put16(at + AT_SCORES + 2 * i, (unsigned)argus_evidence_kept(evidence, sonar, (argus_kept_t)i));
    }
}

// Missions one after the other in which it was named, this one included.
static uint8_t missions_named(const argus_sonar_t *const s, const uint32_t odometer_mm) {
    if (s->named) {
        return argus_one_more(s->missions_named);
    }
    return odometer_mm < MISSION_MM ? s->missions_named : 0;
}

size_t argus_record_encode(const argus_knowledge_t *const knowledge, const argus_evidence_t *const evidence,
                           const uint32_t robot, uint8_t *const out, const size_t capacity) {
    if (capacity < ARGUS_RECORD_BYTES) {
        return 0;
    }
    memcpy(out, magic, sizeof magic);
    out[4] = VERSION;
    out[5] = ARGUS_SONARS;
    put16(out + 6, robot & 0xFFFFu);
    put16(out + 8, robot >> 16);
    out[10] = ARGUS_KEPT;
    out[11] = SLOPES;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        uint8_t *const at = out + HEAD_BYTES + i * SONAR_BYTES;
        memset(at, 0, SONAR_BYTES);
        put_history(at, &knowledge->sonar[i]);
        at[5] = missions_named(&knowledge->sonar[i], knowledge->odometer_mm);
        put_evidence(at, evidence, i);
    }
    put16(out + ARGUS_RECORD_BYTES - CHECK_BYTES, crc16(out, ARGUS_RECORD_BYTES - CHECK_BYTES));
    return ARGUS_RECORD_BYTES;
}

// Sonars of the build that wrote it, 0: of none. One that manages more than this one has written of more.
static size_t sonars_of(const uint8_t *const record) {
    const unsigned sonars = record[5];
    return sonars <= SONARS_MAX && sonars % ARRAY == 0 ? sonars : 0;
}

static size_t length_of(const uint8_t *const record) {
    return record[4] == V1 ? V1_HEAD_BYTES + sonars_of(record) * V1_SONAR_BYTES + CHECK_BYTES
                           : HEAD_BYTES + sonars_of(record) * SONAR_BYTES + CHECK_BYTES;
}

// Those of them that this build manages.
static int taken_of(const uint8_t *const record) {
    const int sonars = (int)sonars_of(record);
    return sonars < ARGUS_SONARS ? sonars : ARGUS_SONARS;
}

static bool is_known(const uint8_t *const record, const size_t length) {
    if (sonars_of(record) == 0 || (record[4] != V1 && record[4] != VERSION)) {
        return false;
    }
    return record[4] == V1 || length < HEAD_BYTES || (record[10] == ARGUS_KEPT && record[11] == SLOPES);
}

static argus_record_fault_t check(const uint8_t *const record, const size_t length) {
    if (length < V1_HEAD_BYTES || memcmp(record, magic, sizeof magic) != 0) {
        return ARGUS_RECORD_DAMAGED;
    }
    if (!is_known(record, length)) {
        return ARGUS_RECORD_FOREIGN;
    }
    if (length != length_of(record)) {
        return ARGUS_RECORD_DAMAGED;
    }
    const bool whole = argus_u16_at(record + length - CHECK_BYTES) == crc16(record, length - CHECK_BYTES);
    return whole ? ARGUS_RECORD_OK : ARGUS_RECORD_DAMAGED;
}

static void get_history(argus_sonar_t *const s, const uint8_t *const at) {
    s->kind_before = (argus_fault_kind_t)(at[1] < ARGUS_KINDS ? at[1] : 0);
    s->disabled_before = argus_u16_at(at + 2);
}

static void get_evidence(argus_evidence_t *const evidence, const int sonar, const uint8_t *const at,
                         const bool out) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    for (int i = 0; i < ARGUS_KEPT; i++) {
        argus_evidence_restore(evidence, sonar, (argus_kept_t)i, get_signed(at + AT_SCORES + 2 * i), out);
    }
}

static void take_v1(argus_knowledge_t *const knowledge, const uint8_t *const record) {
    for (int i = 0; i < taken_of(record); i++) {
        get_history(&knowledge->sonar[i], record + V1_HEAD_BYTES + i * V1_SONAR_BYTES);
    }
}

static void take(argus_knowledge_t *const knowledge, argus_evidence_t *const evidence,
                 argus_record_note_t *const note, const uint8_t *const record) {
    uint32_t mask = 0;
    note->robot = argus_u16_at(record + 6) | (uint32_t)argus_u16_at(record + 8) << 16;
    for (int i = 0; i < taken_of(record); i++) {
        const uint8_t *const at = record + HEAD_BYTES + i * SONAR_BYTES;
        const bool out = at[0] == ARGUS_DISABLED || at[0] == ARGUS_PROBATION;
        mask |= out ? (uint32_t)1 << i : 0u;
        get_history(&knowledge->sonar[i], at);
        knowledge->sonar[i].relapses = at[4];
        get_evidence(evidence, i, at, out);
        knowledge->sonar[i].missions_named = at[5];
    }
    note->out = (argus_mask_t)mask;
}

argus_record_fault_t argus_record_decode(argus_knowledge_t *const knowledge, argus_evidence_t *const evidence,
                                         argus_record_note_t *const note, const uint8_t *const record,
                                         const size_t length) {
    const argus_record_fault_t fault = check(record, length);
    note->robot = 0;
    note->out = 0;
    if (fault == ARGUS_RECORD_OK && record[4] == V1) {
        take_v1(knowledge, record);
    } else if (fault == ARGUS_RECORD_OK) {
        take(knowledge, evidence, note, record);
    }
    return fault;
}

void argus_record_forget(argus_knowledge_t *const knowledge, argus_evidence_t *const evidence) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_sonar_t *const s = &knowledge->sonar[i];
        s->kind_before = ARGUS_KIND_NONE;
        s->disabled_before = 0;
        s->relapses = 0;
        argus_evidence_forget(evidence, i);
        s->missions_named = 0;
    }
}
