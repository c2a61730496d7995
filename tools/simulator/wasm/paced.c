#include "paced.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

#include "base_tick.h"
#include "host_machine.h"
#include "rkm04.h"
#include "serve_clock.h"
#include "units.h"

enum {
    REAL_MILLI_SPEED = 1000
};

#define LAG_TICKS_MAX (SERVE_LAG_MS_MAX * TICKS_PER_MS)

/* Short enough for a caller that looks after others between two of them. */
#define SLICE_TICKS ((uint64_t)20 * TICKS_PER_MS)

struct paced {
    struct host_machine machine;
    struct rkm04 unit;
    struct serve_clock clock;
    uint64_t stood_ticks;
    uint8_t request[MESSAGES_REQUEST_BYTES_MAX];
    uint8_t answer[MESSAGES_ANSWER_BYTES_MAX];
};

struct paced *paced_begin(uint64_t real_ns)
{
    struct paced *paced = calloc(1, sizeof *paced);
    if (paced == NULL) {
        return NULL;
    }
    paced->clock.milli_speed = REAL_MILLI_SPEED;
    serve_clock_set(&paced->clock, real_ns, 0);
    host_machine_init(&paced->machine, 0);
    host_machine_select(&paced->machine);
    rkm04_init(&paced->unit);
    rkm04_start(&paced->unit);
    return paced;
}

static uint64_t run_pass(void *context)
{
    return rkm04_poll(context);
}

bool paced_follow(struct paced *paced, uint64_t real_ns)
{
    uint64_t now = paced->machine.now;
    uint64_t target = serve_clock_tick(&paced->clock, real_ns);
    uint64_t left = target > now ? target - now : 0;
    if (left > LAG_TICKS_MAX) {
        paced->stood_ticks += left;
        serve_clock_set(&paced->clock, real_ns, now);
        return false;
    }
    if (left > 0) {
        uint64_t until = now + (left < SLICE_TICKS ? left : SLICE_TICKS);
        host_machine_run(&paced->machine, until, run_pass, NULL, &paced->unit);
    }
    return left > SLICE_TICKS;
}

uint8_t *paced_request(struct paced *paced)
{
    return paced->request;
}

const uint8_t *paced_answer(const struct paced *paced)
{
    return paced->answer;
}

uint32_t paced_message(struct paced *paced, uint32_t length)
{
    assert(length <= MESSAGES_REQUEST_BYTES_MAX);
    host_machine_select(&paced->machine);
    return rkm04_message(&paced->unit, paced->request, length, paced->answer);
}

void paced_set_input(struct paced *paced, uint32_t input, bool level)
{
    host_machine_set_input(&paced->machine, input, level);
}

uint64_t paced_now_ns(const struct paced *paced)
{
    return units_ns_of_ticks(paced->machine.now);
}

uint64_t paced_stood_ns(const struct paced *paced)
{
    return units_ns_of_ticks(paced->stood_ticks);
}
