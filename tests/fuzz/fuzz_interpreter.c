/*
 * Random commands in the interpreter: it never leaves its bounds, does a bounded amount of work in a pass, and orders
 * nothing that the language does not have.
 *
 * The commands are what the parser can make, in any order and number; they come as messages between passes. The axis
 * is one of our own that ends, marks and stops its moves when the input says so, so a run costs a few microseconds.
 * Input: operations of a byte each, with their operands after:
 *   low 3 bits 0, 1  a message of 1 to 4 commands: opcode, condition, number of two bytes
 *   2  up to 32 commands right into memory      3  a pass      4  time goes by, two bytes of 10 us
 *   5  levels of the inputs      6  the axis: makes steps, ends its move, begins its last section
 *   7  the last message once more, or, the first time and if the operand is 0, memory nearly full of labels
 */
#include <string.h>

#include "fuzz_stream.h"
#include "hal_board.h"
#include "hal_io.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"
#include "hal_trace.h"
#include "interpreter.h"
#include "program_listing.h"
#include "program_parser.h"

enum {
    MESSAGE_COMMANDS_MAX = 4,
    FILL_COMMANDS = PROGRAM_COMMANDS_MAX - 8,
    OPERATIONS_MAX = 256,
    PASSES_MAX = 4,
    EVENTS_OF_A_COMMAND_MAX = 8 + 6, /* an output for each bit, start, move, stop, done, error, end */
};

struct bench {
    struct io io;
    struct interpreter_shared shared;
    struct axis axis;
    struct interpreter interpreter;
    uint64_t now;
    uint8_t inputs;
    bool mark;
    bool filled;     /* memory has been, in this run */
    unsigned events; /* in this pass */
    unsigned orders; /* in this pass */
    int64_t position;
    uint64_t made;
    uint64_t steps; /* of the move in progress */
    uint64_t end_tick;
    uint8_t text[MESSAGE_COMMANDS_MAX * PROGRAM_COMMAND_BYTES_MAX];
    uint32_t text_length;
};

static struct bench bench;

uint64_t hal_time_now(void)
{
    return bench.now;
}

uint8_t hal_io_read_inputs(void)
{
    return bench.inputs;
}

void hal_io_write_outputs(uint8_t levels)
{
    (void)levels;
}

bool hal_board_may_move(void)
{
    return true;
}

void hal_trace(uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    (void)value;
    FUZZ_REQUIRE(motor == 1 && event <= HAL_TRACE_COMMAND && tick <= bench.now);
    bench.events++;
}

static bool is_in(uint64_t value, uint64_t min, uint64_t max)
{
    return value >= min && value <= max;
}

static void require_good_order(const struct motion_order *order)
{
    FUZZ_REQUIRE(is_in(order->sections, 1, MOTION_SECTIONS));
    FUZZ_REQUIRE(is_in(order->start_speed_steps_per_s, 1, 2000));
    for (unsigned i = 0; i < order->sections; i++) {
        const struct motion_section *section = &order->section[i];
        bool endless = order->sections == 1 && motion_order_is_endless(order);
        FUZZ_REQUIRE(endless || is_in(section->steps, 1, MOTION_SECTION_STEPS_MAX));
        FUZZ_REQUIRE(is_in(section->speed_steps_per_s, 1, 16000));
        FUZZ_REQUIRE(is_in(section->accel_steps_per_s2, 1, 60000));
    }
}

static uint64_t order_steps(const struct motion_order *order)
{
    uint64_t steps = 0;
    for (unsigned i = 0; i < order->sections; i++) {
        steps += order->section[i].steps;
    }
    return steps;
}

static void begin(struct axis *axis, uint64_t start_tick)
{
    FUZZ_REQUIRE(axis->state == AXIS_STANDING && start_tick <= bench.now);
    FUZZ_REQUIRE(bench.now - start_tick <= INTERPRETER_CLOCK_SLACK_TICKS);
    require_good_order(&axis->order);
    bench.orders++;
    axis->cause = (axis->guards.abort_high & io_inputs(&bench.io)) != 0 ? AXIS_CAUSE_ABORT : AXIS_CAUSE_NONE;
    axis->state = axis->cause == AXIS_CAUSE_NONE ? AXIS_MOVING : AXIS_ENDED;
    bench.made = 0;
    bench.steps = order_steps(&axis->order);
    bench.end_tick = start_tick;
}

void axis_begin(struct axis *axis, const struct motion_order *order, bool backward, uint64_t start_tick,
                const struct axis_guards *guards)
{
    axis->order = *order;
    axis->guards = *guards;
    axis->channel.direction = backward ? -1 : 1;
    begin(axis, start_tick);
}

void axis_go_on(struct axis *axis, uint64_t start_tick)
{
    FUZZ_REQUIRE(axis_has_rest(axis));
    begin(axis, start_tick);
}

