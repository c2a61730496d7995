/* Sockets, ptys and the signals that writing makes. */
#define _GNU_SOURCE

#include "serve_port.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#define PTY_FOLDER "/dev/pts/"

void serve_port_init(struct serve_port *port)
{
    *port = (struct serve_port){.listener = -1, .terminal = -1};
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        port->clients[i] = -1;
    }
}

static void never_wait(int fd)
{
    (void)fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK);
    (void)fcntl(fd, F_SETFD, FD_CLOEXEC);
}

static const char *advice_for(int error)
{
    switch (error) {
    case EADDRINUSE:
        return "end the program that has it, take another one, or 0 for any free one";
    case EACCES:
        return "take a port from 1024 on";
    case EADDRNOTAVAIL:
        return "give the address of a network card of this machine, or 127.0.0.1";
    default:
        return "take another port or address";
    }
}

static int listen_at(const struct sockaddr_in *place)
{
    int on = 1;
    int fd = socket(AF_INET, SOCK_STREAM, 0);
    if (fd < 0) {
        return -1;
    }
    (void)setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(fd, (const struct sockaddr *)place, sizeof *place) != 0 || listen(fd, SERVE_CLIENTS_MAX) != 0) {
        int error = errno;
        (void)close(fd);
        errno = error;
        return -1;
    }
    never_wait(fd);
    return fd;
}

enum exit_status serve_port_listen(struct serve_port *port, const char *option, const char *address, uint16_t number)
{
    struct sockaddr_in place = {.sin_family = AF_INET, .sin_port = htons(number)};
    if (inet_pton(AF_INET, address, &place.sin_addr) != 1) {
        complain("--address %s: not an address; write four numbers, as 127.0.0.1", address);
        return EXIT_USAGE;
    }
    port->listener = listen_at(&place);
    if (port->listener < 0) {
        complain("%s %u: cannot listen there (%s); %s", option, (unsigned)number, strerror(errno), advice_for(errno));
        return EXIT_CONNECTION;
    }
    socklen_t length = sizeof place;
    (void)getsockname(port->listener, (struct sockaddr *)&place, &length);
    (void)snprintf(port->name, sizeof port->name, "socket://%s:%u", address, (unsigned)ntohs(place.sin_port));
    return EXIT_DONE;
}

/* Both sides of a pty that passes every byte as it is. */
static bool open_sides(struct serve_port *port)
{
    struct termios settings;
    int fd = posix_openpt(O_RDWR | O_NOCTTY);
    port->clients[0] = fd;
    if (fd < 0 || grantpt(fd) != 0 || unlockpt(fd) != 0 || ptsname_r(fd, port->device, sizeof port->device) != 0) {
        return false;
    }
    never_wait(fd);
    port->terminal = open(port->device, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (port->terminal < 0 || tcgetattr(port->terminal, &settings) != 0) {
        return false;
    }
    cfmakeraw(&settings);
    return tcsetattr(port->terminal, TCSANOW, &settings) == 0;
}

/* Whether a path is a link to a pty that is no more, or to this one by chance: its number is free again. */
static bool is_stale(const char *path, const char *device)
{
    char target[SERVE_NAME_BYTES];
    ssize_t length = readlink(path, target, sizeof target - 1U);
    if (length < 0) {
        return false;
    }
    target[length] = '\0';
    return strncmp(target, PTY_FOLDER, strlen(PTY_FOLDER)) == 0 &&
           (strcmp(target, device) == 0 || access(target, F_OK) != 0);
}

static bool is_ours(const struct serve_port *port)
{
    char target[SERVE_NAME_BYTES];
    ssize_t length = readlink(port->link, target, sizeof target - 1U);
    return length > 0 && (size_t)length == strlen(port->device) && memcmp(target, port->device, (size_t)length) == 0;
}

enum exit_status serve_port_open_pty(struct serve_port *port, const char *link)
{
    if (!open_sides(port)) {
        complain("--pty %s: no pty can be made (%s); end other programs, or use --tcp", link, strerror(errno));
        return EXIT_CONNECTION;
    }
    if (is_stale(link, port->device)) {
        (void)unlink(link);
    }
    if (symlink(port->device, link) != 0) {
        const char *advice = errno == EEXIST ? "remove it if no other program uses it, or name another path"
                                             : "name a path in a folder that exists and may be written";
        complain("--pty %s: the link cannot be made (%s); %s", link, strerror(errno), advice);
        return EXIT_CONNECTION;
    }
    port->link = link;
    (void)snprintf(port->name, sizeof port->name, "%s", link);
    return EXIT_DONE;
}

static void let_go(int *fd)
{
    if (*fd >= 0) {
        (void)close(*fd);
    }
    *fd = -1;
}

int serve_port_accept(struct serve_port *port)
{
    int on = 1;
    int fd = accept(port->listener, NULL, NULL);
    if (fd < 0) {
        return -1;
    }
    never_wait(fd);
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    for (int i = 0; i < SERVE_CLIENTS_MAX; i++) {
        if (port->clients[i] < 0) {
            port->clients[i] = fd;
            return i;
        }
    }
    (void)close(fd);
    return -1;
}

static bool is_for_later(int error)
{
    return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

size_t serve_port_read(struct serve_port *port, unsigned client, void *bytes, size_t room)
{
    ssize_t got = read(port->clients[client], bytes, room);
    if (got > 0) {
        return (size_t)got;
    }
    if (got == 0 || !is_for_later(errno)) {
        let_go(&port->clients[client]);
    }
    return 0;
}

void serve_port_write(struct serve_port *port, unsigned client, const void *bytes, size_t length)
{
    if (port->clients[client] < 0) {
        return;
    }
    ssize_t taken = write(port->clients[client], bytes, length);
    port->dropped += length - (taken > 0 ? (size_t)taken : 0U);
}

void serve_port_write_all(struct serve_port *port, const void *bytes, size_t length)
{
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        serve_port_write(port, i, bytes, length);
    }
}

unsigned serve_port_clients(const struct serve_port *port)
{
    unsigned count = 0;
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        count += port->clients[i] >= 0 ? 1U : 0U;
    }
    return count;
}

void serve_port_close(struct serve_port *port)
{
    if (port->link != NULL && is_ours(port)) {
        (void)unlink(port->link);
    }
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        let_go(&port->clients[i]);
    }
    let_go(&port->listener);
    let_go(&port->terminal);
    serve_port_init(port);
}
