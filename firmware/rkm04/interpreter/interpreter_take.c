#include "interpreter_private.h"

/* Whether nothing is left to be done, if main has seen it or not. */
static bool is_at_rest(const struct interpreter *interpreter, uint64_t now_ticks)
{
    return interpreter_is(interpreter, INTERPRETER_SETTLES) && interpreter->clock <= now_ticks &&
           interpreter_has_run_all(interpreter);
}

/* K: the motor stops, and with it the program, also one that waits for the stand after `\`. A motor at rest has nothing
 * to stop. */
static void take_halt(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (interpreter->state == INTERPRETER_RESUMING) {
        interpreter->state = INTERPRETER_STOPPED;
    }
    if (!interpreter_is(interpreter, INTERPRETER_TAKES_K)) {
        return;
    }
    if (interpreter->state == INTERPRETER_RESETTING) {
        axis_forget(interpreter->axis); /* only what was stored after `\` goes on */
    }
    if (!is_at_rest(interpreter, now_ticks)) {
        interpreter->wait.left_ticks = interpreter->clock > now_ticks ? interpreter->clock - now_ticks : 0;
        interpreter_stop(interpreter, AXIS_CAUSE_PAUSE, now_ticks);
        interpreter->resume_state = interpreter->state;
        interpreter->state = INTERPRETER_STOPPED;
    }
}

/* C75: goes on where K has stopped, as soon as the motor stands. */
static void take_resume(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (interpreter->state != INTERPRETER_STOPPED) {
        return;
    }
    if (axis_is_busy(interpreter->axis)) {
        interpreter->state = INTERPRETER_RESUMING;
    } else {
        interpreter_continue(interpreter, now_ticks);
    }
}

/* V while the motor moves. False: there is no move of this program, the command is to be stored. */
static bool take_speed(struct interpreter *interpreter, uint32_t speed_steps_per_s)
{
    bool ours = interpreter->state == INTERPRETER_MOVING || interpreter_is(interpreter, INTERPRETER_PAUSED);
    if (!axis_is_busy(interpreter->axis) || !ours) {
        return false;
    }
    axis_change_speed(interpreter->axis, speed_steps_per_s);
    return true;
}

/* The only command of a message; false if it is one to be stored. */
static bool take_alone(struct interpreter *interpreter, const struct program_instruction *instruction,
                       uint64_t now_ticks)
{
    if (instruction->opcode == PROGRAM_HALT) {
        take_halt(interpreter, now_ticks);
        return true;
    }
    if (instruction->opcode == PROGRAM_RESUME) {
        take_resume(interpreter, now_ticks);
        return true;
    }
    return instruction->opcode == PROGRAM_SPEED && take_speed(interpreter, (uint32_t)instruction->value);
}

/* `\`: what was is forgotten at once; what follows it waits until the motor stands. */
static void take_reset(struct interpreter *interpreter, uint64_t now_ticks)
{
    bool moves = axis_is_busy(interpreter->axis) && interpreter->state != INTERPRETER_RESETTING;
    if (moves || interpreter_is(interpreter, INTERPRETER_RUNS)) {
        interpreter_stop(interpreter, AXIS_CAUSE_COMMAND, now_ticks);
    }
    interpreter_clear(interpreter);
    interpreter->state = axis_is_busy(interpreter->axis) ? INTERPRETER_RESETTING : INTERPRETER_IDLE;
    interpreter->clock = now_ticks;
}

/* False: the memory was full. */
static bool take_command(struct interpreter *interpreter, const struct program_instruction *instruction,
                         uint64_t now_ticks)
{
    if (instruction->opcode == PROGRAM_HALT || instruction->opcode == PROGRAM_RESUME) {
        return true;
    }
    if (instruction->opcode == PROGRAM_RELEASE) {
        interpreter->release_tick = now_ticks;
    }
    return program_memory_append(&interpreter->memory, instruction, interpreter->shared->memory_locked);
}

/* Stores the commands up to the end or the first error, and returns which of them it was. */
static enum program_status take_program(struct interpreter *interpreter, const uint8_t *text, uint32_t length,
                                        uint64_t now_ticks, bool *overflow)
{
    struct program_parser parser;
    struct program_instruction instruction;

    *overflow = false;
    program_parser_init(&parser, text, length);
    enum program_status status = program_parser_next(&parser, &instruction);
    while (status == PROGRAM_OK) {
        if (instruction.opcode == PROGRAM_RESET) {
            take_reset(interpreter, now_ticks);
            *overflow = false;
        } else if (!take_command(interpreter, &instruction, now_ticks)) {
            *overflow = true;
        }
        status = program_parser_next(&parser, &instruction);
    }
    return status;
}

bool interpreter_load(struct interpreter *interpreter, const uint8_t *text, uint32_t length, uint64_t now_ticks)
{
    bool overflow;
    if (take_program(interpreter, text, length, now_ticks, &overflow) != PROGRAM_END) {
        interpreter_clear(interpreter);
        return false;
    }
    interpreter_raise_clock(interpreter, now_ticks);
    return true;
}

/* Whether K has stopped, or is stopping, a run without end after which nothing was stored: a jog. A guard may have
 * begun to stop it before. */
static bool is_jog_stopped(const struct interpreter *interpreter)
{
    bool in_move = interpreter->resume_state == INTERPRETER_MOVING || interpreter->resume_state == INTERPRETER_RUNNING;
    return interpreter_is(interpreter, INTERPRETER_PAUSED) && in_move && axis_is_jog(interpreter->axis) &&
           interpreter_has_run_all(interpreter);
}

/* Nothing of the run is left to go on with; what has been stored after it follows when the motor stands. */
static void end_jog(struct interpreter *interpreter)
{
    axis_forget(interpreter->axis);
    interpreter->state = axis_is_busy(interpreter->axis) ? INTERPRETER_MOVING : INTERPRETER_RUNNING;
}

bool interpreter_take(struct interpreter *interpreter, const uint8_t *text, uint32_t length,
                      const struct program_summary *summary, uint64_t now_ticks)
{
    bool overflow;

    interpreter_watch_move(interpreter, now_ticks);
    if (summary->commands == 1 && take_alone(interpreter, &summary->first, now_ticks)) {
        return false;
    }
    bool jog_stopped = is_jog_stopped(interpreter);
    (void)take_program(interpreter, text, length, now_ticks, &overflow);
    if (jog_stopped && interpreter_is(interpreter, INTERPRETER_PAUSED) && !interpreter_has_run_all(interpreter)) {
        end_jog(interpreter);
        interpreter_raise_clock(interpreter, now_ticks);
    }
    if (interpreter->state == INTERPRETER_IDLE) {
        interpreter_raise_clock(interpreter, now_ticks);
    }
    return overflow;
}
