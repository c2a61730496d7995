#include "judge_unit.h"

void judge_unit_step(struct judge *judge, uint64_t tick, unsigned motor, bool backward)
{
    judge_pulse(judge, tick, motor + 1U, backward);
}

/* T41 takes DIR from its pins and gives it back: those are edges, too. */
void judge_unit_direction(struct judge *judge, const struct unit *unit, uint64_t tick, unsigned motor, bool backward)
{
    if (unit->io.simulating) {
        judge_hide(judge);
    }
    judge_direction(judge, tick, motor + 1U, backward);
}

void judge_unit_trace(struct judge *judge, const struct unit *unit, uint64_t tick, unsigned motor,
                      enum hal_trace_event event, int64_t value)
{
    if (event == HAL_TRACE_DONE) { /* before the program can write the counter */
        judge_position(judge, motor, mover_position_steps(&unit->mover[motor - 1U]));
    }
    judge_event(judge, tick, motor, event, value);
    if (event == HAL_TRACE_MOVE) {
        judge_order(judge, motor, &unit->interpreter[motor - 1U].order, mover_position_steps(&unit->mover[motor - 1U]));
    }
}

void judge_unit_pass(struct judge *judge, const struct unit *unit)
{
    if (unit->io.simulating) {
        judge_hide(judge);
    }
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        judge_position(judge, i + 1U, mover_position_steps(&unit->mover[i]));
        judge_interpreter(judge, i + 1U, &unit->interpreter[i]);
    }
    judge_pass(judge);
}