bool axis_has_rest(const struct axis *axis)
{
    return axis->order.sections > 0 && bench.made < bench.steps;
}

void axis_forget(struct axis *axis)
{
    axis->order.sections = 0;
}

bool axis_is_jog(const struct axis *axis)
{
    return motion_order_is_endless(&axis->order) && axis->guards.halt_high == 0;
}

bool axis_stop(struct axis *axis, enum axis_cause cause)
{
    bool stopped = axis->state == AXIS_MOVING;
    if (stopped) {
        axis->state = AXIS_STOPPING;
        axis->cause = cause;
        bench.events++;
    }
    return stopped;
}

void axis_change_speed(struct axis *axis, uint32_t speed_steps_per_s)
{
    FUZZ_REQUIRE(is_in(speed_steps_per_s, 1, 16000));
    (void)axis;
}

void axis_poll(struct axis *axis)
{
    (void)axis;
}

bool axis_take_end(struct axis *axis)
{
    bool ended = axis->state == AXIS_ENDED;
    if (ended) {
        axis->state = AXIS_STANDING;
    }
    return ended;
}

enum axis_cause axis_cause(const struct axis *axis)
{
    return axis->cause;
}

uint64_t axis_end_tick(const struct axis *axis)
{
    (void)axis;
    return bench.end_tick;
}

int64_t axis_position_steps(const struct axis *axis)
{
    (void)axis;
    return bench.position;
}

void axis_set_position(struct axis *axis, int64_t position_steps)
{
    FUZZ_REQUIRE(!axis_is_moving(axis));
    bench.position = position_steps;
}

void axis_simulate(struct axis *axis, bool simulated)
{
    if (!axis_is_moving(axis)) {
        axis->simulated = simulated;
    }
}

bool axis_take_mark(struct axis *axis)
{
    (void)axis;
    bool mark = bench.mark;
    bench.mark = false;
    return mark;
}

static void require_bounds(const struct interpreter *interpreter)
{
    const struct program_memory *memory = &interpreter->memory;
    FUZZ_REQUIRE(interpreter->state <= INTERPRETER_FAILED && interpreter->resume_state <= INTERPRETER_FAILED);
    FUZZ_REQUIRE(interpreter->next <= memory->written && interpreter->place <= memory->written);
    FUZZ_REQUIRE(interpreter->loop_depth <= INTERPRETER_LOOPS_MAX);
    FUZZ_REQUIRE(interpreter->call_depth <= INTERPRETER_CALLS_MAX);
    FUZZ_REQUIRE(interpreter->compound.order.sections <= MOTION_SECTIONS);
    FUZZ_REQUIRE(memory->released <= memory->written);
    FUZZ_REQUIRE(is_in(interpreter->order.speed_steps_per_s, 1, 16000) &&
                 is_in(interpreter->order.start_speed_steps_per_s, 1, 2000));
    FUZZ_REQUIRE((interpreter->state == INTERPRETER_FAILED) == (interpreter->error != INTERPRETER_ERROR_NONE));
    for (unsigned i = 0; i < interpreter->loop_depth; i++) {
        const struct interpreter_loop *loop = &interpreter->loops[i];
        FUZZ_REQUIRE(loop->body <= memory->written && is_in(loop->left, 1, 255));
        FUZZ_REQUIRE(loop->calls <= interpreter->call_depth && (i == 0 || loop[-1].calls <= loop->calls));
    }
    for (unsigned i = 0; i < interpreter->call_depth; i++) {
        FUZZ_REQUIRE(interpreter->calls[i] <= memory->written);
    }
}

static void do_pass(void)
{
    (void)io_sample(&bench.io);
    for (unsigned i = 0; i < PASSES_MAX; i++) {
        bench.events = 0;
        bench.orders = 0;
        uint64_t wake = interpreter_poll(&bench.interpreter, bench.now);
        FUZZ_REQUIRE(wake >= bench.now || bench.interpreter.state == INTERPRETER_WAIT_TIME);
        FUZZ_REQUIRE(bench.events <= INTERPRETER_SLICE_COMMANDS * EVENTS_OF_A_COMMAND_MAX);
        FUZZ_REQUIRE(bench.orders <= INTERPRETER_SLICE_COMMANDS);
        require_bounds(&bench.interpreter);
        if (wake != bench.now) {
            return;
        }
    }
}

/* One instruction that the parser could have made, of any opcode and any number in its range. */
static struct program_instruction take_instruction(struct fuzz_stream *stream)
{
    struct program_instruction instruction = {.opcode = fuzz_take_byte(stream) % PROGRAM_OPCODES};
    const struct program_row *row = program_opcode_row(instruction.opcode);
    uint8_t condition = fuzz_take_byte(stream);
    uint16_t number = fuzz_take_pair(stream);
    uint64_t range = (uint64_t)((int64_t)row->max - row->min) + 1U;
    /* Small numbers as they are, the rest spread over the range. */
    uint64_t offset = number < 0x8000U ? number % range : (uint64_t)(number & 0x7FFFU) * (range - 1U) / 0x7FFFU;
    instruction.value = (int32_t)(row->min + (int64_t)offset);
    if (row->form == PROGRAM_FORM_HIGH || row->form == PROGRAM_FORM_LOW) {
        instruction.io = (uint8_t)((condition & 1U) != 0 ? 1U + condition / 2U % 8U : 80U + condition / 2U % 16U);
    }
    return instruction;
}

