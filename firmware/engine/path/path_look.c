#include "path_look.h"

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

uint64_t path_look_brakeable(const struct path *path, uint32_t section)
{
    const struct path_section *before = path_section_of(path, section - 1U);
    const struct path_section *after = path_section_of(path, section);
    uint64_t cap = lower(lower(before->speed2, after->speed2), after->border2);
    return lower(cap, after->exit2 + after->gain2);
}

/* Backward: from no border may the next one be out of reach of the brake. A path that stops wants no speed at any. */
static void look_backward(const struct path *path)
{
    uint64_t exit2 = 0;
    for (uint32_t i = path->known; i != path->laid; i--) {
        path_section_of(path, i - 1U)->exit2 = exit2;
        exit2 = path->stopping || i - 1U == path->laid ? 0 : path_look_brakeable(path, i - 1U);
    }
}

uint64_t path_look_gain(const struct path *path)
{
    const struct path_section *section = path_section_of(path, path->laid);
    struct wide grains = wide_subtract(path_section_end(section), path->next.place);
    return grains.high != 0 ? PATH_SPEED2_ENDLESS : lower(grains.low / 2U, PATH_SPEED2_ENDLESS);
}

/* Out of the section in which the plan begins, with the speed and the way that are left. */
static void look_out(struct path *path)
{
    struct path_section *section = path_section_of(path, path->laid);
    uint64_t speed2 = path->next.speed2;
    uint64_t gain = path_look_gain(path);
    section->exit2 = lower(section->exit2, path_section_to_border2(section, speed2 + gain));
    uint64_t least = speed2 > gain ? speed2 - gain : 0;
    path->too_fast = path_section_from_border2(section, section->exit2) < least;
    if (path->too_fast) {
        section->exit2 = path_section_to_border2_up(section, least);
    }
}

/* Forward: to no border faster than the ramp can get, nor slower than the brake can: it is too fast only where it was
 * planned so before a speed was lowered, and then brakes through as many sections as that takes. */
static void look_forward(const struct path *path)
{
    uint64_t exit2 = path_section_of(path, path->laid)->exit2;
    for (uint32_t i = path->laid + 1U; i != path->known; i++) {
        struct path_section *section = path_section_of(path, i);
        uint64_t least = exit2 > section->gain2 ? exit2 - section->gain2 : 0;
        uint64_t most = lower(section->exit2, exit2 + section->gain2);
        exit2 = most < least ? least : most;
        section->exit2 = exit2;
    }
}

void path_look(struct path *path)
{
    look_backward(path);
    look_out(path);
    look_forward(path);
}
