// SPDX-License-Identifier: MIT
// Parses IFACE[,key=value...].
#include "hal/can_spec.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define FORM "can:can0,robot=0,tx=0x640,rx=0x648,pad=0xCC,stmin=0,bs=0,fd"
#define WORD_MAX 32

typedef struct {
    char *text;
    size_t capacity;
    const char *whole; // what is being read
} message_t;

__attribute__((format(printf, 2, 3))) static bool refuse(const message_t *message, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int used = snprintf(message->text, message->capacity, "can:%.64s: ", message->whole);
    if (used > 0 && (size_t)used < message->capacity) {
        vsnprintf(message->text + used, message->capacity - (size_t)used, format, arguments);
    }
    va_end(arguments);
    return false;
}

static int digit_of(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    if (c >= 'a' && c <= 'f') {
        return c - 'a' + 10;
    }
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : 99;
}

// A number of at most 6 digits, decimal or 0x..., and nothing else.
static bool number(const char *text, uint32_t *value) {
    const bool hex = text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    const int base = hex ? 16 : 10;
    const char *const digits = hex ? text + 2 : text;
    *value = 0;
    for (size_t i = 0; digits[i] != '\0'; i++) {
        if (i == 6 || digit_of(digits[i]) >= base) {
            return false;
        }
        *value = *value * (uint32_t)base + (uint32_t)digit_of(digits[i]);
    }
    return digits[0] != '\0';
}

typedef struct {
    bool tx;
    bool rx;
} given_t;

static bool take_number(hal_can_spec_t *spec, given_t *given, const char *key, uint32_t value,
                        const message_t *message) {
    if (strcmp(key, "robot") == 0) {
        spec->robot = (uint8_t)value;
    } else if (strcmp(key, "tx") == 0) {
        spec->tx_id = (uint16_t)value;
        given->tx = true;
    } else if (strcmp(key, "rx") == 0) {
        spec->rx_id = (uint16_t)value;
        given->rx = true;
    } else if (strcmp(key, "pad") == 0) {
        spec->padding = (uint8_t)value;
        spec->pads = true;
    } else if (strcmp(key, "stmin") == 0) {
        spec->stmin = (uint8_t)value;
    } else if (strcmp(key, "bs") == 0) {
        spec->blocksize = (uint8_t)value;
    } else {
        return refuse(message, "'%s' is no key; write " FORM, key);
    }
    return true;
}

static uint32_t limit_of(const char *key) {
    static const struct {
        char key[8];
        uint32_t limit;
    } table[] = {{"robot", HAL_DBC_ROBOTS - 1},
                 {"tx", HAL_CAN_ID_MAX},
                 {"rx", HAL_CAN_ID_MAX},
                 {"pad", 0xFF},
                 {"stmin", 127},
                 {"bs", 0xFF}};
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        if (strcmp(table[i].key, key) == 0) {
            return table[i].limit;
        }
    }
    return UINT32_MAX;
}

static bool take_word(hal_can_spec_t *spec, given_t *given, char *word, const message_t *message) {
    char *const equals = strchr(word, '=');
    uint32_t value = 0;
    if (equals == NULL) {
        if (strcmp(word, "fd") == 0) {
            spec->fd = true;
            return true;
        }
        return refuse(message, "'%s' is no option; write " FORM, word);
    }
    *equals = '\0';
    if (strcmp(word, "pad") == 0 && strcmp(equals + 1, "none") == 0) {
        spec->pads = false;
        return true;
    }
    if (!number(equals + 1, &value) || value > limit_of(word)) {
        return refuse(message, "%s=%s: give a number from 0 to %u", word, equals + 1,
                      (unsigned)limit_of(word));
    }
    return take_number(spec, given, word, value, message);
}

static bool take_interface(hal_can_spec_t *spec, const char *text, size_t length, const message_t *message) {
    if (length == 0) {
        return refuse(message,
                      "no interface is named; write can:can0 (ip -br link show type can lists them)");
    }
    // '/' and blanks cannot be in the name of an interface, ':' is what old aliases have.
    if (length >= sizeof spec->interface || strcspn(text, "/: \t") < length) {
        return refuse(message, "'%.*s' cannot be the name of an interface (at most %d characters)",
                      (int)(length < WORD_MAX ? length : WORD_MAX), text, HAL_CAN_NAME_MAX - 1);
    }
    memcpy(spec->interface, text, length);
    spec->interface[length] = '\0';
    return true;
}

static bool take_words(hal_can_spec_t *spec, given_t *given, const char *text, const message_t *message) {
    while (*text == ',') {
        char word[WORD_MAX];
        const size_t length = strcspn(text + 1, ",");
        if (length >= sizeof word) {
            return refuse(message, "'%.24s...' is no option; write " FORM, text + 1);
        }
        memcpy(word, text + 1, length);
        word[length] = '\0';
        if (!take_word(spec, given, word, message)) {
            return false;
        }
        text += 1 + length;
    }
    return true;
}

bool hal_can_spec_parse(hal_can_spec_t *spec, const char *text, char *message_text, size_t capacity) {
    const message_t message = {.text = message_text, .capacity = capacity, .whole = text};
    const size_t length = strcspn(text, ",");
    given_t given = {false, false};
    memset(spec, 0, sizeof *spec);
    spec->pads = true;
    spec->padding = HAL_CAN_PADDING;
    if (!take_interface(spec, text, length, &message) || !take_words(spec, &given, text + length, &message)) {
        return false;
    }
    if (!given.tx) {
        spec->tx_id = (uint16_t)(HAL_CAN_TO_ROBOT_ID + spec->robot);
    }
    if (!given.rx) {
        spec->rx_id = (uint16_t)(HAL_CAN_TO_HOST_ID + spec->robot);
    }
    if (spec->tx_id == spec->rx_id) {
        return refuse(&message, "tx and rx are both 0x%03X; the two directions need two ids",
                      (unsigned)spec->tx_id);
    }
    return true;
}

bool hal_can_spec_parse_telemetry(hal_can_spec_t *spec, const char *text, char *message, size_t capacity) {
    const message_t refusal = {.text = message, .capacity = capacity, .whole = text};
    const char *const comma = strchr(text, ',');
    if (comma != NULL && (strncmp(comma, ",robot=", 7) != 0 || strchr(comma + 1, ',') != NULL)) {
        return refuse(&refusal, "'%s' is not for the telemetry; write can0 or can0,robot=0", comma + 1);
    }
    return hal_can_spec_parse(spec, text, message, capacity);
}