static void take_message(void)
{
    const struct program_summary summary = program_check(bench.text, bench.text_length);
    FUZZ_REQUIRE(summary.status == PROGRAM_OK);
    (void)interpreter_take(&bench.interpreter, bench.text, bench.text_length, &summary, bench.now);
    require_bounds(&bench.interpreter);
}

static void do_message(struct fuzz_stream *stream, unsigned commands)
{
    bench.text_length = 0;
    for (unsigned i = 0; i < commands; i++) {
        struct program_instruction instruction = take_instruction(stream);
        bench.text_length += program_list_instruction(&instruction, bench.text + bench.text_length);
    }
    take_message();
}

/* What acts on arrival is never stored. */
static void do_store(struct fuzz_stream *stream, unsigned commands)
{
    for (unsigned i = 0; i < commands; i++) {
        struct program_instruction instruction = take_instruction(stream);
        bool stored = instruction.opcode != PROGRAM_RESET && instruction.opcode != PROGRAM_HALT &&
                      instruction.opcode != PROGRAM_RESUME;
        if (stored) {
            (void)program_memory_append(&bench.interpreter.memory, &instruction, bench.shared.memory_locked);
        }
    }
}

static void do_fill(unsigned operand)
{
    const struct program_instruction instruction = {.opcode = PROGRAM_LABEL, .value = 1};
    if (bench.filled || operand != 0) {
        if (bench.text_length != 0) {
            take_message();
        }
        return;
    }
    bench.filled = true;
    while (bench.interpreter.memory.written < FILL_COMMANDS) {
        (void)program_memory_append(&bench.interpreter.memory, &instruction, false);
    }
}

/* The axis makes steps, and may begin its last section, be stopped by a guard, or end. */
static void do_motion(struct fuzz_stream *stream)
{
    uint8_t what = fuzz_take_byte(stream);
    struct axis *axis = &bench.axis;
    if (!axis_is_moving(axis)) {
        return;
    }
    uint64_t steps = (uint64_t)what * what;
    steps = steps < bench.steps - bench.made ? steps : bench.steps - bench.made;
    bench.made += steps;
    bench.position += axis->channel.direction * (int64_t)steps;
    bench.mark = bench.mark || (what & 1U) != 0;
    bench.end_tick = bench.now;
    if ((what & 2U) != 0) {
        static const enum axis_cause causes[] = {AXIS_CAUSE_HIGH, AXIS_CAUSE_LOW, AXIS_CAUSE_ABORT, AXIS_CAUSE_LIMIT};
        (void)axis_stop(axis, causes[what / 8U % 4U]);
    }
    if (bench.made == bench.steps || (what & 4U) != 0) {
        axis->state = AXIS_ENDED;
    }
}

static void do_operation(struct fuzz_stream *stream)
{
    uint8_t operation = fuzz_take_byte(stream);
    unsigned operand = operation / 8U;
    switch (operation % 8U) {
    case 0:
    case 1:
        do_message(stream, 1U + operand % MESSAGE_COMMANDS_MAX);
        break;
    case 2:
        do_store(stream, 1U + operand);
        break;
    case 3:
        do_pass();
        break;
    case 4:
        bench.now += (uint64_t)fuzz_take_pair(stream) * 10U * TICKS_PER_US;
        break;
    case 5:
        bench.inputs = fuzz_take_byte(stream);
        break;
    case 6:
        do_motion(stream);
        break;
    default:
        do_fill(operand);
        break;
    }
    if (operation % 8U != 3U) {
        do_pass();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_stream stream = fuzz_stream_of(data, size);
    bench.now = UINT64_C(1) << 40U;
    bench.inputs = 0;
    bench.mark = false;
    bench.filled = false;
    bench.position = 0;
    bench.made = 0;
    bench.steps = 0;
    bench.end_tick = bench.now;
    bench.text_length = 0;
    bench.axis.state = AXIS_STANDING;
    bench.axis.cause = AXIS_CAUSE_NONE;
    io_init(&bench.io);
    interpreter_shared_init(&bench.shared, &bench.io);
    interpreter_init(&bench.interpreter, 0, &bench.axis, &bench.shared);
    for (unsigned i = 0; i < OPERATIONS_MAX && !fuzz_stream_is_over(&stream); i++) {
        do_operation(&stream);
    }
    return 0;
}
