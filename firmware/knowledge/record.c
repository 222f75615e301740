// SPDX-License-Identifier: MIT
// The persistent record: what is remembered of every sonar between missions (SPEC.md, Record).
#include <string.h>

#include "argus/record.h"

#define VERSION 1
#define HEAD_BYTES 6  // "ARGR", version, sonars
#define SONAR_BYTES 4 // health, kind, disabled_times lo hi
#define CHECK_BYTES 2
#define RECORD_BYTES (HEAD_BYTES + ARGUS_SONARS * SONAR_BYTES + CHECK_BYTES)

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

size_t argus_record_encode(const argus_knowledge_t *const knowledge, uint8_t *const out,
                           const size_t capacity) {
    if (capacity < RECORD_BYTES) {
        return 0;
    }
    memcpy(out, magic, sizeof magic);
    out[4] = VERSION;
    out[5] = ARGUS_SONARS;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const argus_sonar_t *const s = &knowledge->sonar[i];
        const uint32_t sum = (uint32_t)s->disabled_times + s->disabled_before;
        const uint16_t times = sum > UINT16_MAX ? UINT16_MAX : (uint16_t)sum;
        uint8_t *const at = out + HEAD_BYTES + i * SONAR_BYTES;
        const argus_fault_kind_t kind = s->health == ARGUS_DISABLED ? s->kind : s->kind_before;
        at[0] = (uint8_t)s->health;
        at[1] = (uint8_t)kind;
        at[2] = (uint8_t)(times & 0xFFu);
        at[3] = (uint8_t)(times >> 8);
    }
    const uint16_t crc = crc16(out, RECORD_BYTES - CHECK_BYTES);
    out[RECORD_BYTES - 2] = (uint8_t)(crc & 0xFFu);
    out[RECORD_BYTES - 1] = (uint8_t)(crc >> 8);
    return RECORD_BYTES;
}

static argus_record_fault_t check(const uint8_t *const record, const size_t length) {
    if (length < HEAD_BYTES || memcmp(record, magic, sizeof magic) != 0) {
        return ARGUS_RECORD_DAMAGED;
    }
    if (record[4] != VERSION || record[5] != ARGUS_SONARS) {
        return ARGUS_RECORD_FOREIGN;
    }
    if (length != RECORD_BYTES) {
        return ARGUS_RECORD_DAMAGED;
    }
    const unsigned stored = record[RECORD_BYTES - 2] | (unsigned)record[RECORD_BYTES - 1] << 8;
    return stored == crc16(record, RECORD_BYTES - CHECK_BYTES) ? ARGUS_RECORD_OK : ARGUS_RECORD_DAMAGED;
}

argus_record_fault_t argus_record_decode(argus_knowledge_t *const knowledge, const uint8_t *const record,
                                         const size_t length) {
    const argus_record_fault_t fault = check(record, length);
    for (int i = 0; fault == ARGUS_RECORD_OK && i < ARGUS_SONARS; i++) {
        const uint8_t *const at = record + HEAD_BYTES + i * SONAR_BYTES;
        knowledge->sonar[i].kind_before = (argus_fault_kind_t)(at[1] <= ARGUS_KIND_INTERMITTENT ? at[1] : 0);
        knowledge->sonar[i].disabled_before = (uint16_t)(at[2] | (unsigned)at[3] << 8);
    }
    return fault;
}
