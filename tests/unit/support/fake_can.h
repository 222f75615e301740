// SPDX-License-Identifier: MIT
// A kernel's CAN sockets in memory: what it lacks, refuses and delivers is set by the test.
#ifndef FAKE_CAN_H
#define FAKE_CAN_H

#include "hal/can_sys.h"

#define FAKE_CAN_STEPS 64
#define FAKE_CAN_BYTES 512

typedef struct {
    ssize_t result; // bytes, or -errno
    uint8_t bytes[FAKE_CAN_BYTES];
} fake_can_step_t;

typedef struct {
    // The interface.
    int index; // 0: there is none
    int hardware;
    unsigned flags;
    int mtu;
    // What calls say: 0, or -errno.
    int socket_says;
    int set_says;
    int bind_says;
    // What recv() gives, one after the other, then -EAGAIN.
    fake_can_step_t in[FAKE_CAN_STEPS];
    int in_count;
    int in_next;
    // What send() says, one after the other, then that it took all.
    int send_says[FAKE_CAN_STEPS];
    int send_count;
    int send_next;
    // What was asked.
    int type;
    int protocol;
    int option[8];
    uint8_t value[8][64];
    int options;
    struct sockaddr_can address;
    uint8_t sent[FAKE_CAN_STEPS][FAKE_CAN_BYTES];
    size_t sent_length[FAKE_CAN_STEPS];
    int sends; // taken
    int opened;
    int closed;
    // The raw socket beside an ISO-TP socket: frames waiting, classic and of CAN FD.
    int ear_says; // 0, or -errno
    int ear_classic;
    int ear_fd;
    int ear_opened;
    int ear_closed;
} fake_can_t;

extern fake_can_t fake_can;
extern const hal_can_sys_t fake_can_sys;

void fake_can_reset(void); // an interface that is up, a kernel that has everything
void fake_can_deliver(ssize_t result, const void *bytes, size_t count);
void fake_can_answer_send(int negative_errno);

#endif
