#include "judge_curve.h"

#include <math.h>

#include "base_tick.h"

/* What is left of a section: up to position `end`. */
struct stretch {
    int64_t end;
    int64_t top;   /* w */
    int64_t bound; /* the greatest w at its end from which all after it can be kept */
    int64_t accel;
};

struct stretches {
    struct stretch stretch[MOTION_SECTIONS];
    unsigned count;
};

static int64_t square(uint32_t speed)
{
    return (int64_t)speed * speed;
}

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t slow_w(const struct judge_curve *curve)
{
    return square(curve->order.start_speed_steps_per_s);
}

/* The sections after a position, with the look-ahead of the table in motion.md: backward from the last one. */
static struct stretches lay_stretches(const struct judge_curve *curve, int64_t position)
{
    struct stretches all = {.count = 0};
    int64_t end = 0;
    for (unsigned i = 0; i < curve->order.sections; i++) {
        const struct motion_section *section = &curve->order.section[i];
        end += (int64_t)section->steps;
        if (end > position) {
            all.stretch[all.count++] = (struct stretch){
                .end = end, .top = square(section->speed_steps_per_s), .accel = section->accel_steps_per_s2};
        }
    }
    for (unsigned i = all.count; i-- > 0;) {
        struct stretch *stretch = &all.stretch[i];
        if (i + 1U == all.count) {
            stretch->bound = least(slow_w(curve), stretch->top);
        } else {
            const struct stretch *after = stretch + 1;
            int64_t brakeable = after->bound + 2 * after->accel * (after->end - stretch->end);
            stretch->bound = least(least(stretch->top, after->top), brakeable);
        }
    }
    return all;
}

static long double ticks_between(const struct judge_leg *leg, long double from, long double to)
{
    if (leg->accel == 0.0L) {
        return (to - from) * (long double)TICK_HZ / sqrtl(leg->anchor_w);
    }
    long double before = leg->anchor_w + 2.0L * leg->accel * (from - leg->anchor);
    long double after = leg->anchor_w + 2.0L * leg->accel * (to - leg->anchor);
    return (sqrtl(after) - sqrtl(before)) * (long double)TICK_HZ / leg->accel;
}

static long double leg_w(const struct judge_leg *leg, long double position)
{
    return leg->anchor_w + 2.0L * leg->accel * (position - leg->anchor);
}

static void add_leg(struct judge_curve *curve, struct judge_leg leg)
{
    if (leg.to <= leg.from) {
        return;
    }
    if (curve->count > 0) {
        const struct judge_leg *before = &curve->legs[curve->count - 1U];
        leg.start = before->start + ticks_between(before, before->from, before->to);
    }
    long double from_w = leg_w(&leg, leg.from);
    long double to_w = leg_w(&leg, leg.to);
    curve->most_w = fmaxl(curve->most_w, fmaxl(from_w, to_w));
    curve->least_w = fminl(curve->least_w, fminl(from_w, to_w));
    curve->legs[curve->count++] = leg;
}

/* Up, cruise and down to the end of a stretch; w at its end. */
static int64_t add_trapezoid(struct judge_curve *curve, long double at, long double w, const struct stretch *stretch)
{
    long double end = (long double)stretch->end;
    long double accel = (long double)stretch->accel;
    long double gain = 2.0L * accel * (end - at);
    int64_t end_w = least(stretch->bound, llroundl(w + gain));
    long double peak = fminl((long double)stretch->top, (w + (long double)end_w + gain) / 2.0L);
    long double up = at + (peak - w) / (2.0L * accel);
    long double down = end - (peak - (long double)end_w) / (2.0L * accel);
    add_leg(curve, (struct judge_leg){.from = at, .to = up, .anchor = at, .anchor_w = w, .accel = accel});
    add_leg(curve, (struct judge_leg){.from = up, .to = down, .anchor = up, .anchor_w = peak});
    add_leg(curve,
            (struct judge_leg){
                .from = fmaxl(up, down), .to = end, .anchor = end, .anchor_w = (long double)end_w, .accel = -accel});
    return end_w;
}

/* Brakes where the speed is above that of the stretch; a speed below S is taken at once where S is reached. Returns
 * where the motor is then. */
static long double add_braking(struct judge_curve *curve, int64_t at, int64_t *w, const struct stretch *stretch)
{
    if (*w <= stretch->top) {
        return (long double)at;
    }
    int64_t slow = stretch->top > slow_w(curve) ? stretch->top : slow_w(curve);
    int64_t way_w = 2 * stretch->accel * (stretch->end - at);
    bool reached = *w - slow <= way_w;
    long double accel = (long double)stretch->accel;
    long double knee = (long double)at + (long double)(*w - slow) / (2.0L * accel);
    struct judge_leg leg = {.from = (long double)at, .to = knee, .anchor = knee, .anchor_w = (long double)slow};
    leg.accel = -accel;
    if (!reached) {
        leg.to = (long double)stretch->end;
        leg.anchor = leg.to;
        leg.anchor_w = (long double)(*w - way_w);
    }
    add_leg(curve, leg);
    *w = reached ? stretch->top : *w - way_w;
    return leg.to;
}

static void begin_legs(struct judge_curve *curve)
{
    curve->count = 0;
    curve->present = 0;
    curve->most_w = 0.0L;
    curve->least_w = (long double)INFINITY;
}

/* A start or a change: speeds up to S need no ramp, but no more than can be braked from. */
static int64_t taken_at_once(const struct judge_curve *curve, int64_t at, int64_t w, const struct stretch *stretch)
{
    int64_t slow = slow_w(curve);
    int64_t step = least(slow, stretch->top);
    if (w < step) {
        return least(step, stretch->bound + 2 * stretch->accel * (stretch->end - at));
    }
    return stretch->top < w && w <= slow ? stretch->top : w;
}

