#include "paced.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

#include "host_machine.h"
#include "paced_clock.h"
#include "rkm04.h"
#include "units.h"

struct paced {
    struct host_machine machine;
    struct rkm04 unit;
    struct paced_clock clock;
    uint8_t request[MESSAGES_REQUEST_BYTES_MAX];
    uint8_t answer[MESSAGES_ANSWER_BYTES_MAX];
};

struct paced *paced_begin(uint64_t real_ns)
{
    struct paced *paced = calloc(1, sizeof *paced);
    if (paced == NULL) {
        return NULL;
    }
    paced_clock_begin(&paced->clock, real_ns);
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
    return paced_clock_follow(&paced->clock, &paced->machine, real_ns, run_pass, &paced->unit);
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
    return units_ns_of_ticks(paced->clock.stood_ticks);
}
