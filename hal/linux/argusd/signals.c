// SPDX-License-Identifier: MIT
// The self-pipe.
#include "signals.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stddef.h>
#include <unistd.h>

static int ends_[2] = {-1, -1};
static volatile sig_atomic_t count_;

static void on_signal(int number) {
    const int saved = errno;
    const char byte = (char)number;
    if (count_ < 1000) {
        count_ = count_ + 1;
    }
    // Full means that the loop has enough to wake up for.
    (void)!write(ends_[1], &byte, 1);
    errno = saved;
}

bool signals_open(void) {
    static const int ending[] = {SIGINT, SIGTERM, SIGHUP};
    if (pipe(ends_) != 0) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        fcntl(ends_[i], F_SETFL, O_NONBLOCK);
        fcntl(ends_[i], F_SETFD, FD_CLOEXEC);
    }
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof ending / sizeof ending[0]; i++) {
        if (sigaction(ending[i], &action, NULL) != 0) {
            return false;
        }
    }
    action.sa_handler = SIG_IGN;
    return sigaction(SIGPIPE, &action, NULL) == 0;
}

int signals_fd(void) {
    return ends_[0];
}

int signals_ends(void) {
    return count_;
}
