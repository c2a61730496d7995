#include "art.h"

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
    return take_line(art, 0, ART_LINES, address);
}

bool art_has(const struct art *art, uint32_t address)
{
    for (unsigned i = 0; i < ART_LINES; i++) {
        if (art->tag[i] == address / LINE_BYTES + 1U) {
            return true;
        }
    }
    return false;
}

/* A literal lies at the end of its function: its own place is taken for that of the instruction, which keeps it apart
 * from the literals of other functions as well. */
bool art_fetch_literal(struct art *art, uint32_t address)
{
    return take_line(art, ART_LINES, ART_DATA_LINES, address);
}

void art_reset(struct art *art)
{
    *art = (struct art){.clock = 0};
}
