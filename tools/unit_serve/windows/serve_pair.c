#include "serve_pair.h"

#include <winsock2.h>

#include <ws2tcpip.h>

#include "serve_socket.h"

#define HERE "127.0.0.1"

/* Another program might connect first: then the addresses differ. */
static bool is_other_end(SOCKET one, SOCKET other)
{
    struct sockaddr_in mine;
    struct sockaddr_in peer;
    int length = sizeof mine;
    int peer_length = sizeof peer;
    return getsockname(one, (struct sockaddr *)&mine, &length) == 0 &&
           getpeername(other, (struct sockaddr *)&peer, &peer_length) == 0 && mine.sin_port == peer.sin_port &&
           mine.sin_addr.s_addr == peer.sin_addr.s_addr;
}

bool serve_pair_make(struct serve_pair *pair)
{
    uint16_t port = 0;
    u_long off = 0;
    SOCKET listener = (SOCKET)socket_listen(HERE, &port, 1);
    SOCKET writes = socket(AF_INET, SOCK_STREAM, 0);
    struct sockaddr_in place = {.sin_family = AF_INET, .sin_port = htons(port)};
    (void)inet_pton(AF_INET, HERE, &place.sin_addr);
    (void)ioctlsocket(listener, (long)FIONBIO, &off);
    if (connect(writes, (const struct sockaddr *)&place, sizeof place) != 0) {
        (void)closesocket(listener);
        (void)closesocket(writes);
        return false;
    }
    SOCKET reads = accept(listener, NULL, NULL);
    (void)closesocket(listener);
    *pair = (struct serve_pair){.reads = (int)reads, .writes = (int)writes};
    if (reads != INVALID_SOCKET && is_other_end(writes, reads)) {
        return true;
    }
    (void)closesocket(reads);
    (void)closesocket(writes);
    return false;
}
