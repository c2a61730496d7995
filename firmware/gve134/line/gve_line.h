/*
 * The line of a unit: bytes in, requests out in the order in which they came; answers in, bytes for the line out.
 *
 * A request is a command that came whole, right or wrong, or the news that one was damaged. Requests are kept until
 * they are asked for: the unit hears while it sends and while H or W waits for the axes. The line owns what both
 * addresses share: whether there are checksums, the index of the last command, the last answer. It tells which commands
 * came in a packet; whether that is taken is decided above. The unit after J is a line that begins anew. Main only;
 * 2.8 kB.
 */
#ifndef GVE_LINE_H
#define GVE_LINE_H

#include <stdbool.h>
#include <stdint.h>

#include "../command/gve_command.h"
#include "gve_answer.h"
#include "gve_receiver.h"

enum {
    /* Requests that are kept: 256 bytes of the shortest commands, `!0` and CR, and those for which room is spared: the
     * news of damage and the end of a packet, and beyond these H and J, which nothing else keeps out. */
    GVE_LINE_SPARED_STOPS = 2,
    GVE_LINE_SPARED = 2 + GVE_LINE_SPARED_STOPS,
    GVE_LINE_KEPT = 86 + GVE_LINE_SPARED,
};

enum gve_request_kind {
    GVE_REQUEST_COMMAND,
    GVE_REQUEST_DAMAGE,   /* to be answered with code 2; in a packet, which is over with it, `2,0` */
    GVE_REQUEST_BAD_LINE, /* a command of the packet was damaged: no answer now */
};

struct gve_request {
    struct gve_command command; /* of a COMMAND */
    uint8_t kind;               /* enum gve_request_kind */
    uint8_t fault;              /* of a COMMAND: enum gve_fault */
    bool packet;                /* it came in a packet: after *S, up to what ends it, that included */
};

struct gve_line {
    struct gve_receiver receiver;
    struct gve_answer answer;
    struct gve_request kept[GVE_LINE_KEPT];
    uint32_t first; /* of `kept`, in the order in which they came */
    uint32_t count;
    bool bad_packet; /* of the packet being received damage has been told */
    bool owes;       /* damage found no room: it is kept, once, as soon as there is some */
    bool sums;       /* answers have checksums */
    bool apart;      /* the answer to what was taken last is not kept to be sent again */
    uint8_t index;
};

/* As after a reset: no checksums, index 0, no last answer, nothing kept. The addresses are 0 to 7 and differ. */
void gve_line_init(struct gve_line *line, unsigned interpolator, unsigned spindle);

/* Takes a byte. */
void gve_line_take(struct gve_line *line, const struct hal_line_byte *byte);

/* Takes bytes that came together. */
void gve_line_take_run(struct gve_line *line, const struct hal_line_run *run);

/* Sees silence. Returns when to call again at the latest; TICK_NEVER: not before the next byte. All bytes that have
 * come must have been taken. */
uint64_t gve_line_poll(struct gve_line *line, uint64_t now_ticks);

/* Takes the oldest request. False: there is none. Not before the answer to the one before it has gone out. */
bool gve_line_next(struct gve_line *line, struct gve_request *request);

/* Whether one of the kept requests is this command, without a fault: of H and J a unit that waits wants to know. */
bool gve_line_keeps(const struct gve_line *line, enum gve_opcode opcode);

/* Whether the request that was kept last is this command, without a fault. */
bool gve_line_ends_with(const struct gve_line *line, enum gve_opcode opcode);

/* Answers the request taken last: a code, INTA as it is after the command, and values without the comma before them
 * (at most GVE_ANSWER_VALUES_MAX bytes; 0: none). */
void gve_line_answer(struct gve_line *line, enum gve_code code, bool inta, const uint8_t *values, uint32_t length);

/* The answers to @ and >. */
void gve_line_answer_index(struct gve_line *line, bool inta);
void gve_line_answer_again(struct gve_line *line, bool inta);

/* Whether there is a byte to be sent; that byte; and past it. */
bool gve_line_is_sending(const struct gve_line *line);
uint8_t gve_line_byte(const struct gve_line *line);
void gve_line_advance(struct gve_line *line);

#endif
