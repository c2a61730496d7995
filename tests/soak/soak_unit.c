#include "soak_unit.h"

#include <string.h>

enum {
    CANARY = 0xA5,
    LATE_TICKS = 5 * TICKS_PER_US, /* the tick interrupt after an edge, as on a board */
};

#define FNV_START UINT64_C(0xCBF29CE484222325)
#define FNV_PRIME UINT64_C(0x100000001B3)

static uint64_t digest_bytes(uint64_t digest, const void *bytes, size_t length)
{
    const uint8_t *byte = bytes;
    for (size_t i = 0; i < length; i++) {
        digest = (digest ^ byte[i]) * FNV_PRIME;
    }
    return digest;
}

static void on_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct soak_unit *soak = context;
    soak->position[motor] += backward ? -1 : 1;
    soak->pulses[motor]++;
    judge_unit_step(soak, tick, motor, backward);
}

static void on_trace(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    struct soak_unit *soak = context;
    soak->moves += event == HAL_TRACE_MOVE ? 1U : 0U;
    soak->errors += event == HAL_TRACE_ERROR ? 1U : 0U;
    judge_unit_trace(soak, tick, motor, event, value);
}

static void on_line(void *context, uint64_t tick, uint8_t value)
{
    struct soak_unit *soak = context;
    soak->sent_digest = digest_bytes(digest_bytes(soak->sent_digest, &tick, sizeof tick), &value, 1);
    if (soak->sent_count < SOAK_SENT_MAX) {
        soak->sent[soak->sent_count++] = value;
    } else {
        soak->sent_lost++;
    }
}

static uint64_t main_pass(void *context)
{
    struct soak_unit *soak = context;
    soak->passes++;
    return judge_unit_pass(soak);
}

/* The pointers and numbers that a unit gets at its start and keeps. */
static uint64_t digest_constants(const struct soak_unit *soak)
{
    const struct rkm04 *unit = &soak->unit;
    uint64_t digest = digest_bytes(FNV_START, &unit->messages, sizeof unit->messages);
    digest = digest_bytes(digest, &unit->line.link.answer, sizeof unit->line.link.answer);
    digest = digest_bytes(digest, &unit->line.link.receiver.message, sizeof unit->line.link.receiver.message);
    digest = digest_bytes(digest, &unit->line.link.receiver.node, sizeof unit->line.link.receiver.node);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        const struct interpreter *interpreter = &unit->interpreter[i];
        digest = digest_bytes(digest, &interpreter->axis, sizeof interpreter->axis);
        digest = digest_bytes(digest, &interpreter->shared, sizeof interpreter->shared);
        digest = digest_bytes(digest, &interpreter->motor, sizeof interpreter->motor);
        digest = digest_bytes(digest, &unit->axis[i].motor, sizeof unit->axis[i].motor);
        digest = digest_bytes(digest, &unit->axis[i].channel.motor, sizeof unit->axis[i].channel.motor);
    }
    return digest;
}

void soak_unit_begin(struct soak_unit *soak, uint64_t epoch)
{
    memset(soak, 0, sizeof *soak);
    memset(soak->before, CANARY, sizeof soak->before);
    memset(soak->after, CANARY, sizeof soak->after);
    soak->sent_digest = FNV_START;
    soak->judged = (struct judged_unit){.unit = &soak->unit, .judge = &soak->judge, .machine = &soak->machine};
    judge_unit_begin(&soak->judged, epoch);
    soak->machine.faults.late_tick_ticks = LATE_TICKS;
    soak->machine.listener.step = on_step;
    soak->machine.listener.trace = on_trace;
    soak->machine.listener.line = on_line;
    rkm04_init(&soak->unit);
    rkm04_start(&soak->unit);
    soak->constants = digest_constants(soak);
}

void soak_unit_run(struct soak_unit *soak, uint64_t ticks)
{
    host_machine_run(&soak->machine, soak->machine.now + ticks, main_pass, NULL, soak);
}

bool soak_unit_is_whole(const struct soak_unit *soak)
{
    for (size_t i = 0; i < SOAK_CANARY_BYTES; i++) {
        if (soak->before[i] != CANARY || soak->after[i] != CANARY) {
            return false;
        }
    }
    return digest_constants(soak) == soak->constants;
}

uint64_t soak_unit_digest(const struct soak_unit *soak)
{
    uint64_t digest = judge_digest(&soak->judge);
    return digest_bytes(soak->sent_digest, &digest, sizeof digest);
}
