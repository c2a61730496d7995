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

uint64_t path_look_gain(const struct path *path)
{
    const struct path_section *section = path_section_of(path, path->laid);
    struct wide grains = path_wide_subtract(path_section_end(section), path->next.place);
    return grains.high != 0 ? PATH_SPEED2_ENDLESS : lower(grains.low / 2U, PATH_SPEED2_ENDLESS);
}

/* The end of what is known. */
static uint64_t end2_of(const struct path *path)
{
    const struct path_section *last = path_section_of(path, path->known - 1U);
    uint64_t start2 = path_section_to_border2(last, path_look_start2(path));
    return lower(last->speed2, start2);
}

/* Backward, down to section `until`: from no border may the next one be out of reach of the brake. */
static void look_backward(const struct path *path, uint32_t until)
{
    uint32_t count = path->known - 1U;
    struct path_section *after = path_section_of(path, count);
    uint64_t exit2 = end2_of(path);
    uint64_t speed2 = after->speed2;
    after->exit2 = exit2;
    while (count != until) {
        count--;
        struct path_section *before = path_section_of(path, count);
        uint64_t cap2 = lower(speed2, after->border2);
        speed2 = before->speed2;
        cap2 = lower(cap2, speed2);
        exit2 = lower(cap2, exit2 + after->gain2);
        after->cap2 = cap2;
        before->exit2 = exit2;
        after = before;
    }
}

/* The same through what look-ahead knows, until a speed is not raised. Returns the first section whose end has been
 * set. */
static uint32_t look_backward_again(const struct path *path, uint32_t from)
{
    uint32_t count = from;
    for (; count != path->laid; count--) {
        const struct path_section *after = path_section_of(path, count);
        struct path_section *before = path_section_of(path, count - 1U);
        uint64_t exit2 = lower(after->cap2, after->exit2 + after->gain2);
        if (before->exit2 == exit2) {
            break;
        }
        before->exit2 = exit2;
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
    if (section->turning == 0 || path_wide_is_at_least(way, path_section_end(section))) {
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
    if (enter2 <= section->gain2) {
        return 0;
    }
    uint64_t rest2 = path->stopping ? path_section_to_border2(section, path_look_start2(path)) : 0;
    return enter2 > section->gain2 + rest2 ? enter2 - section->gain2 : 0;
}

uint64_t path_look_exit2(const struct path *path, const struct path_section *section, uint64_t enter2)
{
    uint64_t least = least_of(path, section, enter2);
    uint64_t most = lower(path->stopping ? 0 : section->exit2, enter2 + section->gain2);
    return most < least ? least : most;
}

uint64_t path_look_brakeable(const struct path *path, uint32_t section, uint64_t enter2)
{
    const struct path_section *after = path_section_of(path, section);
    return lower(after->cap2, path_look_exit2(path, after, enter2) + after->gain2);
}

void path_look(struct path *path)
{
    if (path->stopping) {
        path_section_of(path, path->laid)->exit2 = 0;
    } else {
        look_backward(path, path->laid);
    }
    path->looked = path->known;
    if (path->laid == path->origin.section) {
        look_out(path);
    }
}

uint32_t path_look_again(struct path *path)
{
    uint32_t last = path->looked - 1U;
    if (path->looked != path->known) {
        look_backward(path, last);
        path->looked = path->known;
    }
    uint32_t first = look_backward_again(path, last);
    if (first == path->origin.section) {
        look_out(path);
    }
    return first;
}

/* Whether the plan of the section path->laid is the same whatever is added: at its end it is as fast as the border
 * allows, or as it can get. */
static bool is_settled(const struct path *path)
{
    uint32_t next = path->laid + 1U;
    if (next == path->looked) {
        return false;
    }
    const struct path_section *section = path_section_of(path, path->laid);
    bool speeds_up = path->laid != path->origin.section && path->border2 + section->gain2 < section->exit2;
    return speeds_up || section->exit2 == path_section_of(path, next)->cap2;
}

void path_look_if_due(struct path *path)
{
    if (path->looked != path->known && !is_settled(path)) {
        (void)path_look_again(path);
    }
}

bool path_look_is_more(struct path *path, uint64_t enter2)
{
    if (path->looked != path->known && path_section_of(path, path->laid)->cap2 > enter2) {
        (void)path_look_again(path);
    }
    return path_look_brakeable(path, path->laid, enter2) > enter2;
}
