// SPDX-License-Identifier: MIT
// The kernel's ISO-TP sockets as a link.
#include "hal/isotp.h"

#include <linux/can/isotp.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>

#define READS_MAX 16 // errors passed over in one read: a flood of them must not keep time from passing
#define HOLD_MS 2u   // while the queue is full; a frame takes 0.3 ms at 500 kbit/s

void hal_isotp_init(hal_isotp_t *self, const hal_can_sys_t *sys) {
    memset(self, 0, sizeof *self);
    self->sys = sys;
    self->fd = -1;
    hal_can_ear_init(&self->ear, sys);
}

static void drop_socket(hal_isotp_t *self) {
    hal_can_ear_close(&self->ear);
    if (self->fd >= 0) {
        self->sys->close(self->fd);
    }
    self->fd = -1;
    self->is_down = false;
}

static int set_options(const hal_can_sys_t *sys, int fd, const hal_can_spec_t *spec) {
    const struct can_isotp_options options = {.flags = spec->pads ? CAN_ISOTP_TX_PADDING : 0u,
                                              .frame_txtime = CAN_ISOTP_DEFAULT_FRAME_TXTIME,
                                              .txpad_content = spec->padding};
    const struct can_isotp_fc_options flow = {.bs = spec->blocksize, .stmin = spec->stmin};
    const struct can_isotp_ll_options frames = {
        .mtu = CANFD_MTU, .tx_dl = CANFD_MAX_DLEN, .tx_flags = CANFD_BRS};
    int failed = sys->set(fd, SOL_CAN_ISOTP, CAN_ISOTP_OPTS, &options, sizeof options);
    if (failed == 0) {
        failed = sys->set(fd, SOL_CAN_ISOTP, CAN_ISOTP_RECV_FC, &flow, sizeof flow);
    }
    if (failed == 0 && spec->fd) {
        failed = sys->set(fd, SOL_CAN_ISOTP, CAN_ISOTP_LL_OPTS, &frames, sizeof frames);
    }
    return failed;
}

static hal_link_error_t open_anew(hal_isotp_t *self, const hal_can_spec_t *spec) {
    const int fd = self->sys->socket(SOCK_DGRAM, CAN_ISOTP);
    if (fd < 0) {
        return hal_can_error_of(fd);
    }
    self->fd = fd;
    const int index = hal_can_interface(self->sys, fd, spec->interface, spec->fd);
    if (index < 0) {
        drop_socket(self);
        return (hal_link_error_t)index;
    }
    const struct sockaddr_can address = {.can_family = AF_CAN,
                                         .can_ifindex = index,
                                         .can_addr.tp = {.rx_id = spec->rx_id, .tx_id = spec->tx_id}};
    int failed = set_options(self->sys, fd, spec);
    if (failed == 0) {
        failed = self->sys->bind(fd, &address);
    }
    if (failed != 0) {
        drop_socket(self);
        return hal_can_error_of(failed);
    }
    self->index = index;
    return HAL_LINK_OK;
}

// The socket kept from before the interface went down works again, unless the interface was made anew.
static hal_link_error_t open_kept(hal_isotp_t *self, const hal_can_spec_t *spec) {
    uint8_t stale[HAL_ISOTP_PDU_MAX];
    const int index = hal_can_interface(self->sys, self->fd, spec->interface, spec->fd);
    if (index != self->index) {
        if (index == HAL_LINK_DOWN) {
            return HAL_LINK_DOWN;
        }
        drop_socket(self);
        return index < 0 ? (hal_link_error_t)index : open_anew(self, spec);
    }
    for (int i = 0; i < READS_MAX; i++) {
        if (self->sys->recv(self->fd, stale, sizeof stale) == -EAGAIN) {
            break;
        }
    }
    return HAL_LINK_OK;
}

