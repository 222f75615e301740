// SPDX-License-Identifier: MIT
// Looks up the tables of the modes.
#include "behaviour/mode.h"

#define FROM_ANY                                                                        \
    (1u << ARGUS_MODE_CHECKING | 1u << ARGUS_MODE_VERIFYING | 1u << ARGUS_MODE_IDLE |   \
     1u << ARGUS_MODE_DRIVING | 1u << ARGUS_MODE_SWEEPING | 1u << ARGUS_MODE_STEPPING | \
     1u << ARGUS_MODE_CREEPING | 1u << ARGUS_MODE_BACKING | 1u << ARGUS_MODE_WAITING)
#define FROM_OFFLINE (1u << ARGUS_MODE_OFFLINE)
#define FROM_CHECKING (1u << ARGUS_MODE_CHECKING)
#define FROM_IDLE (1u << ARGUS_MODE_IDLE)
#define FROM_DRIVING (1u << ARGUS_MODE_DRIVING)
#define FROM_SWEEPING (1u << ARGUS_MODE_SWEEPING)
#define FROM_STEPPING (1u << ARGUS_MODE_STEPPING)
#define FROM_CREEPING (1u << ARGUS_MODE_CREEPING)
#define FROM_CLOSING (1u << ARGUS_MODE_CLOSING)

typedef struct {
    uint8_t may;
    uint16_t limit_ms;
} row_t;

static const row_t *row_of(const argus_mode_t mode) {
    static const row_t rows[] = {
#define ROW(name, may, limit, then, meaning) {(may), (limit)},
        ARGUS_MODE_TABLE(ROW)
#undef ROW
    };
    ARGUS_ASSERT(mode <= ARGUS_MODE_CREEPING);
    return &rows[mode];
}

bool argus_mode_may(const argus_mode_t mode, const unsigned what) {
    ARGUS_ASSERT((unsigned)mode <= ARGUS_MODE_CREEPING);
    return (row_of(mode)->may & what) == what;
}

bool argus_mode_may_follow(const argus_mode_t from, const argus_mode_t to) {
    ARGUS_ASSERT(from <= ARGUS_MODE_CREEPING && to <= ARGUS_MODE_CREEPING);
    static const uint16_t way[][2] = {
#define WAY(from, to, when) {FROM_##from, ARGUS_MODE_##to},
        ARGUS_WAY_TABLE(WAY)
#undef WAY
    };
    for (size_t i = 0; i < sizeof way / sizeof way[0]; i++) {
        if ((way[i][0] >> from & 1u) != 0 && way[i][1] == to) {
            return true;
        }
    }
    return from == to;
}

uint32_t argus_mode_limit_ms(const argus_mode_t mode) {
    ARGUS_ASSERT((unsigned)mode <= ARGUS_MODE_CREEPING);
    return row_of(mode)->limit_ms;
}
