#include "motion_plan.h"

#include <assert.h>

#include "base_hint.h"
#include "motion_leg.h"
#include "step_scale.h"

enum {
    LEGS = 3
};

/* A cruise is handed over in pieces of so many pulses: a segment counts them in 32 bits. */
static const uint64_t PIECE_PULSES = UINT64_C(1) << 30;

/* Times up to the end of a ramp, V^2/2A pulses, stay below that with any speed and acceleration. */
static_assert((uint64_t)STEP_SPEED_MAX * STEP_SPEED_MAX / 2U < (UINT64_C(1) << 37), "a ramp's way must be countable");

/* The last ramp of a run without end lies behind that, the end of any other move before it. */
#define ENDLESS_RAMP_STEP (MOTION_ENDLESS_STEPS - (UINT64_C(1) << 37))
static_assert(MOTION_STEPS_MAX < ENDLESS_RAMP_STEP, "a move's end must be told from that of a run without end");

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t section_begin(const struct motion_plan *plan, unsigned section)
{
    uint64_t begin = 0;
    for (unsigned i = 0; i < section; i++) {
        begin += plan->order.section[i].steps;
    }
    return begin;
}

/* The way through a section, as far as it lies behind the origin. */
static struct motion_way section_way(const struct motion_plan *plan, unsigned section, uint64_t enter_speed2)
{
    const struct motion_section *order = &plan->order.section[section];
    uint64_t begin = section_begin(plan, section);
    uint64_t skip = section == plan->first ? plan->origin.step - begin : 0;
    return (struct motion_way){
        .begin = begin + skip,
        .steps = order->steps - skip,
        .enter_speed2 = enter_speed2,
        .exit_speed2 = plan->exit_speed2[section],
        .speed_steps_per_s = order->speed_steps_per_s,
        .accel_steps_per_s2 = order->accel_steps_per_s2,
        .start_speed_steps_per_s = plan->order.start_speed_steps_per_s,
        .jumps = plan->changed && section == plan->first,
    };
}

static uint64_t section_enter(const struct motion_plan *plan, unsigned section)
{
    return section == plan->first ? plan->origin.speed2 : plan->exit_speed2[section - 1U];
}

/* No speed at a border is higher than both its sections allow, nor the last than S. */
static uint64_t border_cap(const struct motion_order *order, unsigned section)
{
    uint32_t after = section + 1U < order->sections ? order->section[section + 1U].speed_steps_per_s
                                                    : order->start_speed_steps_per_s;
    return lower(motion_square(order->section[section].speed_steps_per_s), motion_square(after));
}

/* The highest square of a speed at the beginning of a section from which its end can be braked to. */
static uint64_t brakeable(const struct motion_plan *plan, unsigned section)
{
    const struct motion_section *order = &plan->order.section[section];
    return plan->exit_speed2[section] + motion_gain(order->accel_steps_per_s2, order->steps);
}

/* Backward: from no border may the next one be out of reach of the brake. */
static void look_backward(struct motion_plan *plan)
{
    unsigned last = plan->order.sections - 1U;
    plan->exit_speed2[last] = border_cap(&plan->order, last);
    for (unsigned i = last; i > plan->first; i--) {
        plan->exit_speed2[i - 1U] = lower(border_cap(&plan->order, i - 1U), brakeable(plan, i));
    }
}

/* Forward: to no border faster than the ramp can get; and after a change of speed, to the next one not slower than the
 * brake can get, which the plan before the change has proved to be slow enough for all that follows. */
static void look_forward(struct motion_plan *plan)
{
    uint64_t speed2 = plan->origin.speed2;
    for (unsigned i = plan->first; i < plan->order.sections; i++) {
        struct motion_way way = section_way(plan, i, speed2);
        uint64_t enter = motion_profile_enter(&way);
        uint64_t gain = motion_gain(way.accel_steps_per_s2, way.steps);
        uint64_t exit = lower(plan->exit_speed2[i], enter + gain);
        bool too_fast = enter > gain && enter - gain > motion_profile_floor(&way);
        speed2 = too_fast ? enter - gain : exit;
        plan->exit_speed2[i] = speed2;
    }
}

