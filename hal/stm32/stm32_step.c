#include "hal_step.h"

#include "stm32_step_private.h"

struct stm32_step stm32_step;
uint32_t stm32_late_steps;

/* On a board of short pulses the code of the long ones goes away. */
#define PULSES_ARE_LONG (HIGH_TICKS > SPIN_TICKS)

/* The tick for an edge, `now` being the time of a moment ago: one that leaves the driver too little low time, or is
 * past, is late and made as soon as may be. */
static inline uint32_t made_good(uint32_t tick, uint32_t now)
{
    if ((int32_t)(tick - now) >= (int32_t)ROOM_TICKS) {
        return tick;
    }
    stm32_late_steps++;
    return now + (uint32_t)ROOM_TICKS;
}

/* Puts the pin low and arms the next edge, whatever the channel did before. */
static void arm(struct stm32_channel *channel)
{
    channel->edge = made_good(channel->next, TIM2_CNT);
    set_mode(channel, MODE_LOW);
    *channel->compare = channel->edge;
    set_mode(channel, armed_mode());
}

/* The same behind an edge, as fast as can be: the mode was and will be that of an armed channel. */
static inline void arm_again(struct stm32_channel *channel, uint32_t now)
{
    uint32_t tick = made_good(channel->next, now);
    uint32_t modes = *channel->modes;
    *channel->mode = modes ^ channel->lower;
    *channel->compare = tick;
    *channel->mode = modes;
    channel->edge = tick;
}

static void rest(unsigned motor)
{
    set_mode(&stm32_step.channel[motor], MODE_LOW);
    set_enabled(stm32_step.enabled & ~flag_of(motor));
}

/* Has the channel end the pulse. There are SPIN_TICKS at least until then. */
static void fall_later(unsigned motor)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    *channel->compare = channel->edge + (uint32_t)HIGH_TICKS;
    set_mode(channel, stm32_step.connected ? MODE_FALL : MODE_LOW);
    stm32_step.falling |= flag_of(motor);
    stm32_step.waiting |= stm32_step.asked ? flag_of(motor) : 0U;
}

static inline void serve_edge(unsigned motor)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    stm32_step.asked = false;
    if (stm32_step.client.step_isr(stm32_step.client.context, motor)) {
        stm32_event_set();
    }
    uint32_t now = TIM2_CNT;
    while (now - channel->edge < (uint32_t)HIGH_TICKS) {
        if (PULSES_ARE_LONG && now - channel->edge < (uint32_t)(HIGH_TICKS - SPIN_TICKS)) {
            fall_later(motor);
            return;
        }
        now = TIM2_CNT;
    }
    if (stm32_step.asked) {
        arm_again(channel, now);
    } else {
        rest(motor);
    }
}

static void serve_fall(unsigned motor)
{
    bool asked = (stm32_step.waiting & flag_of(motor)) != 0;
    stm32_step.falling &= ~flag_of(motor);
    stm32_step.waiting &= ~flag_of(motor);
    if (asked) {
        arm(&stm32_step.channel[motor]);
    } else {
        rest(motor);
    }
}

void stm32_step_interrupt(void)
{
    uint32_t due = TIM2_SR & stm32_step.enabled;
    TIM2_SR = ~due;
    stm32_step.serving = true;
    while (due != 0) {
        unsigned motor = (unsigned)__builtin_ctz(due) - 1U;
        due &= due - 1U;
        if (PULSES_ARE_LONG && (stm32_step.falling & flag_of(motor)) != 0) {
            serve_fall(motor);
        } else {
            serve_edge(motor);
        }
    }
    stm32_step.serving = false;
}

/* From main the channel rests, or the pulse before is still being ended. The flag of a compare value long past goes
 * away behind the new value, whose own match is ROOM_TICKS off at least. */
void hal_step_arm(unsigned motor, uint32_t tick)
{
    stm32_step.channel[motor].next = tick;
    if (stm32_step.serving) {
        stm32_step.asked = true;
        return;
    }
    uint32_t mask = stm32_mask();
    if ((stm32_step.falling & flag_of(motor)) != 0) {
        stm32_step.waiting |= flag_of(motor);
    } else {
        arm(&stm32_step.channel[motor]);
        TIM2_SR = ~flag_of(motor);
        set_enabled(stm32_step.enabled | flag_of(motor));
    }
    stm32_unmask(mask);
}

/* A match less than WRITE_TICKS ahead counts as made: nothing may cut its pulse short. */
bool hal_step_disarm(unsigned motor)
{
    uint32_t flag = flag_of(motor);
    bool taken = false;
    uint32_t mask = stm32_mask();
    if ((stm32_step.falling & flag) != 0) {
        taken = (stm32_step.waiting & flag) != 0;
        stm32_step.waiting &= ~flag;
    } else if ((stm32_step.enabled & flag) != 0) {
        taken = (int32_t)(stm32_step.channel[motor].edge - TIM2_CNT) > (int32_t)WRITE_TICKS;
        if (taken) {
            rest(motor);
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