/* All legs after a pulse at which the motor has w. */
static void lay(struct judge_curve *curve, uint64_t pulse, int64_t w, long double tick)
{
    int64_t at = (int64_t)pulse;
    struct stretches all = lay_stretches(curve, at);
    begin_legs(curve);
    w = taken_at_once(curve, at, w, &all.stretch[0]);
    for (unsigned i = 0; i < all.count; i++) {
        const struct stretch *stretch = &all.stretch[i];
        long double from = add_braking(curve, at, &w, stretch);
        if (from < (long double)stretch->end) {
            w = add_trapezoid(curve, from, (long double)w, stretch);
        }
        at = stretch->end;
    }
    for (unsigned i = 0; i < curve->count; i++) {
        curve->legs[i].start += tick;
    }
    curve->last = motion_order_is_endless(&curve->order) ? UINT64_MAX : (uint64_t)at;
}

void judge_curve_begin(struct judge_curve *curve, const struct motion_order *order)
{
    curve->order = *order;
    curve->fixed = false;
    lay(curve, 0, 0, 0.0L);
}

const struct judge_leg *judge_curve_leg(struct judge_curve *curve, uint64_t pulse)
{
    while (curve->present + 1U < curve->count && curve->legs[curve->present].to < (long double)pulse) {
        curve->present++;
    }
    return &curve->legs[curve->present];
}

long double judge_curve_tick(struct judge_curve *curve, uint64_t pulse)
{
    const struct judge_leg *leg = judge_curve_leg(curve, pulse);
    return leg->start + ticks_between(leg, leg->from, (long double)pulse);
}

/* w at a pulse, after the jump where it jumps. */
static int64_t pulse_w(struct judge_curve *curve, uint64_t pulse)
{
    const struct judge_leg *leg = judge_curve_leg(curve, pulse);
    bool border = leg->to <= (long double)pulse && leg != &curve->legs[curve->count - 1U];
    return llroundl(leg_w(border ? leg + 1 : leg, (long double)pulse));
}

void judge_curve_stop(struct judge_curve *curve, uint64_t pulse)
{
    if (curve->fixed || pulse > curve->last) {
        return;
    }
    int64_t w = pulse_w(curve, pulse);
    long double tick = judge_curve_tick(curve, pulse);
    int64_t at = (int64_t)pulse;
    struct stretches all = lay_stretches(curve, at);
    int64_t slow = slow_w(curve);
    long double most_w = curve->most_w;
    long double least_w = curve->least_w;
    begin_legs(curve);
    /* The pulse itself is on the new curve, too. */
    add_leg(curve, (struct judge_leg){
                       .from = (long double)at - 1.0L,
                       .to = (long double)at,
                       .anchor_w = (long double)(w > 0 ? w : 1),
                   });
    curve->legs[0].start = tick - ticks_between(&curve->legs[0], curve->legs[0].from, curve->legs[0].to);
    curve->last = pulse;
    for (unsigned i = 0; i < all.count && w > slow; i++) {
        const struct stretch *stretch = &all.stretch[i];
        int64_t way_w = 2 * stretch->accel * (stretch->end - at);
        bool through = w - slow >= way_w;
        int64_t steps = through ? stretch->end - at : (w - slow) / (2 * stretch->accel);
        int64_t end_w = w - 2 * stretch->accel * steps;
        add_leg(curve, (struct judge_leg){.from = (long double)at,
                                          .to = (long double)(at + steps),
                                          .anchor = (long double)(at + steps),
                                          .anchor_w = (long double)end_w,
                                          .accel = -(long double)stretch->accel});
        at += steps;
        curve->last = (uint64_t)at;
        w = through ? end_w : slow;
    }
    curve->most_w = fmaxl(curve->most_w, most_w);
    curve->least_w = fminl(curve->least_w, least_w);
    curve->fixed = true;
}

void judge_curve_halt(struct judge_curve *curve, uint64_t pulse)
{
    if (!curve->fixed) {
        curve->last = pulse;
        curve->fixed = true;
    }
}

void judge_curve_change_speed(struct judge_curve *curve, uint64_t pulse, uint32_t speed_steps_per_s)
{
    if (curve->fixed || pulse >= curve->last) {
        return;
    }
    int64_t w = pulse_w(curve, pulse);
    long double tick = judge_curve_tick(curve, pulse);
    long double most_w = curve->most_w;
    long double least_w = curve->least_w;
    uint64_t end = 0;
    unsigned section = 0;
    while (end + curve->order.section[section].steps <= pulse) {
        end += curve->order.section[section++].steps;
    }
    curve->order.section[section].speed_steps_per_s = speed_steps_per_s;
    lay(curve, pulse, w, tick);
    /* The interval that ends with the pulse is of the curve before. */
    curve->most_w = fmaxl(curve->most_w, most_w);
    curve->least_w = fminl(curve->least_w, least_w);
}

long double judge_curve_stoppable_w(const struct judge_curve *curve, uint64_t pulse)
{
    long double w = (long double)slow_w(curve);
    uint64_t begin = 0;
    for (unsigned i = 0; i < curve->order.sections; i++) {
        const struct motion_section *section = &curve->order.section[i];
        uint64_t end = begin + section->steps;
        if (end > pulse) {
            w += 2.0L * (long double)section->accel_steps_per_s2 * (long double)(end - (pulse > begin ? pulse : begin));
        }
        begin = end;
    }
    return w;
}
