/*
 * The GVE134 unit: all stages put together for four axes. A backend and a main loop are all it needs.
 *
 * Main calls gve134_init, gve134_start and then gve134_poll for ever. Requests come and answers go by the line alone.
 * The backend calls the interrupt entries that gve134_start hands to it. About 42 kB.
 */
#ifndef GVE134_H
#define GVE134_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_run.h"
#include "../io/io.h"
#include "line/gve_line.h"
#include "memory/gve_memory.h"
#include "outputs/gve_outputs.h"
#include "queue/gve_queue.h"

/* Name, version and date of the software, as ? tells them. */
#define GVE134_VERSION "IP134/200 v1 22.11.2026"

enum {
    GVE134_INTERPOLATOR = 0, /* addresses on the line */
    GVE134_SPINDLE = 7,
    GVE134_PACKET_COMMANDS_MAX = 128,
};

/* A vector of a packet, and the B that holds for it. */
struct gve134_staged {
    int32_t steps[PATH_AXES];
    uint32_t brake;
};

/* What has come of a packet: nothing of it counts before its end. */
struct gve134_packet {
    struct gve134_staged vectors[GVE134_PACKET_COMMANDS_MAX];
    uint32_t count;    /* of the vectors, those without pulses, too */
    uint32_t commands; /* all, also those that are wrong */
    uint32_t brake;    /* B after what has come */
    uint8_t code;      /* enum gve_code, of what was wrong first */
    bool open;
};

/* What the answer to the last request waits for. */
enum gve134_waiting {
    GVE134_WAITS_NOT,
    GVE134_WAITS_FOR_HALT,
    GVE134_WAITS_FOR_HOME,
    GVE134_WAITS_FOR_RESET, /* the answer to J is out, and no pulse is to come any more */
};

struct gve134 {
    struct io io;
    struct gve_line line;
    struct gve_memory memory;
    struct gve_queue queue;
    struct gve_outputs outputs;
    struct gve134_packet packet;
    struct hal_client client;
    uint32_t late_before; /* late pulses at the last reset */
    uint8_t waiting;      /* enum gve134_waiting */
    bool faulted;         /* restarted by a fault, or content of the EEPROM was damaged: no motion until D or J */
};

/* Start values; nothing moves. */
void gve134_init(struct gve134 *unit);

/* Starts the interrupts. */
void gve134_start(struct gve134 *unit);

/* One pass of the main loop: at most one request of the line. Returns the tick at which to call again at the latest:
 * now or before if there is more to do at once, TICK_NEVER if only an interrupt or the line brings more. */
uint64_t gve134_poll(struct gve134 *unit);

/* Whether nothing happens until the line brings more: the axes stand, or wait for G, and all has been answered. */
bool gve134_is_idle(const struct gve134 *unit);

#endif
