#include "path_look.h"

#include "path_fixed.h"

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t higher(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

uint64_t path_look_brakeable(const struct path *path, uint32_t section)
{
    const struct path_section *before = path_section_of(path, section - 1U);
    const struct path_section *after = path_section_of(path, section);
    uint64_t cap = lower(lower(before->speed2, after->speed2), after->border2);
    return lower(cap, after->exit2 + after->gain2);
}

uint64_t path_look_gain(const struct path *path)
{
    const struct path_section *section = path_section_of(path, path->laid);
    struct wide grains = wide_subtract(path_section_end(section), path->next.place);
    return grains.high != 0 ? PATH_SPEED2_ENDLESS : lower(grains.low / 2U, PATH_SPEED2_ENDLESS);
}

/* The end of what is known. */
static uint64_t end2_of(const struct path *path)
{
    const struct path_section *last = path_section_of(path, path->known - 1U);
    uint64_t start2 = path_section_to_border2(last, path_look_start2(path));
    return path->stopping ? 0 : lower(last->speed2, start2);
}

/* With which a section after that of the origin is entered, in terms of borders. */
static uint64_t enter2_at_border(const struct path *path, uint32_t count)
{
    return count == path->laid ? path->border2 : path_section_of(path, count - 1U)->exit2;
}

/* Whether an end that is braked to from `exit2` leaves the plan of a section and of all before it as it is: its speed
 * at the end is not raised, or all the way to it the path is still getting faster. */
static bool is_final(const struct path *path, uint32_t count, uint64_t exit2)
{
    const struct path_section *section = path_section_of(path, count);
    if (section->exit2 == exit2) {
        return true;
    }
    return count != path->origin.section && section->gain2 > 0 &&
           section->exit2 == enter2_at_border(path, count) + section->gain2;
}

/* Backward: from no border may the next one be out of reach of the brake. A path that stops wants no speed at any.
 * Returns the first section whose end has been set. */
static uint32_t look_backward(const struct path *path, bool again)
{
    uint32_t count = path->known - 1U;
    path_section_of(path, count)->exit2 = end2_of(path);
    for (; count != path->laid; count--) {
        uint64_t exit2 = path->stopping ? 0 : path_look_brakeable(path, count);
        if (again && is_final(path, count - 1U, exit2)) {
            break;
        }
        path_section_of(path, count - 1U)->exit2 = exit2;
    }
    return count;
}

/* What the speed may be raised to at once: where an axis that turned has not made its first pulse, no more than at the
 * border. */
static uint64_t jump2_of(const struct path *path)
{
    const struct path_section *section = path_section_of(path, path->laid);
    struct wide way = path_wide_times(path->next.place, section->turning);
    uint64_t start2 = path_look_start2(path);
    if (section->turning == 0 || wide_is_at_least(way, path_section_end(section))) {
        return start2;
    }
    return lower(start2, path_section_from_border2(section, section->border2));
}

/* The speed with which the plan begins: up to the start speed at once, as far as the end can be braked to. */
static uint64_t enter2_of(const struct path *path)
{
    const struct path_section *section = path_section_of(path, path->laid);
    uint64_t speed2 = path->origin.entry.speed2;
    uint64_t limit = (uint64_t)section->vector.speed * section->vector.speed;
    uint64_t start2 = path_look_start2(path);
    if (speed2 > limit) {
        return speed2 <= start2 ? limit : speed2;
    }
    uint64_t brakeable = path_section_from_border2(section, section->exit2) + path_look_gain(path);
    return higher(speed2, lower(lower(limit, jump2_of(path)), brakeable));
}

/* What the square of the speed may fall at once: in a stop at its end; else from the start speed to the vector's, if it
 * is faster now. */
static uint64_t fall_of(const struct path *path)
{
    const struct path_section *section = path_section_of(path, path->laid);
    uint64_t start2 = path_look_start2(path);
    uint64_t limit = (uint64_t)section->vector.speed * section->vector.speed;
    if (path->stopping) {
        return start2;
    }
    return path->next.speed2 > limit && start2 > limit ? start2 - limit : 0;
}

/* Out of the section in which the plan begins, with the speed and the way that are left. */
static void look_out(struct path *path)
{
    struct path_section *section = path_section_of(path, path->laid);
    if (path_look_jumps(path, path->laid)) {
        path->next.speed2 = enter2_of(path);
    }
    uint64_t speed2 = path->next.speed2;
    uint64_t gain = path_look_gain(path);
    section->exit2 = lower(section->exit2, path_section_to_border2(section, speed2 + gain));
    uint64_t least = speed2 > gain ? speed2 - gain : 0;
    path->too_fast = path_section_from_border2(section, section->exit2) + fall_of(path) < least;
    if (path->too_fast) {
        section->exit2 = path_section_to_border2_up(section, least);
    }
}

/* The least speed at the end of a section that is entered with enter2; a stop rests in it if it can. */
static uint64_t least_of(const struct path *path, const struct path_section *section, uint64_t enter2)
{
    uint64_t rest2 = path->stopping ? path_section_to_border2(section, path_look_start2(path)) : 0;
    return enter2 > section->gain2 + rest2 ? enter2 - section->gain2 : 0;
}

/* Forward: to no border faster than the ramp can get, nor slower than the brake can: it is too fast only where it was
 * planned so before a speed was lowered, and then brakes through as many sections as that takes. */
static void look_forward(const struct path *path, uint32_t first)
{
    for (uint32_t i = first; i != path->known; i++) {
        struct path_section *section = path_section_of(path, i);
        uint64_t enter2 = enter2_at_border(path, i);
        uint64_t least = least_of(path, section, enter2);
        uint64_t most = lower(section->exit2, enter2 + section->gain2);
        section->exit2 = most < least ? least : most;
    }
}

static uint32_t look(struct path *path, bool again)
{
    uint32_t first = look_backward(path, again);
    bool begins = first == path->origin.section;
    if (begins) {
        look_out(path);
    }
    look_forward(path, begins ? first + 1U : first);
    return first;
}

void path_look(struct path *path)
{
    (void)look(path, false);
}

uint32_t path_look_again(struct path *path)
{
    return look(path, true);
}
