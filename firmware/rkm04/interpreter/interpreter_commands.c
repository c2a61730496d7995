#include "interpreter_private.h"

#include <assert.h>

#include "hal_trace.h"

/* Numbers of functions that T and C switch. */
enum {
    FUNCTION_MEMORY_LOCK = 40,
    FUNCTION_SIMULATION = 41,
    FUNCTION_MARK_FIRST = 51,
    FUNCTION_MARK_LAST = 58,
};

static_assert(FUNCTION_MARK_LAST - FUNCTION_MARK_FIRST + 1 == UNIT_OUTPUTS, "one function for each output");

static uint8_t input_mask(uint32_t number)
{
    return (uint8_t)(1U << (number - 1U));
}

/* The next moves go forward or backward by so many steps; a compound move that has been run is forgotten. */
static void run_steps(struct interpreter *interpreter, uint32_t steps, bool backward)
{
    interpreter->order.steps = steps;
    interpreter->order.backward = backward;
    if (interpreter->compound.done) {
        interpreter->compound.order.sections = 0;
        interpreter->compound.done = false;
    }
}

/* Turns the next moves round, a compound move too. */
static void run_reverse(struct interpreter *interpreter)
{
    interpreter->order.backward = !interpreter->order.backward;
    interpreter->compound.reversed = !interpreter->compound.reversed;
}

/* Begins a new compound move: the outputs of T51-T58 and its direction are those of now. */
static void begin_compound(struct interpreter *interpreter)
{
    interpreter->compound.order.sections = 0;
    interpreter->compound.done = false;
    interpreter->compound.backward = interpreter->order.backward;
    interpreter->compound.reversed = false;
    interpreter->compound.outputs = interpreter->order.mark_outputs;
}

/* A section at the present V and A. */
static struct motion_section section_of(const struct interpreter *interpreter, uint64_t steps)
{
    return (struct motion_section){
        .steps = steps,
        .speed_steps_per_s = interpreter->order.speed_steps_per_s,
        .accel_steps_per_s2 = interpreter->order.accel_steps_per_s2,
    };
}

/* Appends steps, V and A as they are now to the compound move. */
static void run_append_section(struct interpreter *interpreter, uint64_t now_ticks)
{
    struct motion_order *compound = &interpreter->compound.order;
    if (interpreter->order.steps == 0) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_NO_STEPS, now_ticks);
        return;
    }
    if (compound->sections == 0 || interpreter->compound.done) {
        begin_compound(interpreter);
    }
    if (interpreter->order.backward != interpreter->compound.backward || interpreter->compound.reversed) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_DIRECTION, now_ticks);
        return;
    }
    if (compound->sections == MOTION_SECTIONS) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_SECTIONS, now_ticks);
        return;
    }
    compound->section[compound->sections] = section_of(interpreter, interpreter->order.steps);
    compound->sections++;
}

/* Begins a move of one section, at the present S. */
static void begin_single(struct interpreter *interpreter, struct motion_section section, bool backward,
                         uint8_t halt_high, uint64_t now_ticks)
{
    const struct motion_order order = {
        .section = {section},
        .start_speed_steps_per_s = interpreter->order.start_speed_steps_per_s,
        .sections = 1,
    };
    interpreter_begin_move(interpreter, &order, backward, halt_high, 0, now_ticks);
}

/* Makes the compound move if there is one, else the single move. */
static void run_move(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (interpreter->compound.order.sections > 0) {
        interpreter->compound.done = true;
        interpreter->compound.order.start_speed_steps_per_s = interpreter->order.start_speed_steps_per_s;
        interpreter_begin_move(interpreter, &interpreter->compound.order,
                               interpreter->compound.backward != interpreter->compound.reversed, 0,
                               interpreter->compound.outputs, now_ticks);
    } else if (interpreter->order.steps > 0) {
        begin_single(interpreter, section_of(interpreter, interpreter->order.steps), interpreter->order.backward, 0,
                     now_ticks);
    }
}

/* Moves to an absolute position, where the motor is not there already. */
static void run_go_to(struct interpreter *interpreter, int64_t position_steps, uint64_t now_ticks)
{
    int64_t distance = position_steps - axis_position_steps(interpreter->axis);
    uint64_t steps = distance < 0 ? (uint64_t)-distance : (uint64_t)distance;
    if (steps == 0) {
        return;
    }
    steps = steps < MOTION_SECTION_STEPS_MAX ? steps : MOTION_SECTION_STEPS_MAX;
    begin_single(interpreter, section_of(interpreter, steps), distance < 0, 0, now_ticks);
}

/* Runs without end at V. */
static void run_endless(struct interpreter *interpreter, bool backward, uint64_t now_ticks)
{
    begin_single(interpreter,
                 motion_order_endless(interpreter->order.speed_steps_per_s, interpreter->order.accel_steps_per_s2),
                 backward, 0, now_ticks);
}

/* Runs at S until the input is 1. */
static void run_limit(struct interpreter *interpreter, uint32_t input, bool backward, uint64_t now_ticks)
{
    begin_single(
        interpreter,
        motion_order_endless(interpreter->order.start_speed_steps_per_s, interpreter->order.accel_steps_per_s2),
        backward, input_mask(input), now_ticks);
}

