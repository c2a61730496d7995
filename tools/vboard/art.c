#include "art.h"

#include "board.h"

enum {
    LINE_BYTES = 16
};

static bool take_line(struct art *art, unsigned first, unsigned lines, uint32_t address)
{
    uint32_t tag = address / LINE_BYTES + 1U;
    unsigned oldest = first;
    art->clock++;
    for (unsigned i = first; i < first + lines; i++) {
        if (art->tag[i] == tag) {
            art->used[i] = art->clock;
            return true;
        }
        oldest = art->used[i] < art->used[oldest] ? i : oldest;
    }
    art->tag[oldest] = tag;
    art->used[oldest] = art->clock;
    return false;
}

bool art_fetch(struct art *art, uint32_t address)
{
    return take_line(art, 0, CPU_ART_LINES, address);
}

bool art_has(const struct art *art, uint32_t address)
{
    for (unsigned i = 0; i < CPU_ART_LINES; i++) {
        if (art->tag[i] == address / LINE_BYTES + 1U) {
            return true;
        }
    }
    return false;
}

/* A literal lies behind its function: its own place is taken for that of the instruction, which keeps it apart from
 * the literals of other functions as well. */
uint32_t art_literal_wait(struct board *board, uint32_t address)
{
    struct cpu *cpu = &board->cpu;
    if (cpu->art_modelled && flash_data_cache_is_on(&board->flash)) {
        return take_line(&cpu->art, CPU_ART_LINES, CPU_ART_DATA_LINES, address) ? 0 : cpu->wait_states;
    }
    return cpu->wait_states;
}

void art_reset(struct art *art)
{
    *art = (struct art){.clock = 0};
}