hal_link_error_t hal_isotp_open(hal_isotp_t *self, const hal_can_spec_t *spec) {
    if (self->is_open) {
        return HAL_LINK_BUSY;
    }
    const hal_link_error_t error = self->fd >= 0 ? open_kept(self, spec) : open_anew(self, spec);
    if (error == HAL_LINK_OK) {
        self->is_open = true;
        self->is_down = false;
        self->hold = 0;
        self->taken = self->length = 0;
        hal_can_ear_open(&self->ear, spec, self->index);
        snprintf(self->text, sizeof self->text, "can:%s 0x%03X/0x%03X%s", spec->interface,
                 (unsigned)spec->tx_id, (unsigned)spec->rx_id, spec->fd ? " fd" : "");
    }
    return error;
}

// Counts an error that the session survives; false for one that it does not.
static bool survives(hal_isotp_t *self, int number) {
    static const int numbers[] = {
#define ISOTP_NUMBER(name, word, number, text) number,
        HAL_ISOTP_ERROR_TABLE(ISOTP_NUMBER)
#undef ISOTP_NUMBER
    };
    for (int i = 0; i < HAL_ISOTP_ERRORS; i++) {
        if (numbers[i] != 0 && numbers[i] == number) {
            self->errors[i]++;
            return i != HAL_ISOTP_DOWN;
        }
    }
    return number == EINTR;
}

static int lost(hal_isotp_t *self, int number) {
    self->is_down = number == ENETDOWN;
    return hal_can_error_of(-number);
}

// 0 and a PDU held, 0 and none held, or an error.
static int fetch(hal_isotp_t *self) {
    for (int i = 0; i < READS_MAX; i++) {
        const ssize_t got = self->sys->recv(self->fd, self->pdu, sizeof self->pdu);
        if (got == -EAGAIN) {
            self->errors[HAL_ISOTP_FORMAT] += hal_can_ear_hear(&self->ear);
            return 0;
        }
        if (got < 0) {
            if (!survives(self, (int)-got)) {
                return lost(self, (int)-got);
            }
        } else if (got > HAL_ISOTP_PDU_MAX) {
            self->errors[HAL_ISOTP_TOO_LONG]++;
        } else if (got > 0) {
            self->taken = 0;
            self->length = (uint16_t)got;
            self->counters.bytes_in += (uint32_t)got;
            hal_can_ear_close(&self->ear);
            return 0;
        }
    }
    return 0;
}

static int isotp_read(void *context, uint8_t *bytes, size_t capacity) {
    hal_isotp_t *const self = context;
    if (!self->is_open) {
        return HAL_LINK_NOT_OPEN;
    }
    if (bytes == NULL || capacity == 0) {
        return HAL_LINK_BAD_ARGUMENT;
    }
    if (self->taken == self->length) {
        self->taken = self->length = 0;
        const int error = fetch(self);
        if (error < 0) {
            return error;
        }
    }
    const size_t left = (size_t)(self->length - self->taken);
    const size_t count = left < capacity ? left : capacity;
    memcpy(bytes, self->pdu + self->taken, count);
    self->taken = (uint16_t)(self->taken + count);
    return (int)count;
}

static int isotp_write(void *context, const uint8_t *packet, size_t count) {
    hal_isotp_t *const self = context;
    if (!self->is_open) {
        return HAL_LINK_NOT_OPEN;
    }
    if (packet == NULL || count == 0) {
        return HAL_LINK_BAD_ARGUMENT;
    }
    if (count > HAL_ISOTP_PDU_MAX) {
        return HAL_LINK_TOO_LONG;
    }
    const ssize_t sent = self->sys->send(self->fd, packet, count);
    self->hold = sent == -ENOBUFS;
    // ECOMM and the like belong to an earlier packet: this one was not taken, and is tried again.
    if (sent < 0 && sent != -EAGAIN && !survives(self, (int)-sent)) {
        return lost(self, (int)-sent);
    }
    if (sent < 0) {
        self->counters.would_block++;
        return 0;
    }
    self->counters.bytes_out += (uint32_t)sent;
    self->counters.writes++;
    return (int)count;
}

