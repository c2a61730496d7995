/*
 * The master of the line of a GVE134 unit: one request at a time in, its answer out, by the rules of
 * firmware/gve134/docs/line.md.
 *
 *   Unknown   Nothing is known of the unit: at the start, and after every request that had no answer. The next one
 *             connects first: checksums are switched on (%+, asked for in a way that a unit with and one without them
 *             answers), ? tells that it is a GVE134, @ how many commands it has counted. Then all is ready.
 *   Ready     A command goes out.
 *   Waiting   An answer that can be one to this command, with a right checksum: it is answered. Code 2, a damaged
 *             answer, or none in time: doubt. What cannot be an answer to it is skipped: it belongs to a command that
 *             was given up.
 *   Doubt     > is asked for the last answer, then @ until enough answers in succession agree: those before could be
 *             late ones to the command itself. The unit has counted
 *               none of the command: it was not executed; it is sent again;
 *               all of it: > has told how it ended, it is answered;
 *               a part of a packet: a packet is taken whole or not at all, so it was not; it is sent again; but if
 *               the last answer has no number, *S was lost and the rest was executed one by one: out of step;
 *               anything else: out of step.
 *             An answer without a checksum may be damage; @ without a checksum proves that the unit has none any
 *             more, here and when connecting. Index, F and positions then tell whether it has restarted, or another
 *             program has switched them off; where they do not, that is told.
 *
 * > comes first, as a unit that gets a damaged @ answers code 2, which > repeats from then on; where that has happened
 * the end is unknown. So no command is executed twice, and none is sent again to a unit that has restarted.
 *
 * The unit throws away what comes after damage until 100 ms pass in silence, and takes a packet that was cut off for
 * over after 1 s: every wait here is longer than the first, and those after the first attempt are longer than the
 * second. H has a way of its own: it is repeated, which does no harm, with and without a checksum.
 *
 * To a unit that was silent for 2 s no command is sent again: a cable that is put in again moves nothing. Such a
 * request ends as one without an answer, even where it turns out that its command was executed: whoever has asked would
 * go on. W and J are silent for longer, and end as they did.
 *
 * It does not wait: its owner hands in what has come, looks in time, then writes what stands in `wire.out`. All that
 * has come is to be handed in before each look, as what has come before a command goes out is no answer to it. Time is
 * the owner's, in ns from any moment, and does not go back. 46 kB.
 */
#ifndef GVE_MASTER_H
#define GVE_MASTER_H

#include <stdbool.h>
#include <stdint.h>

#include "gve_wire.h"

/* What is asked for. The commands stand in `text`. */
enum gve_master_kind {
    GVE_MASTER_ASK,         /* a command is executed once */
    GVE_MASTER_PACKET,      /* commands C and B are taken together, or refused, once */
    GVE_MASTER_PACKET_ONCE, /* the same, but it is not sent again if it came damaged */
    GVE_MASTER_LONG,        /* a command is executed once that is answered when the axes stand */
    GVE_MASTER_RESET,       /* J is executed, and the unit that then starts anew is connected to */
    GVE_MASTER_CONNECT,     /* only connects, known or not */
    GVE_MASTER_HALT,        /* H is sent until it is answered, in whatever state the line is; then all is connected */
    GVE_MASTER_OWN,         /* only asks whether all that the unit has counted was sent from here */
};

/* How a request has ended. */
enum gve_master_end {
    GVE_MASTER_WAITS,             /* not yet */
    GVE_MASTER_ANSWERED,          /* ASK, PACKET, LONG and RESET have `reply` */
    GVE_MASTER_NOT_TAKEN,         /* PACKET_ONCE: nothing of it */
    GVE_MASTER_SILENT,            /* nothing came back */
    GVE_MASTER_ECHOED,            /* nothing but what was sent */
    GVE_MASTER_GARBLED,           /* something, and no answer of a unit */
    GVE_MASTER_OTHER_DEVICE,      /* an answer in the form of this line, but not of this unit: `heard.other` */
    GVE_MASTER_RESTARTED,         /* the unit has started anew, and has not executed it */
    GVE_MASTER_RESTARTED_PERHAPS, /* the same, but it may have executed it before that */
    GVE_MASTER_OUT_OF_STEP,       /* the unit has counted other commands than were sent, or has started anew */
    GVE_MASTER_END_UNKNOWN,       /* it was executed or refused, and which cannot be told any more */
    GVE_MASTER_NOT_CONFIRMED,     /* LONG, HALT: the unit has not told that its axes stand */
    GVE_MASTER_SUMS_OFF,          /* another program has switched checksums off; it may have been executed */
};

