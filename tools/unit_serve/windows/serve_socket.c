/* Winsock. Standard input comes by a thread, as it cannot be waited for beside sockets. */
#include "serve_socket.h"

#include <winsock2.h>

#include <errno.h>
#include <timeapi.h>
#include <ws2tcpip.h>

#include "complain.h"
#include "serve_pair.h"

#define NS_PER_MS UINT64_C(1000000)

enum {
    REST_MS_MAX = 1000000,
    CHUNK_BYTES = 1024,
};

bool socket_start(void)
{
    WSADATA found;
    if (WSAStartup(MAKEWORD(2, 2), &found) != 0) {
        complain("Windows has no sockets for this program; restart it");
        return false;
    }
    (void)timeBeginPeriod(1);
    return true;
}

static int errno_of(int error)
{
    switch (error) {
    case WSAEWOULDBLOCK:
        return EAGAIN;
    case WSAEADDRINUSE:
        return EADDRINUSE;
    case WSAEACCES:
        return EACCES;
    case WSAEADDRNOTAVAIL:
        return EADDRNOTAVAIL;
    default:
        return EIO;
    }
}

static int fail(SOCKET socket)
{
    int error = WSAGetLastError();
    if (socket != INVALID_SOCKET) {
        (void)closesocket(socket);
    }
    errno = errno_of(error);
    return -1;
}

static void never_wait(SOCKET socket)
{
    u_long on = 1;
    (void)ioctlsocket(socket, (long)FIONBIO, &on);
}

/* Windows lets others share the port of a listener unless it is told not to. */
int socket_listen(const char *address, uint16_t *port, int waiting_max)
{
    struct sockaddr_in place = {.sin_family = AF_INET, .sin_port = htons(*port)};
    int length = sizeof place;
    BOOL on = TRUE;
    if (inet_pton(AF_INET, address, &place.sin_addr) != 1) {
        errno = EINVAL;
        return -1;
    }
    SOCKET made = socket(AF_INET, SOCK_STREAM, 0);
    if (made == INVALID_SOCKET) {
        return fail(made);
    }
    (void)setsockopt(made, SOL_SOCKET, SO_EXCLUSIVEADDRUSE, (const char *)&on, sizeof on);
    if (bind(made, (const struct sockaddr *)&place, sizeof place) != 0 || listen(made, waiting_max) != 0) {
        return fail(made);
    }
    never_wait(made);
    (void)getsockname(made, (struct sockaddr *)&place, &length);
    *port = ntohs(place.sin_port);
    return (int)made;
}

int socket_accept(int listener)
{
    BOOL on = TRUE;
    SOCKET found = accept((SOCKET)listener, NULL, NULL);
    if (found == INVALID_SOCKET) {
        return fail(found);
    }
    never_wait(found);
    (void)setsockopt(found, IPPROTO_TCP, TCP_NODELAY, (const char *)&on, sizeof on);
    return (int)found;
}

ptrdiff_t socket_read(int fd, void *bytes, size_t room)
{
    int got = recv((SOCKET)fd, bytes, (int)room, 0);
    return got >= 0 ? got : fail(INVALID_SOCKET);
}

ptrdiff_t socket_write(int fd, const void *bytes, size_t length)
{
    int taken = send((SOCKET)fd, bytes, (int)length, 0);
    return taken >= 0 ? taken : fail(INVALID_SOCKET);
}

void socket_close(int fd)
{
    (void)closesocket((SOCKET)fd);
}

static DWORD WINAPI pass_on_input(void *ends)
{
    char bytes[CHUNK_BYTES];
    SOCKET to = (SOCKET)(uintptr_t)ends;
    DWORD got = 0;
    while (ReadFile(GetStdHandle(STD_INPUT_HANDLE), bytes, sizeof bytes, &got, NULL) != 0 && got > 0 &&
           send(to, bytes, (int)got, 0) == (int)got) {
    }
    (void)closesocket(to);
    return 0;
}

int socket_user(void)
{
    struct serve_pair pair;
    if (!serve_pair_make(&pair)) {
        return -1;
    }
    never_wait((SOCKET)pair.reads);
    HANDLE thread = CreateThread(NULL, 0, pass_on_input, (void *)(uintptr_t)pair.writes, 0, NULL);
    if (thread == NULL) {
        socket_close(pair.writes);
    } else {
        (void)CloseHandle(thread);
    }
    return pair.reads;
}

static int rest_ms(const uint64_t *rest_ns)
{
    if (rest_ns == NULL) {
        return -1;
    }
    uint64_t ms = (*rest_ns + NS_PER_MS - 1U) / NS_PER_MS;
    return ms < REST_MS_MAX ? (int)ms : REST_MS_MAX;
}

/* WSAPoll takes no slots without a socket. */
void socket_wait(struct socket_slot *slots, unsigned count, const uint64_t *rest_ns)
{
    WSAPOLLFD polled[SOCKET_SLOTS_MAX];
    ULONG used = 0;
    for (unsigned i = 0; i < count; i++) {
        slots[i].ready = false;
        if (slots[i].fd >= 0) {
            polled[used++] = (WSAPOLLFD){.fd = (SOCKET)slots[i].fd, .events = POLLRDNORM};
        }
    }
    if (WSAPoll(polled, used, rest_ms(rest_ns)) <= 0) {
        return;
    }
    used = 0;
    for (unsigned i = 0; i < count; i++) {
        slots[i].ready = slots[i].fd >= 0 && polled[used++].revents != 0;
    }
}
