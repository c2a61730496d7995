#include "hal_step.h"

#include "stm32_step_private.h"

struct stm32_step stm32_step;
uint32_t stm32_late_steps;

/* On a board of short pulses the code of the long ones goes away. */
#define PULSES_ARE_LONG (HIGH_TICKS > SPIN_TICKS)

/* The tick for an edge, `now` being the time of a moment ago: one that leaves the driver too little low time, or is
 * past, is late and made as soon as may be. */
static uint32_t made_good(uint32_t tick, uint32_t now)
{
    if ((int32_t)(tick - now) >= (int32_t)ROOM_TICKS) {
        return tick;
    }
    stm32_late_steps++;
    return now + (uint32_t)ROOM_TICKS;
}

/* Whether the counter wraps before the pulse of an edge to come has been high long enough. */
static inline bool ends_after_wrap(uint32_t edge, uint32_t now)
{
    return edge + (uint32_t)HIGH_TICKS <= now;
}

/* Puts the pin low and arms the next edge, whatever the channel did before. A late edge is not where the client has it,
 * one after the counter's wrap is no matter of being above it, and one right before it would be cut short there. */
static void arm(unsigned motor, uint32_t tick)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    uint32_t flag = flag_of(motor);
    uint32_t now = TIM2_CNT;
    uint32_t edge = made_good(tick, now);
    bool plain = !PULSES_ARE_LONG && edge == tick && !ends_after_wrap(edge, now);
    set_mode(channel, MODE_LOW);
    *channel->compare = edge;
    stm32_step.edge[motor] = edge;
    set_enabled(plain ? stm32_step.plain | flag : stm32_step.plain & ~flag,
                plain ? stm32_step.special & ~flag : stm32_step.special | flag);
    set_mode(channel, armed_mode(motor));
}

static void rest(unsigned motor, uint32_t edge)
{
    uint32_t others = ~flag_of(motor);
    set_mode(&stm32_step.channel[motor], MODE_LOW);
    set_enabled(stm32_step.plain & others, stm32_step.special & others);
    stm32_step.edge[motor] = edge;
}

/* What follows the pulse at `edge`. */
__attribute__((noinline)) static void follow(unsigned motor, uint32_t edge, unsigned next)
{
    if ((next & STEP_CHANNEL_ARM) != 0) {
        arm(motor, stm32_step.client[motor]->cursor.generator.tick);
    } else {
        rest(motor, edge);
    }
}

/* The time, once a pulse has been high long enough. */
static inline uint32_t wait_out(uint32_t edge)
{
    uint32_t now = TIM2_CNT;
    while (BASE_SELDOM(now - edge < (uint32_t)HIGH_TICKS)) {
        now = TIM2_CNT;
    }
    return now;
}

/* Has the channel end the pulse, which is none if the pin is disconnected. There are SPIN_TICKS at least until then. */
static void fall_later(unsigned motor, unsigned next)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    *channel->compare = stm32_step.edge[motor] + (uint32_t)HIGH_TICKS;
    set_mode(channel, MODE_FALL);
    stm32_step.falling |= flag_of(motor);
    stm32_step.waiting |= (next & STEP_CHANNEL_ARM) != 0 ? flag_of(motor) : 0U;
}

static void serve_fall(unsigned motor)
{
    unsigned next = (stm32_step.waiting & flag_of(motor)) != 0 ? STEP_CHANNEL_ARM : 0U;
    stm32_step.falling &= ~flag_of(motor);
    stm32_step.waiting &= ~flag_of(motor);
    follow(motor, stm32_step.edge[motor], next);
}

static void serve_special(unsigned motor)
{
    uint32_t edge = stm32_step.edge[motor];
    if (PULSES_ARE_LONG && (stm32_step.falling & flag_of(motor)) != 0) {
        serve_fall(motor);
        return;
    }
    unsigned next = step_channel_next(stm32_step.client[motor]);
    if ((next & STEP_CHANNEL_WAKE) != 0) {
        stm32_event = true;
    }
    if (PULSES_ARE_LONG && TIM2_CNT - edge < (uint32_t)(HIGH_TICKS - SPIN_TICKS)) {
        fall_later(motor, next);
        return;
    }
    (void)wait_out(edge);
    follow(motor, edge, next);
}