static void rewind_to_origin(struct motion_plan *plan)
{
    plan->progress = (struct motion_progress){
        .time = plan->origin.time,
        .place = {.step = plan->origin.step},
        .section = plan->first,
    };
}

static void take_order(struct motion_plan *plan, const struct motion_order *order, uint64_t start_tick)
{
    uint64_t speed2 =
        lower(motion_square(order->start_speed_steps_per_s), motion_square(order->section[0].speed_steps_per_s));
    *plan = (struct motion_plan){
        .order = *order,
        .origin = {.time = {.ticks = start_tick}, .speed2 = speed2},
    };
    plan->mark_step = section_begin(plan, plan->order.sections - 1U);
}

void motion_plan_begin(struct motion_plan *plan, const struct motion_order *order, uint64_t start_tick)
{
    take_order(plan, order, start_tick);
    look_backward(plan);
    plan->origin.speed2 = lower(plan->origin.speed2, brakeable(plan, 0));
    plan->begin_speed2 = plan->origin.speed2;
    look_forward(plan);
    rewind_to_origin(plan);
}

static struct motion_profile lay_section(const struct motion_plan *plan, unsigned section)
{
    struct motion_way way = section_way(plan, section, section_enter(plan, section));
    return plan->stopping ? motion_profile_lay_stop(&way) : motion_profile_lay(&way);
}

static uint64_t slope_of(struct motion_progress *progress, uint64_t twice_speed2)
{
    if (progress->twice_speed2 != twice_speed2) {
        progress->twice_speed2 = twice_speed2;
        progress->slope = motion_leg_slope(twice_speed2);
    }
    return progress->slope;
}

static void leg_first_ramp(struct motion_progress *progress, struct motion_leg *leg)
{
    const struct motion_profile *profile = &progress->profile;
    uint64_t change = 4U * (uint64_t)profile->accel_steps_per_s2;
    leg->to = profile->corner_a;
    leg->accel = profile->accel_steps_per_s2 * STEP_ACCEL_PER_ACCEL;
    leg->from_slope = slope_of(progress, profile->enter);
    leg->to_slope = slope_of(progress, profile->turn);
    leg->pulse_twice_speed2 =
        profile->turn < profile->enter ? profile->enter - lower(change, profile->enter) : profile->enter + change;
}

static void leg_cruise(struct motion_progress *progress, struct motion_leg *leg)
{
    leg->to = progress->profile.corner_b;
    if (leg->to.step - leg->from.step > PIECE_PULSES) {
        leg->to = (struct motion_place){.step = leg->from.step + PIECE_PULSES};
    }
    leg->from_slope = slope_of(progress, progress->profile.cruise);
    leg->to_slope = leg->from_slope;
}

static void leg_last_ramp(struct motion_progress *progress, struct motion_leg *leg)
{
    const struct motion_profile *profile = &progress->profile;
    leg->to = (struct motion_place){.step = profile->end};
    leg->accel = profile->accel_steps_per_s2 * STEP_ACCEL_PER_ACCEL;
    leg->from_slope = slope_of(progress, profile->cruise);
    leg->to_slope = slope_of(progress, profile->exit);
    uint64_t steps_left = leg->to.step - leg->from.step - 1U;
    leg->pulse_twice_speed2 = profile->exit + 4U * (uint64_t)profile->accel_steps_per_s2 * steps_left;
}

/* The leg that begins where the progress stands; it has a length. */
static struct motion_leg lay_leg(struct motion_progress *progress)
{
    struct motion_leg leg = {.start = progress->time, .from = progress->place};
    switch (progress->leg) {
    case 0:
        leg_first_ramp(progress, &leg);
        break;
    case 1:
        leg_cruise(progress, &leg);
        break;
    default:
        leg_last_ramp(progress, &leg);
        break;
    }
    motion_leg_set_end(&leg);
    return leg;
}

static bool is_same_place(struct motion_place a, struct motion_place b)
{
    return a.step == b.step && a.quanta == b.quanta;
}

