// SPDX-License-Identifier: MIT
// Calls on a link through its function table, and the texts of its errors.
#include "hal/link.h"

const char *hal_link_error_text(int error) {
    switch (error) {
    case HAL_LINK_OK:
        return "ok";
#define ERROR_CASE(name, value, text) \
    case value:                       \
        return text;
        HAL_LINK_ERROR_TABLE(ERROR_CASE)
#undef ERROR_CASE
    default:
        return "unknown error";
    }
}

int hal_link_read(const hal_link_t *link, uint8_t *bytes, size_t capacity) {
    return link->ops == NULL ? HAL_LINK_NOT_OPEN : link->ops->read(link->context, bytes, capacity);
}

int hal_link_write(const hal_link_t *link, const uint8_t *packet, size_t count) {
    return link->ops == NULL ? HAL_LINK_NOT_OPEN : link->ops->write(link->context, packet, count);
}

int hal_link_flush(const hal_link_t *link) {
    return link->ops == NULL ? HAL_LINK_NOT_OPEN : link->ops->flush(link->context);
}

uint32_t hal_link_hold_ms(const hal_link_t *link) {
    return link->ops == NULL || link->ops->hold_ms == NULL ? 0 : link->ops->hold_ms(link->context);
}

int hal_link_fd(const hal_link_t *link) {
    return link->ops == NULL ? -1 : link->ops->fd(link->context);
}

const char *hal_link_describe(const hal_link_t *link) {
    return link->ops == NULL ? "no link" : link->ops->describe(link->context);
}

hal_link_counters_t hal_link_counters(const hal_link_t *link) {
    static const hal_link_counters_t none = {0};
    return link->ops == NULL ? none : *link->ops->counters(link->context);
}

void hal_link_close(const hal_link_t *link) {
    if (link->ops != NULL) {
        link->ops->close(link->context);
    }
}
