/*
 * Bytes of the line of a GVE134 unit: commands out, and out of what comes back the answer to each.
 *
 * A line with a right checksum that cannot be the answer, by what its values look like, is skipped: it belongs to what
 * was given up. So is the rest of a line that had begun to come before a command went out. A line that is damaged ends
 * the wait: it was the answer, as only one is under way. 39 kB.
 */
#ifndef GVE_WIRE_H
#define GVE_WIRE_H

#include <stdbool.h>
#include <stdint.h>

#include "gve_reply.h"

enum {
    GVE_WIRE_TEXT_BYTES = 6400, /* of commands: a packet of the longest vectors that fills the queue, and more */
    GVE_WIRE_OUT_BYTES = 6 * GVE_WIRE_TEXT_BYTES + 64, /* whatever they are, with what the line adds to each */
};

#define GVE_WIRE_NS_PER_MS UINT64_C(1000000)

/* What is listened for. */
enum gve_listening {
    GVE_LISTENS_NOT,
    GVE_LISTENS_ANSWER,
    GVE_LISTENS_BARE_INDEX, /* an answer to @ as only a unit without checksums has it */
    GVE_LISTENS_HALTED,     /* the answer to H, with a checksum or without */
};

/* What has come since a command went out, and was no answer to it. */
struct gve_heard {
    uint32_t damaged;
    uint32_t echoes;                          /* of what was sent */
    bool bare;                                /* an answer of a unit without checksums to a command with one */
    char other[GVE_REPLY_LINE_BYTES_MAX + 1]; /* the values of an answer to something else; a zero after them */
};

struct gve_wire {
    uint64_t byte_ns;
    uint64_t until_ns; /* so long is listened */
    uint64_t last_ns;  /* so long at the most, while something still comes */
    uint64_t cut_ns;   /* a line had begun to come when a command went out: until then its rest can come */
    struct gve_reply reply;
    struct gve_heard heard;
    struct gve_reply_form form; /* of the answer that is listened for */
    struct text sent;           /* in `out` */
    uint32_t out_length;        /* bytes of `out` that are to be written now */
    uint8_t listening;          /* enum gve_listening */
    bool sums;                  /* answers have checksums */
    bool found;                 /* what was listened for has come: `reply` has it */
    bool over;                  /* it will not come any more */
    uint32_t length;            /* of `line` */
    uint8_t line[GVE_REPLY_LINE_BYTES_MAX + 1];
    uint8_t out[GVE_WIRE_OUT_BYTES];
};

/* Nothing is listened for. */
void gve_wire_init(struct gve_wire *wire, uint32_t baud);

/* Begins to send: what has come before that is no answer to it. Then puts a command, see gve_reply_put_command. */
void gve_wire_begin(struct gve_wire *wire, uint64_t now_ns);
void gve_wire_put(struct gve_wire *wire, const uint8_t *text, uint32_t length, bool sums);

/* Sends a command beside what is listened for already. */
void gve_wire_put_beside(struct gve_wire *wire, const char *text);

/* Listens from when all has gone out. `form` is that of GVE_LISTENS_ANSWER. */
void gve_wire_listen(struct gve_wire *wire, enum gve_listening listening, struct gve_reply_form form, uint64_t wait_ns,
                     uint64_t now_ns);

/* Takes what has come. */
void gve_wire_take(struct gve_wire *wire, const uint8_t *bytes, uint32_t length, uint64_t now_ns);

/* Whether listening has ended. */
bool gve_wire_has_ended(struct gve_wire *wire, uint64_t now_ns);

#endif
