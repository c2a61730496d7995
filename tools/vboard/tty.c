#define _GNU_SOURCE
#include "tty.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "complain.h"

enum {
    NAME_BYTES_MAX = 128,
    CHUNK_BYTES = 256
};

#define NS_PER_SECOND UINT64_C(1000000000)
#define PERIOD_PS VTIME_PS_PER_MS

uint64_t tty_real_ns(void)
{
    struct timespec now = {.tv_sec = 0};
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * NS_PER_SECOND + (uint64_t)now.tv_nsec;
}

static void announce(const char *where)
{
    (void)fprintf(stderr, "listening on %s\n", where);
    (void)fflush(stderr);
}

static void start(struct tty *tty)
{
    tty->open = true;
    tty->real_start_ns = tty_real_ns();
    clock_set_ps(tty->clock, EVENT_THROTTLE, PERIOD_PS);
}

bool tty_open_pty(struct tty *tty, const char *link)
{
    char name[NAME_BYTES_MAX];
    struct termios settings;
    start(tty);
    tty->stream = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (tty->stream < 0 || grantpt(tty->stream) != 0 || unlockpt(tty->stream) != 0 ||
        ptsname_r(tty->stream, name, sizeof name) != 0) {
        complain("--pty: no pseudo-terminal (%s); use --tcp instead", strerror(errno));
        return false;
    }
    tty->peer = open(name, O_RDWR | O_NOCTTY);
    if (tty->peer >= 0 && tcgetattr(tty->peer, &settings) == 0) {
        cfmakeraw(&settings);
        (void)tcsetattr(tty->peer, TCSANOW, &settings);
    }
    (void)unlink(link);
    if (symlink(name, link) != 0) {
        complain("--pty %s: cannot be made (%s); name a path that can be written", link, strerror(errno));
        return false;
    }
    tty->link = link;
    announce(link);
    return true;
}

bool tty_open_tcp(struct tty *tty, unsigned port)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    socklen_t length = sizeof address;
    int yes = 1;
    char where[NAME_BYTES_MAX];
    start(tty);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    tty->listener = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    (void)setsockopt(tty->listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (tty->listener < 0 || bind(tty->listener, (struct sockaddr *)&address, sizeof address) != 0 ||
        listen(tty->listener, 1) != 0 || getsockname(tty->listener, (struct sockaddr *)&address, &length) != 0) {
        complain("--tcp %u: cannot listen (%s); choose another port, 0 takes a free one", port, strerror(errno));
        return false;
    }
    (void)snprintf(where, sizeof where, "socket://127.0.0.1:%u", (unsigned)ntohs(address.sin_port));
    announce(where);
    return true;
}

void tty_close(struct tty *tty)
{
    const int files[] = {tty->listener, tty->stream, tty->peer};
    for (unsigned i = 0; tty->open && i < sizeof files / sizeof *files; i++) {
        if (files[i] >= 0) {
            (void)close(files[i]);
        }
    }
    if (tty->link != NULL) {
        (void)unlink(tty->link);
    }
    tty->open = false;
}

void tty_send(void *model, uint8_t value)
{
    struct tty *tty = model;
    /* With nobody there, or too slow, the byte is lost as on a real line. */
    if (tty->stream >= 0 && write(tty->stream, &value, 1) < 0 && errno == EPIPE) {
        (void)close(tty->stream);
        tty->stream = -1;
    }
}

static void take_in(struct tty *tty)
{
    uint8_t bytes[CHUNK_BYTES];
    if (tty->stream < 0 && tty->listener >= 0) {
        tty->stream = accept4(tty->listener, NULL, NULL, SOCK_NONBLOCK);
    }
    if (tty->stream < 0) {
        return;
    }
    ssize_t length = read(tty->stream, bytes, sizeof bytes);
    for (ssize_t i = 0; i < length; i++) {
        rs485_say(tty->line, bytes[i]);
    }
    if (length == 0 && tty->listener >= 0) {
        (void)close(tty->stream);
        tty->stream = -1;
    }
}

static void on_tty_event(void *model, uint64_t cycle)
{
    struct tty *tty = model;
    uint64_t virtual_ps = clock_ps_of_cycle(tty->clock, cycle);
    uint64_t due_ns = tty->real_start_ns + virtual_ps / VTIME_PS_PER_NS;
    uint64_t now_ns = tty_real_ns();
    if (now_ns < due_ns) {
        struct timespec rest = {.tv_sec = (time_t)((due_ns - now_ns) / NS_PER_SECOND),
                                .tv_nsec = (long)((due_ns - now_ns) % NS_PER_SECOND)};
        (void)nanosleep(&rest, NULL);
    }
    take_in(tty);
    clock_set_ps(tty->clock, EVENT_THROTTLE, virtual_ps + PERIOD_PS);
}

void tty_init(struct tty *tty, struct clock *clock, struct rs485 *line)
{
    *tty = (struct tty){.clock = clock, .line = line, .listener = -1, .stream = -1, .peer = -1};
    clock_attach(clock, EVENT_THROTTLE, on_tty_event, tty);
}