/* What becomes of the checksums of the unit. */
enum gve_master_sums {
    GVE_MASTER_SUMS_NONE, /* they are switched off */
    GVE_MASTER_SUMS_ON,
    GVE_MASTER_SUMS_KEPT, /* they stay as they are */
};

struct gve_master_order {
    uint8_t kind;     /* enum gve_master_kind */
    uint32_t length;  /* of `text`: a command as files have it; or those of a packet, with LF between them */
    uint64_t wait_ms; /* LONG, HALT: for the axes to stand */
};

struct gve_master {
    struct gve_master_order order;
    struct gve_wire wire;
    struct gve_reply reply;     /* of the request */
    struct gve_reply last;      /* that > has told */
    struct gve_heard heard;     /* in the attempts to connect; with an end without an answer, what has led to that */
    uint64_t begin_ns;          /* of the halt */
    uint64_t heard_ns;          /* when an answer came last in the request; at first its begin */
    uint64_t end_ns;            /* LONG: so long the axes are waited for */
    uint32_t repairs;           /* answers that got lost */
    uint32_t counts;            /* of the request: so many commands the unit counts of it */
    struct gve_reply_form form; /* of the answer to the request */
    uint8_t stage;
    uint8_t end;        /* enum gve_master_end */
    uint8_t index;      /* of commands, as the unit counts them */
    uint8_t index_told; /* by the last answer to @ */
    uint8_t agree;      /* so many have told that in succession */
    uint8_t needed;     /* so many are to */
    uint8_t attempt;    /* of the request, from 0 */
    uint8_t connecting; /* of connecting, from 0 */
    uint8_t asked;      /* so often this was asked in this stage */
    uint8_t wanted;     /* enum gve_master_sums */
    bool sums;          /* the unit has checksums, or is to */
    bool ready;
    uint8_t others;     /* found when it was connected to again: SUMS_OFF, or OUT_OF_STEP: not known; 0: neither */
    uint8_t bare_stage; /* in which the unit was found to have no checksums */
    bool restarted;     /* the unit was found to have started anew when it was connected to again */
    bool long_halt;     /* the answer to H takes longer than a stop does as a rule */
    bool late;          /* the unit was silent for so long that nobody expects anything of the command any more */
    bool bare;          /* the request was refused in a way in which only a unit does that has restarted */
    bool has_last;
    bool is_index_known;
    bool is_elsewhere;                          /* not all positions were 0 when they were told last */
    bool is_reset;                              /* J has gone out */
    char version[GVE_REPLY_LINE_BYTES_MAX + 1]; /* the answer to ?; empty: there was none; a zero after it */
    uint8_t text[GVE_WIRE_TEXT_BYTES];          /* of the request, put there by the owner */
};

/* A line of which nothing is known. */
void gve_master_init(struct gve_master *master, uint32_t baud, enum gve_master_sums sums);

/* Begins a request; what was under way before is given up. */
void gve_master_begin(struct gve_master *master, const struct gve_master_order *order, uint64_t now_ns);

/* Takes what has come. */
void gve_master_take(struct gve_master *master, const uint8_t *bytes, uint32_t length, uint64_t now_ns);

/* How the request stands. There may be something to write then; the next look is due at `wire.until_ns`. */
enum gve_master_end gve_master_poll(struct gve_master *master, uint64_t now_ns);

/* What is under way is given up, and nothing is known of the unit. */
void gve_master_forget(struct gve_master *master);

#endif
