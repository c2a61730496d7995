/* ppoll: sleeping to less than a millisecond. */
#define _GNU_SOURCE

#include "serve_socket.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define NS_PER_SECOND UINT64_C(1000000000)
#define NS_PER_MS UINT64_C(1000000)

/* Descriptors 0 to 2 must be there, or sockets would take their numbers. */
bool socket_start(void)
{
    int fd = open("/dev/null", O_RDWR);
    while (fd >= 0 && fd <= STDERR_FILENO) {
        fd = open("/dev/null", O_RDWR);
    }
    if (fd >= 0) {
        (void)close(fd);
    }
    return true;
}

static void never_wait(int fd)
{
    (void)fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK);
    (void)fcntl(fd, F_SETFD, FD_CLOEXEC);
}

static int refuse(int fd, int error)
{
    (void)close(fd);
    errno = error;
    return -1;
}

int socket_listen(const char *address, uint16_t *port, int waiting_max)
{
    struct sockaddr_in place = {.sin_family = AF_INET, .sin_port = htons(*port)};
    socklen_t length = sizeof place;
    int on = 1;
    if (inet_pton(AF_INET, address, &place.sin_addr) != 1) {
        errno = EINVAL;
        return -1;
    }
    int fd = socket(AF_INET, SOCK_STREAM, 0);
    if (fd < 0) {
        return -1;
    }
    (void)setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(fd, (const struct sockaddr *)&place, sizeof place) != 0 || listen(fd, waiting_max) != 0) {
        return refuse(fd, errno);
    }
    never_wait(fd);
    (void)getsockname(fd, (struct sockaddr *)&place, &length);
    *port = ntohs(place.sin_port);
    return fd;
}

int socket_accept(int listener)
{
    int on = 1;
    int fd = accept(listener, NULL, NULL);
    if (fd >= 0) {
        never_wait(fd);
        (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    }
    return fd;
}

ptrdiff_t socket_read(int fd, void *bytes, size_t room)
{
    return read(fd, bytes, room);
}

ptrdiff_t socket_write(int fd, const void *bytes, size_t length)
{
    return write(fd, bytes, length);
}

void socket_close(int fd)
{
    (void)close(fd);
}

int socket_user(void)
{
    return STDIN_FILENO;
}

static int poll_for(struct pollfd *polled, unsigned count, const uint64_t *rest_ns)
{
    uint64_t ns = rest_ns != NULL ? *rest_ns : 0;
#ifdef __linux__
    const struct timespec rest = {.tv_sec = (time_t)(ns / NS_PER_SECOND), .tv_nsec = (long)(ns % NS_PER_SECOND)};
    return ppoll(polled, count, rest_ns != NULL ? &rest : NULL, NULL);
#else
    uint64_t ms = (ns + NS_PER_MS - 1U) / NS_PER_MS;
    return poll(polled, count, rest_ns == NULL ? -1 : (int)(ms < NS_PER_SECOND ? ms : NS_PER_SECOND));
#endif
}

void socket_wait(struct socket_slot *slots, unsigned count, const uint64_t *rest_ns)
{
    struct pollfd polled[SOCKET_SLOTS_MAX];
    for (unsigned i = 0; i < count; i++) {
        polled[i] = (struct pollfd){.fd = slots[i].fd, .events = POLLIN};
    }
    int found = poll_for(polled, count, rest_ns);
    for (unsigned i = 0; i < count; i++) {
        slots[i].ready = found > 0 && polled[i].revents != 0;
    }
}
