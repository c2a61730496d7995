#include "stats.h"

#include <string.h>

#include "board.h"

void stats_reset(struct board *board)
{
    struct stats *stats = &board->stats;
    memset(stats->vector, 0, sizeof stats->vector);
    stats->tail_chains = 0;
    stats->since_cycle = board->cpu.now;
    stats->since_asleep = board->cpu.asleep_cycles;
    stats->since_stalled = board->cpu.stalled_cycles;
    stats->since_instructions = board->cpu.instructions;
}

void stats_begin(struct board *board, uint64_t cycle)
{
    board->stats.begin = cycle;
}

void stats_enter(struct board *board, unsigned exception)
{
    struct stats *stats = &board->stats;
    struct stats_vector *vector = &stats->vector[exception];
    uint64_t pended = board->nvic.pended_cycle[exception];
    uint64_t latency = board->cpu.now > pended ? board->cpu.now - pended : 0;
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

void stats_leave(struct board *board, unsigned exception)
{
    struct stats *stats = &board->stats;
    if (stats->depth == 0 || stats->frame[stats->depth - 1U].exception != exception) {
        return;
    }
    const struct stats_frame *frame = &stats->frame[--stats->depth];
    uint64_t whole = board->cpu.now - frame->begin;
    count(&stats->vector[exception], whole - frame->inner);
    if (stats->depth > 0) {
        stats->frame[stats->depth - 1U].inner += whole;
    }
}

void stats_note_fault(struct board *board, uint32_t bits, uint32_t at)
{
    if (board->stats.faults++ == 0) {
        board->stats.fault_bits = bits;
        board->stats.fault_at = at;
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