/* Goes on at a label. */
static void run_jump(struct interpreter *interpreter, uint32_t label, uint64_t now_ticks)
{
    if (!program_memory_find_label(&interpreter->memory, label, &interpreter->next)) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_NO_LABEL, now_ticks);
    }
}

/* Goes on at a label if an input or variable has a level. */
static void run_jump_if(struct interpreter *interpreter, const struct program_instruction *instruction, bool level,
                        uint64_t now_ticks)
{
    if (interpreter_shared_level(interpreter->shared, instruction->io) == level) {
        run_jump(interpreter, (uint32_t)instruction->value, now_ticks);
    }
}

/* Goes on at a label and remembers the way back. */
static void run_call(struct interpreter *interpreter, uint32_t label, uint64_t now_ticks)
{
    if (interpreter->call_depth == INTERPRETER_CALLS_MAX) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_CALL_DEPTH, now_ticks);
        return;
    }
    interpreter->calls[interpreter->call_depth] = interpreter->next;
    interpreter->call_depth++;
    run_jump(interpreter, label, now_ticks);
}

/* Goes back to what follows the youngest call; what it has begun and not ended of loops is closed. */
static void run_return(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (interpreter->call_depth == 0) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_RETURN, now_ticks);
        return;
    }
    interpreter->call_depth--;
    interpreter->next = interpreter->calls[interpreter->call_depth];
    while (interpreter->loop_depth > 0 &&
           interpreter->loops[interpreter->loop_depth - 1U].calls > interpreter->call_depth) {
        interpreter->loop_depth--;
    }
}

/* The depth at which a loop begins whose L has been reached: its own if it is open since the youngest call, as the
 * program has jumped out of it, else inside all that are open. */
static uint8_t find_loop(const struct interpreter *interpreter)
{
    for (uint8_t i = 0; i < interpreter->loop_depth; i++) {
        const struct interpreter_loop *loop = &interpreter->loops[i];
        if (loop->body == interpreter->next && loop->calls == interpreter->call_depth) {
            return i;
        }
    }
    return interpreter->loop_depth;
}

/* Begins a loop of so many passes; one that is open begins anew, and those inside it are closed. */
static void run_loop(struct interpreter *interpreter, uint32_t passes, uint64_t now_ticks)
{
    uint8_t depth = find_loop(interpreter);
    if (depth == INTERPRETER_LOOPS_MAX) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_LOOP_DEPTH, now_ticks);
        return;
    }
    interpreter->loops[depth] = (struct interpreter_loop){
        .body = interpreter->next,
        .left = (uint16_t)passes,
        .calls = interpreter->call_depth,
    };
    interpreter->loop_depth = (uint8_t)(depth + 1U);
}

/* Begins the next pass of the innermost loop, or leaves it. */
static void run_loop_end(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (interpreter->loop_depth == 0) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_LOOP_END, now_ticks);
        return;
    }
    struct interpreter_loop *loop = &interpreter->loops[interpreter->loop_depth - 1U];
    loop->left--;
    if (loop->left > 0) {
        interpreter->next = loop->body;
    } else {
        interpreter->loop_depth--;
    }
}

/* Lets time go by, from the program clock on. */
static void run_wait(struct interpreter *interpreter, uint32_t milliseconds, uint64_t now_ticks)
{
    interpreter_align_clock(interpreter, now_ticks);
    interpreter_trace(interpreter, interpreter->clock, HAL_TRACE_WAIT, milliseconds);
    interpreter->clock += (uint64_t)milliseconds * TICKS_PER_MS;
    interpreter->state = INTERPRETER_WAIT_TIME;
}

/* Waits for a level, if it is not there already. */
static void run_wait_level(struct interpreter *interpreter, uint32_t number, bool level, uint64_t now_ticks)
{
    if (interpreter_shared_level(interpreter->shared, number) == level) {
        return;
    }
    interpreter->wait.number = (uint8_t)number;
    interpreter->wait.level = level;
    interpreter->state = INTERPRETER_WAIT_LEVEL;
    interpreter_trace(interpreter, now_ticks, HAL_TRACE_WAIT, 0);
}

/* Waits for a `]` further on. */
static void run_hold(struct interpreter *interpreter, uint64_t now_ticks)
{
    interpreter->state = INTERPRETER_HELD;
    if (!program_memory_is_released(&interpreter->memory, interpreter->place - 1U)) {
        interpreter_trace(interpreter, now_ticks, HAL_TRACE_WAIT, 0);
    }
}

/* Sets or clears an output or variable. */
static void run_set(struct interpreter *interpreter, uint32_t number, bool level, uint64_t now_ticks)
{
    interpreter_shared_set(interpreter->shared, number, level, interpreter->motor + 1U, now_ticks);
}

