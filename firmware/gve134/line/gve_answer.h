/*
 * The answers: codes and values in, bytes for the line out, one at a time.
 *
 * It keeps the last answer to be sent again byte for byte; an answer that must not take its place stands apart. While
 * one is being sent no other may be made. Main only. 128 bytes.
 */
#ifndef GVE_ANSWER_H
#define GVE_ANSWER_H

#include <stdbool.h>
#include <stdint.h>

enum {
    GVE_ANSWER_VALUES_MAX = 56, /* four positions of eleven characters, with commas, and more */
    GVE_ANSWER_BYTES_MAX = 1 + 1 + GVE_ANSWER_VALUES_MAX + 3 + 1,
};

struct gve_answer_bytes {
    uint8_t bytes[GVE_ANSWER_BYTES_MAX];
    uint8_t length; /* 0: there is none */
};

struct gve_answer {
    struct gve_answer_bytes last;
    struct gve_answer_bytes apart;
    bool is_apart;  /* the one that is being sent */
    uint8_t unsent; /* bytes of it that have not gone out */
};

/* There is no last answer. */
void gve_answer_init(struct gve_answer *answer);

/* Begins to send: the digit, 0 to 15, [a comma and the values,] [a comma and the sum,] CR. At most
 * GVE_ANSWER_VALUES_MAX bytes of values; 0: none. */
void gve_answer_make(struct gve_answer *answer, unsigned digit, const uint8_t *values, uint32_t length, bool sum,
                     bool apart);

/* Begins to send the last answer again. False: there is none. */
bool gve_answer_again(struct gve_answer *answer);

/* Whether there is a byte to be sent; that byte; and past it. */
bool gve_answer_is_sending(const struct gve_answer *answer);
uint8_t gve_answer_byte(const struct gve_answer *answer);
void gve_answer_advance(struct gve_answer *answer);

#endif
