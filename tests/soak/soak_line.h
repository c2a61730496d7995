/*
 * How the master of the soak test talks: bytes to the unit, and the answer that must come.
 */
#ifndef SOAK_LINE_H
#define SOAK_LINE_H

#include "soak_master.h"

enum {
    SOAK_NODE = 1
};

/* A promise is broken unless the condition holds. */
void soak_require(struct soak_master *master, bool good, const char *promise);

/* Says bytes at the rate of the line, `broken_mask` choosing those of every 64 with a framing error, and waits until
 * the unit has said what it has to say. */
void soak_hear(struct soak_master *master, const uint8_t *bytes, uint32_t length, uint64_t broken_mask);

/* A new request, and its answer: content[2] is its first byte. */
void soak_request(struct soak_master *master, const uint8_t *message, uint32_t length);

/* The last request once more: the same answer. */
void soak_repeat(struct soak_master *master);

/* To all units: no answer. */
void soak_broadcast(struct soak_master *master, const uint8_t *message, uint32_t length);

/* Set Command to a motor (0: all); its flag must be one of those in the mask. */
void soak_send(struct soak_master *master, unsigned motor, const char *text, unsigned flag_mask);

/* Get Status, read into content. */
void soak_ask_status(struct soak_master *master);
uint32_t soak_status_number(const struct soak_master *master, unsigned byte);

#endif