/* Switches a function; those without a meaning do nothing. */
static void run_function(struct interpreter *interpreter, uint32_t number, bool on)
{
    if (number == FUNCTION_MEMORY_LOCK) {
        interpreter->shared->memory_locked = on;
    } else if (number == FUNCTION_SIMULATION) {
        interpreter_shared_simulate(interpreter->shared, on);
    } else if (number >= FUNCTION_MARK_FIRST) {
        uint8_t mask = input_mask(number - FUNCTION_MARK_FIRST + 1U);
        uint8_t others = interpreter->order.mark_outputs & (uint8_t)~mask;
        interpreter->order.mark_outputs = on ? others | mask : others;
    }
}

/* Takes both guards away. */
static void run_guards_off(struct interpreter *interpreter)
{
    interpreter->guards.stop_high = 0;
    interpreter->guards.stop_low = 0;
}

void interpreter_run(struct interpreter *interpreter, const struct program_instruction *instruction, uint64_t now_ticks)
{
    uint32_t value = (uint32_t)instruction->value;

    /* clang-format off */
    switch ((enum program_opcode)instruction->opcode) {
    case PROGRAM_ACCELERATION: interpreter->order.accel_steps_per_s2 = value; break;
    case PROGRAM_STEPS_BACKWARD: run_steps(interpreter, value, true); break;
    case PROGRAM_CLEAR_OUTPUT: run_set(interpreter, value, false, now_ticks); break;
    case PROGRAM_FUNCTION_OFF: run_function(interpreter, value, false); break;
    case PROGRAM_CLEAR_VARIABLE: run_set(interpreter, value, false, now_ticks); break;
    case PROGRAM_ZERO_POSITION: axis_set_position(interpreter->axis, 0); break;
    case PROGRAM_REVERSE: run_reverse(interpreter); break;
    case PROGRAM_LOOP_END: run_loop_end(interpreter, now_ticks); break;
    case PROGRAM_STEPS_FORWARD: run_steps(interpreter, value, false); break;
    case PROGRAM_GO_TO: run_go_to(interpreter, instruction->value, now_ticks); break;
    case PROGRAM_RUN_FORWARD: run_endless(interpreter, false, now_ticks); break;
    case PROGRAM_RUN_BACKWARD: run_endless(interpreter, true, now_ticks); break;
    case PROGRAM_GO_HOME: run_go_to(interpreter, 0, now_ticks); break;
    case PROGRAM_JUMP_IF_HIGH: run_jump_if(interpreter, instruction, true, now_ticks); break;
    case PROGRAM_JUMP_IF_LOW: run_jump_if(interpreter, instruction, false, now_ticks); break;
    case PROGRAM_JUMP: run_jump(interpreter, value, now_ticks); break;
    case PROGRAM_LOOP: run_loop(interpreter, value, now_ticks); break;
    case PROGRAM_GUARD_HIGH: interpreter->guards.stop_high = input_mask(value); break;
    case PROGRAM_GUARD_LOW: interpreter->guards.stop_low = input_mask(value); break;
    case PROGRAM_WAIT_INPUT_HIGH: run_wait_level(interpreter, value, true, now_ticks); break;
    case PROGRAM_WAIT_VARIABLE_HIGH: run_wait_level(interpreter, value, true, now_ticks); break;
    case PROGRAM_MOVE: run_move(interpreter, now_ticks); break;
    case PROGRAM_START_SPEED: interpreter->order.start_speed_steps_per_s = value; break;
    case PROGRAM_SET_OUTPUT: run_set(interpreter, value, true, now_ticks); break;
    case PROGRAM_FUNCTION_ON: run_function(interpreter, value, true); break;
    case PROGRAM_SET_VARIABLE: run_set(interpreter, value, true, now_ticks); break;
    case PROGRAM_GUARDS_OFF: run_guards_off(interpreter); break;
    case PROGRAM_SPEED: interpreter->order.speed_steps_per_s = value; break;
    case PROGRAM_WAIT: run_wait(interpreter, value, now_ticks); break;
    case PROGRAM_TOTAL_STOP: interpreter->guards.abort_high |= input_mask(value); break;
    case PROGRAM_APPEND_SECTION: run_append_section(interpreter, now_ticks); break;
    case PROGRAM_WAIT_INPUT_LOW: run_wait_level(interpreter, value, false, now_ticks); break;
    case PROGRAM_WAIT_VARIABLE_LOW: run_wait_level(interpreter, value, false, now_ticks); break;
    case PROGRAM_LIMIT_FORWARD: run_limit(interpreter, value, false, now_ticks); break;
    case PROGRAM_LIMIT_BACKWARD: run_limit(interpreter, value, true, now_ticks); break;
    case PROGRAM_SET_POSITION: axis_set_position(interpreter->axis, instruction->value); break;
    case PROGRAM_CALL: run_call(interpreter, value, now_ticks); break;
    case PROGRAM_RETURN: run_return(interpreter, now_ticks); break;
    case PROGRAM_HOLD: run_hold(interpreter, now_ticks); break;
    case PROGRAM_LABEL: /* marks a place */
    case PROGRAM_RELEASE: /* has acted when it was stored */
    case PROGRAM_RESET: /* these three act on arrival and are never stored */
    case PROGRAM_HALT:
    case PROGRAM_RESUME:
    case PROGRAM_OPCODES: break;
    }
    /* clang-format on */
}
