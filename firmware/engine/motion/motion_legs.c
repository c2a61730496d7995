#include "base_hint.h"
#include "motion_leg.h"
#include "motion_plan_private.h"
#include "step_scale.h"

enum {
    LEGS = 3
};

/* A cruise is handed over in pieces of so many pulses: a segment counts them in 32 bits. */
static const uint64_t PIECE_PULSES = UINT64_C(1) << 30;

static uint64_t section_enter(const struct motion_plan *plan, unsigned section)
{
    return section == plan->first ? plan->origin.speed2 : plan->exit_speed2[section - 1U];
}

struct motion_profile motion_legs_fit_section(const struct motion_plan *plan, unsigned section)
{
    struct motion_span span = motion_plan_section_span(plan, section, section_enter(plan, section));
    return plan->kind == MOTION_PLAN_STOP ? motion_profile_fit_stop(&span) : motion_profile_fit(&span);
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
    leg->pulse_twice_speed2 = profile->turn < profile->enter ? profile->enter - motion_lower(change, profile->enter)
                                                             : profile->enter + change;
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
static struct motion_leg make_leg(struct motion_progress *progress)
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

/* Whether the leg has no length. */
static bool is_leg_empty(const struct motion_progress *progress)
{
    struct motion_place end = {.step = progress->profile.end};
    if (progress->leg == 0) {
        end = progress->profile.corner_a;
    } else if (progress->leg == 1U) {
        end = progress->profile.corner_b;
    }
    return motion_place_is_same(progress->place, end);
}

/* A stop's profile is its first ramp alone. */
static void next_leg(struct motion_plan *plan)
{
    struct motion_progress *progress = &plan->progress;
    progress->leg++;
    if (progress->leg == LEGS || plan->kind == MOTION_PLAN_STOP) {
        progress->leg = 0;
        progress->section++;
    }
}

/* Puts the progress at the end of the leg that was made; a piece of a cruise is followed by the
 * next. */
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

/* Apart, as is the next one: their stack is free again where a segment is made. */
BASE_APART
static void fit_profile(struct motion_plan *plan)
{
    struct motion_progress *progress = &plan->progress;
    if (progress->leg == 0) {
        progress->profile = motion_legs_fit_section(plan, progress->section);
    }
}

BASE_APART
static void make_next_leg(struct motion_plan *plan, struct motion_leg *leg)
{
    /* Not in one assignment: the proofs take what is kept of the plan from the call, and of the leg
     * from the copy. */
    struct motion_leg next = make_leg(&plan->progress);
    *leg = next;
}

/* Takes the next leg that has pulses; false if there is none. */
static bool take_leg(struct motion_plan *plan, struct motion_leg *leg)
{
    while (plan->progress.section < plan->order.sections) {
        fit_profile(plan);
        if (is_leg_empty(&plan->progress)) {
            next_leg(plan);
            continue;
        }
        make_next_leg(plan, leg);
        advance(plan, leg);
        if (motion_leg_pulses(leg) > 0) {
            return true;
        }
    }
    return false;
}

/* Whether the order's last section of several begins with a leg that has pulses: no such leg of
 * another begins there. A stop brakes into that section, too. */
static bool is_mark(const struct motion_plan *plan, const struct motion_leg *leg)
{
    return plan->mark_step > 0 && leg->from.step == plan->mark_step;
}

static void make_segment(const struct motion_plan *plan, const struct motion_leg *leg, struct step_segment *segment)
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
        make_segment(plan, &leg, segment);
    }
    return taken;
}
