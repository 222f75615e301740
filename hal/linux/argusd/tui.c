// SPDX-License-Identifier: MIT
// Both sides of the screen: argusd's end of the socket, and the process that draws.
#include "tui.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "tui_term.h"

#if defined(ARGUS_TUI)
#include <curses.h>
#endif

#define STOP_WAIT_MS 500
#define STOP_STEP_MS 10
#define INHERITED_MAX 256 // argusd itself opens about ten
#define SILENT_MS 1500    // a picture comes each 200 ms
#define LOOK_MS 250

// What goes to the screen's process. One packet each: the socket keeps them apart.
typedef enum { MESSAGE_VIEW, MESSAGE_LINE } message_kind_t;

typedef struct {
    message_kind_t kind;
    tone_t tone;
    uint16_t key;
    union {
        view_t view;
        char line[SCREEN_LOG_WIDTH];
    } as;
} message_t;

bool tui_is_built(void) {
#if defined(ARGUS_TUI)
    return true;
#else
    return false;
#endif
}

static void send_message(const tui_t *self, const message_t *message) {
    if (self->on) {
        (void)!send(self->fd, message, sizeof *message, MSG_DONTWAIT | MSG_NOSIGNAL);
    }
}

void tui_show(const tui_t *self, const view_t *view) {
    message_t message = {.kind = MESSAGE_VIEW};
    message.as.view = *view;
    // These point into this process.
    message.as.view.status.robot_name = NULL;
    message.as.view.status.robot_class = NULL;
    message.as.view.status.robot_subclass = NULL;
    message.as.view.status.robot_body = NULL;
    message.as.view.status.robot_version = NULL;
    message.as.view.status.robot_serial = NULL;
    send_message(self, &message);
}

void tui_log(const tui_t *self, const char *line, tone_t tone, uint16_t key) {
    message_t message = {.kind = MESSAGE_LINE, .tone = tone, .key = key};
    snprintf(message.as.line, sizeof message.as.line, "%s", line);
    send_message(self, &message);
}

tui_key_t tui_key(tui_t *self) {
    uint8_t key = TUI_NONE;
    if (!self->on) {
        return TUI_NONE;
    }
    const ssize_t got = recv(self->fd, &key, 1, MSG_DONTWAIT);
    if (got == 1) {
        return key < TUI_GONE ? (tui_key_t)key : TUI_NONE;
    }
    return got == 0 || (errno != EAGAIN && errno != EINTR) ? TUI_GONE : TUI_NONE;
}

#if defined(ARGUS_TUI)

typedef struct {
    int fd;
    bool has_view;
    bool changed;
    bool keys; // the list of keys is shown
    int64_t view_ms;
    view_t view;
    screen_log_t log;
    canvas_t canvas;
} screen_t;

static volatile sig_atomic_t resized_;

static void on_resize(int number) {
    (void)number;
    resized_ = 1;
}

// False where there are none.
static bool set_colours(void) {
    const char *const none = getenv("NO_COLOR");
    if ((none != NULL && none[0] != '\0') || !has_colors()) {
        return false;
    }
    start_color();
    use_default_colors();
    init_pair(TONE_GOOD, COLOR_GREEN, -1);
    init_pair(TONE_WARN, COLOR_YELLOW, -1);
    init_pair(TONE_BAD, COLOR_RED, -1);
    init_pair(TONE_OPERATOR, COLOR_CYAN, -1);
    return true;
}

static chtype attributes(uint8_t tone) {
    switch (tone) {
    case TONE_TITLE:
        return A_REVERSE;
    case TONE_DIM:
        return A_DIM;
    case TONE_GOOD:
    case TONE_WARN:
    case TONE_OPERATOR:
        return COLOR_PAIR(tone);
    case TONE_BAD:
        return COLOR_PAIR(tone) | A_BOLD;
    default:
        return A_NORMAL;
    }
}

static void paint(screen_t *screen) {
    int rows = 0;
    int columns = 0;
    getmaxyx(stdscr, rows, columns);
    canvas_clear(&screen->canvas, rows, columns);
    screen_draw(&screen->canvas, &screen->view, &screen->log);
    if (screen->keys) {
        screen_draw_keys(&screen->canvas);
    }
    for (int row = 0; row < screen->canvas.rows; row++) {
        for (int column = 0; column < screen->canvas.columns; column++) {
            const cell_t cell = screen->canvas.cell[row][column];
            mvaddch(row, column, (chtype)(unsigned char)cell.character | attributes(cell.tone));
        }
    }
    refresh();
    screen->changed = false;
}

