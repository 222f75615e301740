// SPDX-License-Identifier: MIT
// Where the control socket listens, as text; and its token, as a file.
#ifndef ARGUSD_CONTROL_SPEC_H
#define ARGUSD_CONTROL_SPEC_H

#include <netinet/in.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/un.h>

#define CONTROL_TOKEN_MIN 16
#define CONTROL_TOKEN_MAX 128

typedef struct {
    int family; // AF_UNIX, AF_INET, AF_INET6; 0: none
    bool loopback;
    socklen_t length;
    union {
        struct sockaddr any;
        struct sockaddr_un un;
        struct sockaddr_in in;
        struct sockaddr_in6 in6;
    } address;
} control_spec_t;

// Zeros behind its end, so that comparing always takes the whole.
typedef struct {
    bool on;
    char text[CONTROL_TOKEN_MAX + 1];
} control_token_t;

// Reads unix:PATH, tcp:ADDRESS:PORT or tcp:[ADDRESS]:PORT; ADDRESS is a number or `localhost`. False:
// `message` says on one line what is wrong and what to write instead.
bool control_spec_parse(control_spec_t *spec, const char *text, char *message, size_t capacity);

// Reads the first line of a file that nobody else may read. False: `message` says why not.
bool control_token_load(control_token_t *self, const char *path, char *message, size_t capacity);

// Takes as long for a wrong token as for the right one.
bool control_token_is(const control_token_t *self, const char *said);

#endif
