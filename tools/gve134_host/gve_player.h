/*
 * The player: plays the host of a unit in virtual time. Lines of a vector file go out, answers come in.
 *
 * The lines that follow each other go one by one: each waits for the answer to the one before, is sent again after
 * code 1, and a packet goes from its *S to its *E and has one answer; with code 1 it is sent again from its *S. A line
 * with a time goes at that time beside them, as soon as the line is free: not inside of another line or a packet. So
 * several lines may wait for their answers.
 *
 * Where the file says ;@probe the player does what a host does there (gve_probing.h); if nothing was touched, the file
 * ends with that.
 *
 * Commands and answers are in order, so an answer is that of the first line that waits; the unit keeps that order also
 * where H acts at once. But J leaves everything before it that has not been answered without an answer. So nothing is
 * sent after J until its answer has come and 100 ms have passed, which a unit may need to be ready. The last answer of
 * that time is J's, and lines that wait yet have none. Nothing is sent either while the switch of the checksums waits
 * for its answer; while they are on every line gets its sum, and every answer is held against its own.
 */
#ifndef GVE_PLAYER_H
#define GVE_PLAYER_H

#include <stdbool.h>
#include <stdint.h>

#include "gve_command.h"
#include "gve_probing.h"
#include "gve_script.h"
#include "gve_told.h"
#include "host_machine.h"

enum {
    GVE_PLAYER_WAITING_MAX = 64,
    GVE_PLAYER_BYTES_MAX = 1 + 1 + GVE_TEXT_BYTES_MAX + 3 + 1, /* ! address text ,sum CR */
};

/* A line that waits for its answer. */
struct gve_player_waiting {
    struct gve_script_line line;
    bool timed;
    uint64_t heard_tick; /* when the unit has all of it */
};

struct gve_player {
    struct host_machine *machine;
    uint32_t byte_ticks; /* 0: bytes take no time */
    struct gve_script script;
    struct gve_probing probing;                        /* in a phase of it `next` is a command of it */
    struct gve_script_line approach;                   /* the L that comes after a phase before it */
    struct host_line_byte bytes[GVE_PLAYER_BYTES_MAX]; /* of the line on its way to the unit */

    struct gve_script_line next; /* of those that follow each other */
    bool has_next;               /* else all have been sent */
    bool next_waits;             /* it has been sent and waits for its answer */
    uint64_t next_tick;          /* when it may be sent */
    uint32_t next_repeats;       /* how often it, or its packet, has been answered with code 1 */

    bool packet;                           /* between *S and *E */
    struct gve_script_place packet_before; /* the place before the *S */
    uint32_t packet_commands;              /* sent of it */
    uint32_t packet_vectors;

    struct gve_player_waiting waiting[GVE_PLAYER_WAITING_MAX]; /* a ring */
    uint32_t waiting_first;
    uint32_t waiting_count;
    bool alone;          /* the last one of them is J or a switch of the checksums */
    uint64_t quiet_tick; /* nothing is sent before */

    struct gve_told_text text; /* what is coming */
    struct gve_told_text held; /* after J: what has come, the answer to J unless another one comes; length 0: nothing */
    bool sums;

    struct gve_told told;
    uint64_t commands; /* that were answered with a code other than 1, or need no answer */
    uint64_t repeats;  /* answers with code 1, and of probing axes that still move */
    uint64_t vectors;  /* that the unit has taken */
    uint64_t silent;   /* lines without an answer, because of J */
};

/* Plays a checked file on a machine. False after a complaint. */
bool gve_player_begin(struct gve_player *player, struct host_machine *machine, const struct infile *file,
                      uint32_t byte_ticks);

/* As struct run_partner wants them. */
void gve_player_hear(void *context, uint64_t tick, uint8_t value);
uint64_t gve_player_pass(void *context);
bool gve_player_is_over(const void *context);

/* The line that the others wait for, whether it has been sent or not; null: all have been answered. */
const struct gve_script_line *gve_player_stuck_at(const struct gve_player *player);

void gve_player_discard(struct gve_player *player);

#endif
