#include <stddef.h>

#include "base_limits.h"
#include "base_tick.h"
#include "board.h"
#include "bringup.h"
#include "hal_board.h"
#include "hal_time.h"
#include "stm32_step_times.h"
#include "stm32f4.h"

#ifdef BOARD_STEP_CLASS
#define HAS_STREAMS false
#else
#define HAS_STREAMS true
#endif

/*
 * Pulses of all motors at the same ticks, as narrow and as near as the board has them: four streams of one controller
 * are asked at once for each edge, and each must have been to memory and to the timer before the next one. Nothing on a
 * part is nearer to its limit. Main looks at the timer all the time, so that the streams wait for that bus as well.
 * Where an edge comes too late, the driver of the steps stops the outputs and resets the part.
 */
enum {
    BURSTS = 200,
    PULSES = 24,
    PERIOD_TICKS = HIGH_TICKS + LOW_TICKS,
    LEAD_TICKS = TICKS_PER_MS,
    REST_TICKS = TICKS_PER_MS,
};

static uint32_t interval_ticks(uint32_t pulse)
{
    (void)pulse;
    return PERIOD_TICKS;
}

/* One look at the timer after the other, without a pause. */
static void use_bus(void)
{
    uint32_t count = 0;
    __asm__ volatile(".rept 50\n\tldr %0, [%1]\n\t.endr" : "=&r"(count) : "r"(&TIM2_CNT));
    (void)count;
}

static void make_burst(void)
{
    hal_step_hold();
    uint64_t first = hal_time_now() + (uint64_t)LEAD_TICKS;
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        bringup_train_begin(motor, (uint32_t)first, (uint32_t)PULSES, interval_ticks);
    }
    hal_step_release();
    uint32_t end = (uint32_t)first + (uint32_t)(PULSES * PERIOD_TICKS + REST_TICKS);
    while ((int32_t)(TIM2_CNT - end) < 0) {
        use_bus();
    }
}

const char *bringup_together_tell(void)
{
    if (!HAS_STREAMS) {
        return "class_2";
    }
    if (!hal_board_may_move()) {
        return "no_crystal";
    }
    uint32_t made[UNIT_MOTORS] = {0};
    uint32_t late = hal_board_late_steps();
    for (unsigned i = 0; i < (unsigned)BURSTS; i++) {
        make_burst();
        for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
            made[motor] += bringup_train_count_made(motor);
        }
    }
    say_number("wanted", (uint32_t)(BURSTS * PULSES));
    say_name("made");
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        say_decimal(made[motor]);
    }
    say_line_end();
    say_number("late", hal_board_late_steps() - late);
    say_number("period_ticks", PERIOD_TICKS);
    say_number("tick_hz", TICK_HZ);
    return NULL;
}
