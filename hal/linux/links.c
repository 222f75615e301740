// SPDX-License-Identifier: MIT
// The table of schemes, and the calls that find their way through it.
#include "hal/links.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "hal/meant.h"

#define FORMS_MAX 256

static const hal_scheme_t *const table[] = {
#define SCHEME_ENTRY(name) &hal_##name##_scheme,
    HAL_SCHEME_TABLE(SCHEME_ENTRY)
#undef SCHEME_ENTRY
};

const hal_scheme_t *hal_scheme_at(size_t index) {
    return index < sizeof table / sizeof table[0] ? table[index] : NULL;
}

void hal_scheme_forms(char *text, size_t capacity) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; hal_scheme_at(i) != NULL && used < capacity; i++) {
        const char *const next = hal_scheme_at(i + 1) != NULL ? ", " : " or ";
        used += (size_t)snprintf(text + used, capacity - used, "%s%s", i == 0 ? "" : next, table[i]->form);
    }
}

bool hal_link_refuse(char *message, size_t capacity, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, capacity, format, arguments);
    va_end(arguments);
    return false;
}

bool hal_link_number(const char *text, uint32_t *value) {
    const size_t digits = strspn(text, "0123456789");
    if (digits == 0 || digits > 6 || text[digits] != '\0') {
        return false;
    }
    *value = 0;
    for (size_t i = 0; i < digits; i++) {
        *value = *value * 10u + (uint32_t)(text[i] - '0');
    }
    return true;
}

bool hal_link_take_target(hal_link_spec_t *spec, const char *text, size_t length, size_t capacity) {
    if (length == 0 || length >= capacity || length >= sizeof spec->target) {
        return false;
    }
    memcpy(spec->target, text, length);
    spec->target[length] = '\0';
    return true;
}

static bool begins(const char *text, const char *start) {
    return start != NULL && strncmp(text, start, strlen(start)) == 0;
}

// NULL: no scheme of the table stands before a ':'.
static const hal_scheme_t *scheme_of(const char *text) {
    for (size_t i = 0; hal_scheme_at(i) != NULL; i++) {
        if (begins(text, table[i]->word) && text[strlen(table[i]->word)] == ':') {
            return table[i];
        }
    }
    return NULL;
}

static bool refuse_unknown(const char *text, char *message, size_t capacity) {
    char forms[FORMS_MAX];
    char question[HAL_MEANT_MAX];
    hal_meant_t meant;
    for (size_t i = 0; hal_scheme_at(i) != NULL; i++) {
        if (begins(text, table[i]->bare)) {
            return hal_link_refuse(message, capacity, "link '%s': the scheme is missing; write %s:%s", text,
                                   table[i]->word, text);
        }
    }
    hal_meant_begin(&meant, text, strcspn(text, ":"));
    for (size_t i = 0; hal_scheme_at(i) != NULL; i++) {
        hal_meant_weigh(&meant, table[i]->word, strlen(table[i]->word));
    }
    hal_meant_ask(&meant, "", question, sizeof question);
    hal_scheme_forms(forms, sizeof forms);
    return hal_link_refuse(message, capacity, "link '%s': unknown scheme%s write %s", text,
                           question[0] == '\0' ? ";" : question, forms);
}

bool hal_link_spec_parse(hal_link_spec_t *spec, const char *text, char *message, size_t capacity) {
    const hal_scheme_t *const scheme = scheme_of(text);
    memset(spec, 0, sizeof *spec);
    spec->scheme = scheme;
    if (scheme == NULL) {
        return refuse_unknown(text, message, capacity);
    }
    return scheme->parse(spec, text + strlen(scheme->word) + 1, message, capacity);
}

const char *hal_link_spec_target(const hal_link_spec_t *spec) {
    return spec->target;
}

void hal_link_spec_name(const hal_link_spec_t *spec, char *text, size_t capacity) {
    if (spec->scheme->name != NULL) {
        spec->scheme->name(spec, text, capacity);
    } else {
        snprintf(text, capacity, "%s", spec->target);
    }
}

bool hal_link_spec_stays_here(const hal_link_spec_t *spec) {
    return spec->scheme->stays_here != NULL && spec->scheme->stays_here(spec);
}

bool hal_link_spec_has_rate(const hal_link_spec_t *spec) {
    return spec->scheme != NULL && spec->scheme->set_baud != NULL;
}

const hal_can_spec_t *hal_link_spec_bus(const hal_link_spec_t *spec) {
    return spec->scheme->bus == NULL ? NULL : spec->scheme->bus(spec);
}

void hal_transport_init(hal_transport_t *self) {
    memset(self, 0, sizeof *self);
}

hal_link_error_t hal_transport_open(hal_transport_t *self, const hal_link_spec_t *spec, int timeout_ms,
                                    int cancel_fd, hal_link_t *link) {
    const hal_scheme_t *const scheme = spec->scheme;
    if (self->scheme != scheme) {
        scheme->init(self->state.bytes);
        self->scheme = scheme;
    }
    const hal_link_error_t error = scheme->open(self->state.bytes, spec, timeout_ms, cancel_fd);
    if (error == HAL_LINK_OK) {
        *link = scheme->link(self->state.bytes);
    }
    return error;
}

bool hal_transport_moved(const hal_transport_t *self) {
    return self->scheme != NULL && self->scheme->moved != NULL && self->scheme->moved(self->state.bytes);
}

hal_link_error_t hal_transport_set_baud(hal_transport_t *self, uint32_t baud) {
    if (self->scheme == NULL || self->scheme->set_baud == NULL) {
        return HAL_LINK_BAD_BAUD;
    }
    return self->scheme->set_baud(self->state.bytes, baud);
}

const hal_isotp_t *hal_transport_isotp(const hal_transport_t *self) {
    const bool has = self->scheme != NULL && self->scheme->isotp != NULL;
    return has ? self->scheme->isotp(self->state.bytes) : NULL;
}

void hal_transport_explain(const hal_link_spec_t *spec, hal_link_error_t error, char *text, size_t capacity) {
    spec->scheme->explain(spec, error, text, capacity);
}
