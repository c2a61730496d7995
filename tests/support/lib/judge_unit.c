#include "judge_unit.h"

void judge_unit_begin(struct judged_unit *judged, uint64_t epoch)
{
    const struct judge_limits limits = judge_default_limits();
    judge_init(judged->judge, &limits);
    host_machine_init(judged->machine, epoch);
    host_machine_select(judged->machine);
    judged->machine->listener = (struct host_listener){
        .context = judged,
        .step = judge_unit_step,
        .simulated = judge_unit_step,
        .connection = judge_unit_connection,
        .direction = judge_unit_direction,
        .trace = judge_unit_trace,
    };
}

void judge_unit_step(void *judged, uint64_t tick, unsigned motor, bool backward)
{
    struct judged_unit *self = judged;
    judge_pulse(self->judge, tick, motor + 1U, backward);
}

void judge_unit_connection(void *judged, uint64_t tick, unsigned motor, bool connected)
{
    struct judged_unit *self = judged;
    judge_connect(self->judge, tick, motor + 1U, connected);
}

void judge_unit_direction(void *judged, uint64_t tick, unsigned motor, bool backward)
{
    struct judged_unit *self = judged;
    judge_direction(self->judge, tick, motor + 1U, backward);
}

void judge_unit_trace(void *judged, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    struct judged_unit *self = judged;
    struct rkm04 *unit = self->unit;
    if (event == HAL_TRACE_DONE) { /* before the program can write the counter */
        judge_position(self->judge, motor, axis_position_steps(&unit->axis[motor - 1U]));
    }
    judge_event(self->judge, tick, motor, event, value);
    if (event == HAL_TRACE_MOVE) {
        judge_order(self->judge, motor, &unit->axis[motor - 1U].order, axis_position_steps(&unit->axis[motor - 1U]));
    }
}

uint64_t judge_unit_pass(void *judged)
{
    struct judged_unit *self = judged;
    uint64_t wake = rkm04_poll(self->unit);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        judge_position(self->judge, i + 1U, axis_position_steps(&self->unit->axis[i]));
        judge_interpreter(self->judge, i + 1U, &self->unit->interpreter[i]);
    }
    judge_pass(self->judge);
    return wake;
}

uint32_t judge_unit_end(struct judged_unit *judged, uint64_t tick, FILE *file, const char *mark)
{
    char text[JUDGE_TEXT_BYTES + 32];
    struct judge *judge = judged->judge;
    judge_flash(judge, judged->machine->flash_rewrites);
    judge_finish(judge, tick);
    for (uint32_t i = 0; i < judge->complaints; i++) {
        judge_tell(judge, i, text);
        (void)fprintf(file, "%s%s\n", mark, text);
    }
    return judge->complaints;
}
