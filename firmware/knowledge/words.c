// SPDX-License-Identifier: MIT
// Names of what the manager says: look-ups in the event catalogue and in the enumerations.
#include "argus/argus.h"

// Words in a row, an empty one at the end. A table of pointers would be initialized data in a
// position-independent build. One of texts of equal size would be mostly padding.
static const char *nth(const char *words, int number) {
    while (number > 0 && words[0] != '\0') {
        while (words[0] != '\0') {
            words++;
        }
        words++;
        number--;
    }
    return number < 0 || words[0] == '\0' ? "?" : words;
}

// As in argus_event_level(), so that both are one in an image.
static const uint16_t rows[] = {ARGUS_EVENT_TABLE(ARGUS_EVENT_PACKED)};

// Row of the catalogue, or -1.
static int row_of(const int id) {
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if ((rows[i] & ARGUS_EVENT_ID_MASK) == id) {
            return (int)i;
        }
    }
    return -1;
}

static const char *event_name(const int id) {
#define NAME(number, name, level, subject, meaning) #name "\0"
    return nth(ARGUS_EVENT_TABLE(NAME), row_of(id));
#undef NAME
}

static const char *event_subject(const int id) {
#define WORD(subject) #subject "\0"
    const int row = row_of(id);
    return nth(ARGUS_ABOUT_TABLE(WORD), row < 0 ? row : rows[row] >> ARGUS_EVENT_ABOUT_SHIFT);
#undef WORD
}

#define IN_ORDER(name, number, word, meaning) \
    _Static_assert(ARGUS_KIND_##name == (number), "rows follow each other");
ARGUS_FAULT_KIND_TABLE(IN_ORDER)

#define WORD(name, number, word, meaning) word "\0"

// Of an enumeration, from its first constant on.
static const char *words_of(const argus_name_of_t of) {
    switch (of) {
    case ARGUS_NAME_LEVEL:
        return "OK\0WARN\0ERROR\0STALE\0";
    case ARGUS_NAME_MODE:
        return "OFFLINE\0CHECKING\0VERIFYING\0IDLE\0DRIVING\0SWEEPING\0STEPPING\0BACKING\0WAITING\0CLOSING\0C"
               "LOSED\0CREEPING\0";
    case ARGUS_NAME_MISSION:
        return "none\0running\0reached\0failed\0";
    case ARGUS_NAME_WAIT:
        return "none\0bumper\0motors\0turn\0way\0catastrophic\0echo\0";
    case ARGUS_NAME_FAILURE:
        return "IsNormal\0IsMinor\0IsMajor\0IsCatastrophic\0";
    case ARGUS_NAME_HEALTH:
        return "UNKNOWN\0HEALTHY\0SUSPECT\0DISABLED\0PROBATION\0STALE\0ABSENT\0";
    case ARGUS_NAME_KIND:
        return ARGUS_FAULT_KIND_TABLE(WORD);
    case ARGUS_NAME_OP:
        return "STOP\0GO\0RECHECK\0MOVE\0TURN\0PASSIVE\0ACTIVE\0RETEST\0PIN\0UNPIN\0DISABLE\0";
    case ARGUS_NAME_BAR:
        return "unknown\0unsafe\0sonars\0";
    default:
        return "";
    }
}

const char *argus_name(const argus_name_of_t of, const int number) {
    if (of == ARGUS_NAME_EVENT) {
        return event_name(number);
    }
    if (of == ARGUS_NAME_SUBJECT) {
        return event_subject(number);
    }
    const bool none_is_empty = of == ARGUS_NAME_KIND || of == ARGUS_NAME_BAR;
    if (none_is_empty && number == 0) {
        return "";
    }
    const bool from_one = none_is_empty || of == ARGUS_NAME_OP;
    return nth(words_of(of), from_one ? number - 1 : number);
}
