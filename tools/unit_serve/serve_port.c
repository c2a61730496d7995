#include "serve_port.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "serve_socket.h"

void serve_port_init(struct serve_port *port)
{
    *port = (struct serve_port){.listener = -1};
    serve_pty_init(&port->pty);
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        port->clients[i] = -1;
    }
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

enum exit_status serve_port_listen(struct serve_port *port, const char *option, const char *address, uint16_t number)
{
    uint16_t found = number;
    port->listener = socket_listen(address, &found, SERVE_CLIENTS_MAX);
    if (port->listener < 0 && errno == EINVAL) {
        complain("--address %s: not an address; write four numbers, as 127.0.0.1", address);
        return EXIT_USAGE;
    }
    if (port->listener < 0) {
        complain("%s %u: cannot listen there (%s); %s", option, (unsigned)number, strerror(errno), advice_for(errno));
        return EXIT_CONNECTION;
    }
    (void)snprintf(port->name, sizeof port->name, "socket://%s:%u", address, (unsigned)found);
    return EXIT_DONE;
}

enum exit_status serve_port_open_pty(struct serve_port *port, const char *link)
{
    enum exit_status status = serve_pty_open(&port->pty, link, &port->clients[0]);
    (void)snprintf(port->name, sizeof port->name, "%s", link);
    return status;
}

static void let_go(int *fd)
{
    if (*fd >= 0) {
        socket_close(*fd);
    }
    *fd = -1;
}

int serve_port_accept(struct serve_port *port)
{
    int fd = socket_accept(port->listener);
    if (fd < 0) {
        return -1;
    }
    for (int i = 0; i < SERVE_CLIENTS_MAX; i++) {
        if (port->clients[i] < 0) {
            port->clients[i] = fd;
            return i;
        }
    }
    socket_close(fd);
    return -1;
}

static bool is_for_later(int error)
{
    return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

size_t serve_port_read(struct serve_port *port, unsigned client, void *bytes, size_t room)
{
    ptrdiff_t got = socket_read(port->clients[client], bytes, room);
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
    ptrdiff_t taken = socket_write(port->clients[client], bytes, length);
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
    serve_pty_close(&port->pty);
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        let_go(&port->clients[i]);
    }
    let_go(&port->listener);
    serve_port_init(port);
}
