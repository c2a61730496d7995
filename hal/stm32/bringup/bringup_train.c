#include "base_limits.h"
#include "bringup.h"
#include "hal_step.h"

/* The step interrupt lays them. */
static struct train {
    uint32_t next_tick;
    uint32_t laid;
    uint32_t count;
    uint32_t (*interval_ticks)(uint32_t pulse);
} trains[UNIT_MOTORS];

unsigned bringup_train_lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    struct train *train = &trains[motor];
    unsigned count = 0;
    (void)context;
    while (count < room->count && train->laid < train->count &&
           (count == 0 || (int32_t)(train->next_tick - room->until_tick) < 0)) {
        room->pulse[count] = (struct hal_step_pulse){train->next_tick, train->next_tick + room->high_ticks};
        train->next_tick += train->interval_ticks(train->laid);
        train->laid++;
        count++;
    }
    return count;
}

void bringup_train_begin(unsigned motor, uint32_t first_tick, uint32_t count, uint32_t (*interval_ticks)(uint32_t))
{
    trains[motor] = (struct train){.next_tick = first_tick, .count = count, .interval_ticks = interval_ticks};
    hal_step_run(motor);
}

uint32_t bringup_train_count_made(unsigned motor)
{
    hal_step_hold();
    uint32_t made = trains[motor].laid - hal_step_waiting(motor);
    hal_step_release();
    return made;
}