/* Whether the leg has no length. */
static bool is_leg_empty(const struct motion_progress *progress)
{
    struct motion_place end = {.step = progress->profile.end};
    if (progress->leg == 0) {
        end = progress->profile.corner_a;
    } else if (progress->leg == 1U) {
        end = progress->profile.corner_b;
    }
    return is_same_place(progress->place, end);
}

static void next_leg(struct motion_plan *plan)
{
    struct motion_progress *progress = &plan->progress;
    progress->leg++;
    if (progress->leg == LEGS || plan->stopping) {
        progress->leg = 0;
        progress->section++;
    }
}

/* Puts the progress behind the leg that was laid; a piece of a cruise is followed by the next. */
static void advance(struct motion_plan *plan, const struct motion_leg *leg)
{
    struct motion_progress *progress = &plan->progress;
    bool piece = progress->leg == 1U && leg->to.step != progress->profile.corner_b.step;
    progress->time = leg->end;
    progress->place = leg->to;
    if (!piece) {
        next_leg(plan);
    }
}

BASE_APART
static void lay_profile(struct motion_plan *plan)
{
    struct motion_progress *progress = &plan->progress;
    if (progress->leg == 0) {
        progress->profile = lay_section(plan, progress->section);
    }
}

BASE_APART
static void lay_next_leg(struct motion_plan *plan, struct motion_leg *leg)
{
    /* In two steps, for the proof: one says what is kept of the plan, the other of the leg. */
    struct motion_leg next = lay_leg(&plan->progress);
    *leg = next;
}

/* Takes the next leg that has pulses; false if there is none. */
static bool take_leg(struct motion_plan *plan, struct motion_leg *leg)
{
    while (plan->progress.section < plan->order.sections) {
        lay_profile(plan);
        if (is_leg_empty(&plan->progress)) {
            next_leg(plan);
            continue;
        }
        lay_next_leg(plan, leg);
        advance(plan, leg);
        if (motion_leg_pulses(leg) > 0) {
            return true;
        }
    }
    return false;
}

/* Whether the order's last section of several begins with a leg that has pulses: no such leg of another begins there.
 * A stop brakes into that section, too. */
static bool is_mark(const struct motion_plan *plan, const struct motion_leg *leg)
{
    return plan->mark_step > 0 && leg->from.step == plan->mark_step;
}

static void lay_segment(const struct motion_plan *plan, const struct motion_leg *leg, struct step_segment *segment)
{
    bool marked = is_mark(plan, leg);
    *segment = motion_leg_segment(leg);
    segment->marked = marked;
}

bool motion_plan_next(struct motion_plan *plan, struct step_segment *segment)
{
    struct motion_leg leg;
    bool taken = take_leg(plan, &leg);
    if (taken) {
        lay_segment(plan, &leg, segment);
    }
    return taken;
}

/* The section that begins or goes on behind a step; order.sections if the move ends there. */
static unsigned section_behind(const struct motion_plan *plan, uint64_t step)
{
    unsigned section = 0;
    uint64_t end = 0;
    for (; section < plan->order.sections; section++) {
        end += plan->order.section[section].steps;
        if (step < end) {
            break;
        }
    }
    return section;
}

/* Brakes through the sections, each with its own acceleration, until S is reached; the move ends in that section. Its
 * final ramp is that very ramp, so a stop on it changes nothing. */
static void plan_brake(struct motion_plan *plan)
{
    uint64_t target = motion_square(plan->order.start_speed_steps_per_s);
    uint64_t speed2 = plan->origin.speed2;
    unsigned section = plan->first;
    while (speed2 > target) {
        struct motion_way way = section_way(plan, section, speed2);
        uint64_t gain = motion_gain(way.accel_steps_per_s2, way.steps);
        speed2 = speed2 > gain && speed2 - gain > target ? speed2 - gain : target;
        plan->exit_speed2[section] = speed2;
        section++;
    }
    plan->order.sections = (uint8_t)section;
}

