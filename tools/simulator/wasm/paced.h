/*
 * One unit that follows a real clock, for who has neither sockets nor files, as the worker of a page. Messages go to
 * it without a line, each at the tick that it is then.
 *
 * The functions are what the WebAssembly module rkm04-unit exports. Real time is the caller's, in ns from any moment,
 * and does not go back. What the unit stores is kept until it ends.
 */
#ifndef PACED_H
#define PACED_H

#include <stdbool.h>
#include <stdint.h>

struct paced;

/* A unit after power-on, of address 1, with an erased flash; 350 kB of the heap. Null: there is not memory enough. */
struct paced *paced_begin(uint64_t real_ns);

/* Lets the unit run as far as the clock has come, a slice at most. True: it is behind yet, call again. If it is more
 * than SERVE_LAG_MS_MAX behind, nobody has called for so long: its time has stood, and goes on from where it is. */
bool paced_follow(struct paced *paced, uint64_t real_ns);

/* Where a request is to be put: MESSAGES_REQUEST_BYTES_MAX; where its answer stands until the next one. */
uint8_t *paced_request(struct paced *paced);
const uint8_t *paced_answer(const struct paced *paced);

/* Answers the request of so many bytes; 0: it has no answer. The unit's time stands meanwhile: what comes before the
 * next paced_follow comes at the same tick. */
uint32_t paced_message(struct paced *paced, uint32_t length);

/* Gives input 1 to 8 a level now. */
void paced_set_input(struct paced *paced, uint32_t input, bool level);

/* The unit's time; and the real time, of all so far, in which that stood. */
uint64_t paced_now_ns(const struct paced *paced);
uint64_t paced_stood_ns(const struct paced *paced);

#endif
