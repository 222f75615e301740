// SPDX-License-Identifier: MIT
// Reads --control and --control-token.
#include "control_spec.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text.h"

static bool parse_unix(control_spec_t *spec, const char *path, char *message, size_t capacity) {
    struct sockaddr_un *const un = &spec->address.un;
    if (path[0] == '\0' || strlen(path) >= sizeof un->sun_path) {
        return text_refuse(message, capacity, "unix:%s: the path is empty or longer than %d bytes", path,
                           (int)sizeof un->sun_path - 1);
    }
    un->sun_family = AF_UNIX;
    memcpy(un->sun_path, path, strlen(path) + 1);
    spec->family = AF_UNIX;
    spec->loopback = true;
    spec->length = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + strlen(path) + 1);
    return true;
}

// A name that a server of names answers for could be of any machine, so only numbers are taken.
static bool parse_host(control_spec_t *spec, const char *host, uint16_t port) {
    struct sockaddr_in *const in = &spec->address.in;
    struct sockaddr_in6 *const in6 = &spec->address.in6;
    if (inet_pton(AF_INET, strcmp(host, "localhost") == 0 ? "127.0.0.1" : host, &in->sin_addr) == 1) {
        in->sin_family = AF_INET;
        in->sin_port = htons(port);
        spec->family = AF_INET;
        spec->length = sizeof *in;
        spec->loopback = ntohl(in->sin_addr.s_addr) >> 24 == 127;
        return true;
    }
    if (inet_pton(AF_INET6, host, &in6->sin6_addr) == 1) {
        in6->sin6_family = AF_INET6;
        in6->sin6_port = htons(port);
        spec->family = AF_INET6;
        spec->length = sizeof *in6;
        spec->loopback = IN6_IS_ADDR_LOOPBACK(&in6->sin6_addr);
        return true;
    }
    return false;
}

// Takes the brackets of an address away.
static char *bare(char *host) {
    const size_t length = strlen(host);
    if (length < 3 || host[0] != '[' || host[length - 1] != ']') {
        return host;
    }
    host[length - 1] = '\0';
    return host + 1;
}

static bool parse_port(const char *text, uint16_t *port) {
    int32_t value = -1;
    const bool taken = text_number(text, &value) && value >= 0 && value <= UINT16_MAX;
    *port = (uint16_t)value;
    return taken;
}

static bool parse_tcp(control_spec_t *spec, const char *rest, char *message, size_t capacity) {
    const char *const colon = strrchr(rest, ':');
    char host[INET6_ADDRSTRLEN + 2] = "";
    uint16_t port = 0;
    if (colon == NULL || (size_t)(colon - rest) >= sizeof host || !parse_port(colon + 1, &port)) {
        return text_refuse(message, capacity, "tcp:%s: give tcp:127.0.0.1:PORT, PORT 0 to 65535", rest);
    }
    memcpy(host, rest, (size_t)(colon - rest));
    if (!parse_host(spec, bare(host), port)) {
        return text_refuse(message, capacity,
                           "tcp:%s: '%s' is no address; give 127.0.0.1, [::1] or localhost", rest, host);
    }
    return true;
}

bool control_spec_parse(control_spec_t *spec, const char *text, char *message, size_t capacity) {
    memset(spec, 0, sizeof *spec);
    if (strncmp(text, "unix:", 5) == 0) {
        return parse_unix(spec, text + 5, message, capacity);
    }
    if (strncmp(text, "tcp:", 4) == 0) {
        return parse_tcp(spec, text + 4, message, capacity);
    }
    return text_refuse(message, capacity, "%s: give unix:PATH or tcp:127.0.0.1:PORT", text);
}

// NULL: the file may hold a token.
static const char *objection(int fd) {
    struct stat about;
    if (fstat(fd, &about) != 0 || !S_ISREG(about.st_mode)) {
        return "it is no regular file";
    }
    if (about.st_uid != geteuid() && about.st_uid != 0) {
        return "it belongs to somebody else; chown it to argusd's user";
    }
    if ((about.st_mode & 077) != 0) {
        return "others may read or write it; chmod 600 it";
    }
    return NULL;
}

static bool is_token(const char *text) {
    const size_t length = strlen(text);
    for (size_t i = 0; i < length; i++) {
        if (text[i] <= ' ' || text[i] > '~') {
            return false;
        }
    }
    return length >= CONTROL_TOKEN_MIN && length <= CONTROL_TOKEN_MAX;
}

bool control_token_load(control_token_t *self, const char *path, char *message, size_t capacity) {
    char line[CONTROL_TOKEN_MAX + 4] = "";
    memset(self, 0, sizeof *self);
    const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd < 0) {
        return text_refuse(message, capacity, "--control-token %s: %s", path, strerror(errno));
    }
    const char *const wrong = objection(fd);
    const ssize_t got = wrong == NULL ? read(fd, line, sizeof line - 1) : 0;
    close(fd);
    if (wrong != NULL) {
        return text_refuse(message, capacity, "--control-token %s: %s", path, wrong);
    }
    line[got > 0 ? got : 0] = '\0';
    line[strcspn(line, "\r\n")] = '\0';
    if (!is_token(line)) {
        return text_refuse(message, capacity,
                           "--control-token %s: its first line must be %d to %d printable characters without "
                           "blanks; for example: umask 077; openssl rand -hex 24 > %s",
                           path, CONTROL_TOKEN_MIN, CONTROL_TOKEN_MAX, path);
    }
    memcpy(self->text, line, strlen(line) + 1);
    self->on = true;
    return true;
}

bool control_token_is(const control_token_t *self, const char *said) {
    char padded[sizeof self->text] = "";
    const size_t length = strlen(said);
    memcpy(padded, said, length < sizeof padded ? length : sizeof padded);
    // Not to be cut short by the compiler: each byte counts.
    volatile unsigned char differs = length < sizeof padded ? 0 : 1;
    for (size_t i = 0; i < sizeof padded; i++) {
        differs = (unsigned char)(differs | (padded[i] ^ self->text[i]));
    }
    return self->on && differs == 0;
}