bool motion_plan_brake(const struct motion_plan *plan, uint64_t step, uint64_t slope, struct motion_brake *brake)
{
    unsigned section = section_behind(plan, step);
    if (plan->stopping || section == plan->order.sections) {
        return false;
    }
    const struct motion_section *order = &plan->order.section[section];
    uint64_t speed2 = motion_square((uint32_t)(slope / STEP_SLOPE_PER_SPEED));
    uint64_t target = motion_square(plan->order.start_speed_steps_per_s);
    uint64_t way = speed2 > target ? (speed2 - target) / (4U * (uint64_t)order->accel_steps_per_s2) : 0;
    brake->accel = (int32_t)(order->accel_steps_per_s2 * STEP_ACCEL_PER_ACCEL);
    brake->until = lower(step + way, section_begin(plan, section) + order->steps);
    return true;
}

bool motion_plan_stop(struct motion_plan *plan, const struct motion_point *at)
{
    unsigned section = section_behind(plan, at->step);
    if (plan->stopping || section == plan->order.sections) {
        return false;
    }
    plan->origin = *at;
    plan->first = (uint8_t)section;
    plan->stopping = true;
    plan_brake(plan);
    rewind_to_origin(plan);
    return true;
}

bool motion_plan_change_speed(struct motion_plan *plan, const struct motion_point *at, uint32_t speed_steps_per_s)
{
    unsigned section = section_behind(plan, at->step);
    if (plan->stopping || section == plan->order.sections) {
        return false;
    }
    plan->order.section[section].speed_steps_per_s = speed_steps_per_s;
    plan->origin = *at;
    plan->first = (uint8_t)section;
    plan->changed = true;
    look_backward(plan);
    look_forward(plan);
    rewind_to_origin(plan);
    return true;
}

/* The square root of half of `twice_speed2`, to the nearest: 20 bits below the point decide. */
static uint32_t nearest_speed(uint64_t twice_speed2)
{
    enum {
        POINT_BITS = 20
    };
    uint64_t root = wide_root_nearest(wide_shift_left((struct wide){.low = twice_speed2}, 2U * POINT_BITS - 1U));
    return (uint32_t)((root + (UINT64_C(1) << (POINT_BITS - 1))) >> POINT_BITS);
}

static struct motion_corner corner_at(struct motion_place place, uint64_t twice_speed2)
{
    return (struct motion_corner){
        .step = place.step + (place.quanta >= STEP_QUANTA / 2U ? 1U : 0U),
        .speed_steps_per_s = nearest_speed(twice_speed2),
    };
}

/* The corners inside a section and at its end. A stop ends with its last whole step, before its corner. */
static unsigned section_corners(const struct motion_profile *profile, struct motion_corner corners[LEGS])
{
    struct motion_place begin = {.step = profile->begin};
    unsigned count = 0;
    if (!is_same_place(profile->corner_a, begin) && profile->corner_a.step < profile->end) {
        corners[count++] = corner_at(profile->corner_a, profile->turn);
    }
    if (!is_same_place(profile->corner_b, profile->corner_a) && profile->corner_b.step < profile->end) {
        corners[count++] = corner_at(profile->corner_b, profile->cruise);
    }
    corners[count++] = corner_at((struct motion_place){.step = profile->end}, profile->exit);
    return count;
}

/* The curve ends at its last pulse with speed 0; a run without end has neither an end nor a ramp down to it. */
static unsigned close_corners(struct motion_corner corners[MOTION_CORNERS_MAX], unsigned count)
{
    corners[count - 1U].speed_steps_per_s = 0;
    while (corners[count - 1U].step >= ENDLESS_RAMP_STEP) {
        count--;
    }
    return count;
}

unsigned motion_plan_corners(const struct motion_plan *plan, struct motion_corner corners[MOTION_CORNERS_MAX])
{
    unsigned count = 0;
    corners[count++] = corner_at((struct motion_place){.step = 1}, 2U * plan->begin_speed2);
    if (plan->origin.step > 0) {
        corners[count++] = corner_at((struct motion_place){.step = plan->origin.step}, 2U * plan->origin.speed2);
    }
    for (unsigned i = plan->first; i < plan->order.sections; i++) {
        struct motion_profile profile = lay_section(plan, i);
        count += section_corners(&profile, &corners[count]);
    }
    return close_corners(corners, count);
}