static int isotp_flush(void *context) {
    const hal_isotp_t *const self = context;
    return self->is_open ? 0 : HAL_LINK_NOT_OPEN;
}

static uint32_t isotp_hold_ms(const void *context) {
    const hal_isotp_t *const self = context;
    return self->hold ? HOLD_MS : 0;
}

static int isotp_fd(const void *context) {
    const hal_isotp_t *const self = context;
    return self->is_open ? self->fd : -1;
}

static const char *isotp_describe(const void *context) {
    const hal_isotp_t *const self = context;
    return self->text[0] != '\0' ? self->text : "can";
}

static const hal_link_counters_t *isotp_counters(const void *context) {
    const hal_isotp_t *const self = context;
    return &self->counters;
}

static void isotp_close(void *context) {
    hal_isotp_t *const self = context;
    self->is_open = false;
    if (!self->is_down) {
        drop_socket(self);
    }
}

hal_link_t hal_isotp_link(hal_isotp_t *self) {
    static const hal_link_ops_t ops = {.read = isotp_read,
                                       .write = isotp_write,
                                       .flush = isotp_flush,
                                       .hold_ms = isotp_hold_ms,
                                       .fd = isotp_fd,
                                       .describe = isotp_describe,
                                       .counters = isotp_counters,
                                       .close = isotp_close};
    return (hal_link_t){.ops = &ops, .context = self};
}

const char *hal_isotp_error_name(hal_isotp_error_t error) {
    static const char *const names[] = {
#define ISOTP_NAME(name, word, number, text) #word,
        HAL_ISOTP_ERROR_TABLE(ISOTP_NAME)
#undef ISOTP_NAME
    };
    return (unsigned)error < HAL_ISOTP_ERRORS ? names[error] : "unknown";
}

const char *hal_isotp_error_text(hal_isotp_error_t error) {
    static const char *const texts[] = {
#define ISOTP_TEXT(name, word, number, text) text,
        HAL_ISOTP_ERROR_TABLE(ISOTP_TEXT)
#undef ISOTP_TEXT
    };
    return (unsigned)error < HAL_ISOTP_ERRORS ? texts[error] : "unknown error";
}

void hal_isotp_explain(hal_link_error_t error, const hal_can_spec_t *spec, char *text, size_t capacity) {
    const char *const name = spec->interface;
    switch ((int)error) {
    case HAL_LINK_NO_CAN:
        snprintf(text, capacity,
                 "%s: the kernel has no CAN, or its module is not loaded: modprobe can-isotp (a kernel built "
                 "without CAN has no such module)",
                 name);
        break;
    case HAL_LINK_NO_PROTOCOL:
        snprintf(text, capacity,
                 "%s: the kernel module can-isotp is not loaded: modprobe can-isotp (in Linux since 5.10)",
                 name);
        break;
    case HAL_LINK_NOT_FOUND:
    case HAL_LINK_GONE:
        snprintf(
            text, capacity,
            "%s: no such interface; a virtual one: modprobe vcan; ip link add %s type vcan; ip link set %s "
            "up; an adapter's name: ip -br link show type can",
            name, name, name);
        break;
    case HAL_LINK_NOT_CAN:
        snprintf(text, capacity, "%s: not a CAN interface; those are listed by: ip -br link show type can",
                 name);
        break;
    case HAL_LINK_DOWN:
        snprintf(
            text, capacity,
            "%s: the interface is down: ip link set %s up (an adapter: ip link set %s up type can bitrate "
            "500000)",
            name, name, name);
        break;
    case HAL_LINK_NO_FD:
        snprintf(
            text, capacity,
            "%s: not set up for CAN FD; leave out fd, or: ip link set %s mtu 72 (an adapter: ip link set "
            "%s type can bitrate 500000 dbitrate 2000000 fd on)",
            name, name, name);
        break;
    default:
        snprintf(text, capacity, "%s: %s", name, hal_link_error_text(error));
        break;
    }
}
