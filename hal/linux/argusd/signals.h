// SPDX-License-Identifier: MIT
// Signals as bytes in a pipe, so that the event loop alone acts on them.
#ifndef ARGUSD_SIGNALS_H
#define ARGUSD_SIGNALS_H

#include <stdbool.h>

// SIGINT, SIGTERM and SIGHUP go to the pipe, SIGPIPE is ignored. False when the system refuses.
bool signals_open(void);
int signals_fd(void);

// How many asked us to end, so far.
int signals_ends(void);

#endif
