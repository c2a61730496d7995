#include "stats.h"

#include <string.h>

void stats_reset(struct stats *stats)
{
    memset(stats->vector, 0, sizeof stats->vector);
    stats->tail_chains = 0;
    stats->since_cycle = stats->wires.clock->now;
    stats->since_asleep = stats->wires.clock->asleep_cycles;
    stats->since_stalled = stats->wires.clock->stalled_cycles;
    stats->since_instructions = stats->wires.cpu->instructions;
}

void stats_begin(struct stats *stats, uint64_t cycle)
{
    stats->begin = cycle;
}

void stats_enter(struct stats *stats, unsigned exception)
{
    struct stats_vector *vector = &stats->vector[exception];
    uint64_t pended = stats->wires.nvic->pended_cycle[exception];
    uint64_t latency = stats->wires.clock->now > pended ? stats->wires.clock->now - pended : 0;
    vector->latency_most = latency > vector->latency_most ? latency : vector->latency_most;
    if (stats->depth < STATS_DEPTH) {
        stats->frame[stats->depth++] = (struct stats_frame){.exception = exception, .begin = stats->begin};
    }
}

static void count(struct stats_vector *vector, uint64_t cycles)
{
    vector->least = vector->count == 0 || cycles < vector->least ? cycles : vector->least;
    vector->most = cycles > vector->most ? cycles : vector->most;
    vector->count++;
    vector->cycles += cycles;
    vector->bin[cycles < STATS_BINS ? cycles : STATS_BINS - 1]++;
}

void stats_leave(struct stats *stats, unsigned exception)
{
    if (stats->depth == 0 || stats->frame[stats->depth - 1U].exception != exception) {
        return;
    }
    const struct stats_frame *frame = &stats->frame[--stats->depth];
    uint64_t whole = stats->wires.clock->now - frame->begin;
    count(&stats->vector[exception], whole - frame->inner);
    if (stats->depth > 0) {
        stats->frame[stats->depth - 1U].inner += whole;
    }
}

void stats_note_fault(struct stats *stats, uint32_t bits, uint32_t at)
{
    if (stats->faults++ == 0) {
        stats->fault_bits = bits;
        stats->fault_at = at;
    }
}

uint64_t stats_median(const struct stats_vector *vector)
{
    uint64_t seen = 0;
    for (unsigned i = 0; i < STATS_BINS - 1; i++) {
        seen += vector->bin[i];
        if (2U * seen >= vector->count) {
            return i;
        }
    }
    return vector->most;
}