static int64_t steady_ms(void) {
    struct timespec now = {0};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

// A process that hangs sends no picture: the last one is of earlier then.
static void watch_silence(screen_t *screen) {
    if (screen->view_ms > 0 && !screen->view.silent && steady_ms() - screen->view_ms > SILENT_MS) {
        screen->view.silent = true;
        screen->changed = true;
    }
}

// False when argusd has ended.
static bool take_messages(screen_t *screen) {
    message_t message;
    for (;;) {
        const ssize_t got = recv(screen->fd, &message, sizeof message, MSG_DONTWAIT);
        if (got == 0) {
            return false;
        }
        if (got != (ssize_t)sizeof message) {
            return got > 0 || errno == EAGAIN || errno == EINTR;
        }
        if (message.kind == MESSAGE_VIEW) {
            screen->view = message.as.view;
            screen->view_ms = steady_ms();
        } else {
            screen_log_add(&screen->log, message.as.line, (tone_t)message.tone, message.key);
        }
        screen->changed = true;
    }
}

// What curses reports among the keys though nobody pressed one is TUI_KEY_NONE.
static int key_code(int key) {
    switch (key) {
    case KEY_RESIZE:
    case KEY_MOUSE:
#if defined(KEY_EVENT)
    case KEY_EVENT:
#endif
        return TUI_KEY_NONE;
    case KEY_UP:
        return TUI_KEY_UP;
    case KEY_DOWN:
        return TUI_KEY_DOWN;
    case KEY_LEFT:
        return TUI_KEY_LEFT;
    case KEY_RIGHT:
        return TUI_KEY_RIGHT;
    default:
        return key;
    }
}

static void take_keys(screen_t *screen) {
    for (int key = getch(); key != ERR; key = getch()) {
        const uint8_t meaning = (uint8_t)tui_meaning(key_code(key));
        if (meaning == TUI_HELP) {
            screen->keys = !screen->keys;
            screen->changed = true;
        } else if (meaning != TUI_NONE) {
            (void)!send(screen->fd, &meaning, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
        }
    }
}

static void take_size(screen_t *screen) {
    struct winsize size = {0};
    resized_ = 0;
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 && size.ws_col > 0) {
        resizeterm(size.ws_row, size.ws_col);
        clear();
        screen->changed = true;
    }
}

static void watch_signals(void) {
    struct sigaction action = {.sa_handler = SIG_IGN};
    sigemptyset(&action.sa_mask);
    // argusd decides when to end; this process follows when the socket closes.
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGHUP, &action, NULL);
    sigaction(SIGTSTP, &action, NULL);
    action.sa_handler = on_resize;
    sigaction(SIGWINCH, &action, NULL);
}

static void run_screen(int fd) {
    static screen_t screen;
    bool alive = true;
    screen.fd = fd;
    screen.changed = true;
    if (initscr() == NULL) {
        return;
    }
    raw();
    noecho();
    nonl();
    keypad(stdscr, TRUE);
    nodelay(stdscr, TRUE);
    set_escdelay(25);
    curs_set(0);
    screen.canvas.colourless = !set_colours();
    watch_signals();
    while (alive) {
        struct pollfd wait[2] = {{.fd = fd, .events = POLLIN}, {.fd = STDIN_FILENO, .events = POLLIN}};
        if (screen.changed) {
            paint(&screen);
        }
        poll(wait, 2, LOOK_MS);
        if (resized_) {
            take_size(&screen);
        }
        take_keys(&screen);
        alive = take_messages(&screen) && (wait[1].revents & (POLLHUP | POLLERR | POLLNVAL)) == 0;
        watch_silence(&screen);
    }
    endwin();
}

// A copy of the robot's link in this process would keep it locked after argusd's death.
static void drop_inherited(int keep) {
    for (int fd = STDERR_FILENO + 1; fd < INHERITED_MAX; fd++) {
        if (fd != keep) {
            close(fd);
        }
    }
}

bool tui_start(tui_t *self) {
    int pair[2];
    memset(self, 0, sizeof *self);
    if (tcgetattr(STDIN_FILENO, &self->saved) != 0 || !isatty(STDOUT_FILENO) || !tui_term_can_draw()) {
        return false;
    }
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair) != 0) {
        return false;
    }
    fflush(NULL);
    self->child = fork();
    if (self->child == 0) {
        drop_inherited(pair[1]);
        run_screen(pair[1]);
        _exit(0);
    }
    close(pair[1]);
    self->fd = pair[0];
    self->on = self->child > 0;
    if (!self->on) {
        close(pair[0]);
    }
    return self->on;
}

#else

bool tui_start(tui_t *self) {
    memset(self, 0, sizeof *self);
    return false;
}

#endif

static bool has_ended(pid_t child, bool *orderly) {
    int status = 0;
    if (waitpid(child, &status, WNOHANG) == 0) {
        return false;
    }
    *orderly = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return true;
}

// The screen's process could not do it: undo what it did to the terminal.
static void restore(const tui_t *self) {
    static const char leave[] = "\033[?1l\033>\033[?1049l\033[?25h\033[0m\r\n";
    struct pollfd wait = {.fd = STDOUT_FILENO, .events = POLLOUT};
    tcsetattr(STDIN_FILENO, TCSANOW, &self->saved);
    if (poll(&wait, 1, 0) == 1 && (wait.revents & POLLOUT) != 0) {
        (void)!write(STDOUT_FILENO, leave, sizeof leave - 1);
    }
}

void tui_stop(tui_t *self) {
    const struct timespec step = {.tv_nsec = STOP_STEP_MS * 1000000L};
    bool orderly = false;
    bool ended = false;
    if (!self->on) {
        return;
    }
    self->on = false;
    close(self->fd);
    for (int waited = 0; waited < STOP_WAIT_MS && !ended; waited += STOP_STEP_MS) {
        ended = has_ended(self->child, &orderly);
        if (!ended) {
            nanosleep(&step, NULL);
        }
    }
    if (!ended) {
        kill(self->child, SIGKILL);
        waitpid(self->child, NULL, 0);
    }
    if (!orderly) {
        restore(self);
    }
}
