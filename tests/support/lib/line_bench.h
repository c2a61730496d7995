/*
 * The other end of the line: what a master sends to the unit of the bench, at 19 200 Bd, and what it hears.
 */
#ifndef LINE_BENCH_H
#define LINE_BENCH_H

#include <stdint.h>

#include "bench.h"
#include "frames.h"

enum {
    LINE_BENCH_NODE = 1, /* of the unit, unless set */
    LINE_BENCH_SCRIPT_MAX = 40000,
    LINE_BENCH_SENT_MAX = 60000,
    LINE_BENCH_FRAME_MAX = FRAME_BYTES_MAX(MESSAGES_ANSWER_BYTES_MAX),
};

#define LINE_BENCH_BYTE_TICKS ((uint64_t)HOST_LINE_BYTE_TICKS)

struct line_bench {
    struct bench *bench;
    struct host_line_byte script[LINE_BENCH_SCRIPT_MAX]; /* what the unit is to hear */
    uint32_t script_length;
    struct host_line_byte sent[LINE_BENCH_SENT_MAX]; /* what the unit has sent */
    uint32_t sent_count;
    uint32_t read_count; /* of these have been looked at by line_answer */
    uint8_t asked;       /* the number of the message that was planned last */
    uint8_t frame[LINE_BENCH_FRAME_MAX];
    uint8_t content[LINE_BENCH_FRAME_MAX];
};

/* Nothing said yet. The line takes the bench's listener of the line; the bench must be a static one, alone. */
void line_init(struct line_bench *line, struct bench *bench);

/* Bytes at the rate of the line, after what was planned before or from now on. Returns the tick of the last one. */
uint64_t line_plan(struct line_bench *line, const uint8_t *bytes, uint32_t length);
uint64_t line_plan_frame(struct line_bench *line, uint8_t address, uint8_t number, const void *text, uint32_t length);

/* Runs until all that was planned has come in. */
void line_run(struct line_bench *line);

/* Sends a request, its message number and a string, and runs until it has come in. Returns the tick of its end. */
uint64_t line_request(struct line_bench *line, uint8_t address, uint8_t number, uint8_t message, const char *text);

/* Runs until the unit has sent all that it has to send, which must have an end. */
void line_drain(struct line_bench *line);

/* Runs for the time of an answer and until it has gone out. Returns what follows its message number, with a 0 after;
 * NULL: there was none. Fails if what was sent is not one frame with this number that answers the last message. */
const char *line_answer(struct line_bench *line, uint8_t number);

/* Opens a session: what was said before is forgotten. */
void line_open(struct line_bench *line);

/* Asks for the version. */
void line_check(struct line_bench *line);

/* Noise, the same in each run: with one seed in twelve a damaged frame has a right FCS. */
uint8_t line_random_byte(void);

#endif
