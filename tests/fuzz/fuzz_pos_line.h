/*
 * The line of a positioning unit that is fuzzed, and an independent reader of what goes over it: frames that it finds
 * good are taken by the unit, all others are not, and each request to the unit alone gets one answer that it finds
 * good.
 */
#ifndef FUZZ_POS_LINE_H
#define FUZZ_POS_LINE_H

#include "fuzz_pos_bench.h"

enum {
    FUZZ_POS_NODE = 1,
    FUZZ_POS_FRAME_ROOM = 260,
    FUZZ_POS_LINE_ROOM = 2048,
};

/* The frame that is coming, as the reader keeps it. */
struct fuzz_pos_line {
    struct fuzz_pos *fuzz;
    struct host_line_byte script[FUZZ_POS_LINE_ROOM];
    uint8_t bytes[FUZZ_POS_LINE_ROOM];
    uint32_t length;
    uint64_t last_tick; /* of the last byte, or of the start */
    bool bad;
    bool deaf;  /* the bus has not been silent since the start */
    bool vague; /* a byte may have come in time or not: nothing is judged any more */
    uint32_t taken;
    uint32_t dropped;
    uint8_t request[FUZZ_POS_FRAME_ROOM]; /* the last one, without its CRC */
    uint32_t request_length;              /* 0: it got an exception, or it is not known */
};

/* The unit has just started. */
void fuzz_pos_line_begin(struct fuzz_pos_line *line, struct fuzz_pos *fuzz);

/* T, and the byte that could be under way. */
uint64_t fuzz_pos_line_silence_ticks(const struct fuzz_pos_line *line);

/* Time goes by, at least until an answer that is due has gone out. */
void fuzz_pos_line_wait(struct fuzz_pos_line *line, uint64_t ticks);

/* Bytes one after the other, one of them broken, and no silence after them. */
void fuzz_pos_line_put(struct fuzz_pos_line *line, const uint8_t *bytes, uint32_t length, uint32_t broken);

/* A frame with its CRC, and the silence after it. */
void fuzz_pos_line_ask(struct fuzz_pos_line *line, const uint8_t *bytes, uint32_t length);

#endif