__attribute__((noinline)) static void serve_specials(void)
{
    uint32_t due = TIM2_SR & stm32_step.special;
    TIM2_SR = ~due;
    for (; due != 0; due &= due - 1U) {
        serve_special((unsigned)__builtin_ctz(due) - 1U);
    }
}

/* Whether it takes more than a write of the compare value to arm the next edge: at the counter's wrap or after it, or
 * late. */
static inline bool needs_care(uint32_t tick, uint32_t now)
{
    return BASE_SELDOM(ends_after_wrap(tick, now)) || BASE_SELDOM((int32_t)(tick - now) < (int32_t)MOVE_TICKS);
}

/* Where a segment ends, and perhaps the move. */
__attribute__((noinline)) static void serve_border(unsigned motor)
{
    struct step_channel *client = stm32_step.client[motor];
    uint32_t edge = client->cursor.generator.tick;
    unsigned next = step_channel_next_segment(client);
    uint32_t tick = client->cursor.generator.tick;
    uint32_t now = wait_out(edge);
    if ((next & STEP_CHANNEL_ARM) == 0 || needs_care(tick, now)) {
        follow(motor, edge, next);
    } else {
        (&TIM2_CCR1)[motor] = tick;
    }
    stm32_event = true;
}

static inline void serve_plain(unsigned motor)
{
    struct step_channel *client = stm32_step.client[motor];
    uint32_t edge = client->cursor.generator.tick;
    if (BASE_SELDOM(client->cursor.left == 0)) {
        serve_border(motor);
        return;
    }
    unsigned next = step_channel_next(client);
    uint32_t tick = client->cursor.generator.tick;
    if (needs_care(tick, wait_out(edge))) {
        follow(motor, edge, next);
    } else {
        (&TIM2_CCR1)[motor] = tick;
    }
}

/* A special channel whose edge comes together with plain ones is served after them: its flag calls once more. */
void stm32_step_interrupt(void)
{
    uint32_t due = TIM2_SR & stm32_step.plain;
    if (BASE_SELDOM(due == 0)) {
        serve_specials();
        return;
    }
    TIM2_SR = ~due;
    do {
        serve_plain((unsigned)__builtin_ctz(due) - 1U);
        due &= due - 1U;
    } while (BASE_SELDOM(due != 0));
}

/* Only from main, where the channel rests, or the pulse before is still being ended. The flag of a compare value long
 * past goes away after the new value, whose own match is ROOM_TICKS off at least. */
void hal_step_arm(unsigned motor, uint32_t tick)
{
    uint32_t mask = stm32_mask();
    if ((stm32_step.falling & flag_of(motor)) != 0) {
        stm32_step.waiting |= flag_of(motor);
    } else {
        arm(motor, tick);
        TIM2_SR = ~flag_of(motor);
    }
    stm32_unmask(mask);
}

/* A match less than WRITE_TICKS ahead counts as made: nothing may cut its pulse short. The pulse before may have been
 * made just now. */
bool hal_step_disarm(unsigned motor)
{
    uint32_t flag = flag_of(motor);
    bool taken = false;
    uint32_t mask = stm32_mask();
    if ((stm32_step.falling & flag) != 0) {
        taken = (stm32_step.waiting & flag) != 0;
        stm32_step.waiting &= ~flag;
    } else if ((enabled() & flag) != 0) {
        uint32_t now = TIM2_CNT;
        taken = (int32_t)(edge_of(motor) - now) > (int32_t)WRITE_TICKS;
        if (taken) {
            rest(motor, now);
        }
    }
    stm32_unmask(mask);
    return taken;
}

uint32_t hal_step_lead_ticks(void)
{
    return LEAD_TICKS;
}

void hal_step_hold(void)
{
    __asm__ volatile("cpsid i" ::: "memory");
}

void hal_step_release(void)
{
    __asm__ volatile("cpsie i" ::: "memory");
}
