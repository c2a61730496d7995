/*
 * The whole GVE134 unit on the host machine: bytes, silences, input edges, time, flash faults and restarts in.
 *
 * What holds at any time: positions told are those at the pins, and main changes them at a stand only; no pulse comes
 * while the unit says that the axes stand, and none while INTA is 1; pulses of a motor are 5 us less 2 ticks apart, and
 * DIR has stood before them; each answer is an answer to a `!` of its own. At the end the unit is reset, and answers as
 * one that is fresh. The same at another epoch, but for the shift.
 *
 * Input: a head (low 2 bits: epoch; bit 7: the run is made once more at another epoch) | operations, a byte each with
 * its operands after:
 *   low 3 bits 0, 1, 2  a line: its text up to a 0, with its checksum if the unit wants one
 *   3  bytes as they are, up to a 0       4  an input edge at once: high bits are input and level
 *   5  an input edge later: a byte, squared, in units of 10 us
 *   6  time: a byte, squared, in units of 50 us      7  a flash fault, a power cut, or off and on after some cause
 */
#include <stdio.h>
#include <string.h>

#include "base_tick.h"
#include "fuzz_host.h"
#include "fuzz_stream.h"
#include "gve134.h"
#include "host_machine.h"

enum {
    OPERATIONS_MAX = 64,
    PULSES_MAX = 3000,
    PASSES_MAX = 3000,
    BYTES_MAX = 600,
    TEXT_ROOM = 120,
    BYTE_TICKS = 800,
    TIME_UNIT_US = 50,
    END_MS = 1200, /* what is damaged or half a command is over then */
    HEARD_MAX = 64,
};

struct bench {
    struct gve134 unit;
    struct host_machine machine;
    struct host_line_byte script[BYTES_MAX];
    struct host_input edge;
    int64_t pin[UNIT_MOTORS];         /* pulses at the pins */
    int64_t offset[UNIT_MOTORS];      /* of the position that the unit tells */
    uint64_t pulse_tick[UNIT_MOTORS]; /* of the last one; 0: none */
    uint64_t turn_tick[UNIT_MOTORS];  /* of the last change of DIR; 0: none */
    uint32_t passes;
    uint32_t asked;        /* `!` that were sent */
    uint32_t answered;     /* CR that were heard */
    char heard[HEARD_MAX]; /* since the last CR that was sent */
    uint32_t heard_count;
    uint64_t hash;
};

static struct bench b;

static void mix(uint64_t number)
{
    b.hash = fuzz_digest(b.hash, number);
}

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    FUZZ_REQUIRE(gve_queue_moves(&b.unit.queue));
    FUZZ_REQUIRE(b.pulse_tick[motor] == 0 || tick - b.pulse_tick[motor] >= (uint64_t)FUZZ_APART_TICKS_MIN);
    FUZZ_REQUIRE(b.turn_tick[motor] == 0 || tick - b.turn_tick[motor] >= HOST_SETUP_TICKS);
    b.pulse_tick[motor] = tick;
    b.pin[motor] += backward ? -1 : 1;
    mix(tick * 8U + motor * 2U + (backward ? 1U : 0U));
}

static void direction_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    (void)backward;
    b.turn_tick[motor] = tick;
}

static void line_seen(void *context, uint64_t tick, uint8_t value)
{
    (void)context;
    b.answered += value == '\r' ? 1U : 0U;
    FUZZ_REQUIRE(b.answered <= b.asked);
    if (b.heard_count < HEARD_MAX) {
        b.heard[b.heard_count++] = (char)value;
    }
    mix(tick * 256U + value);
}

static void output_seen(void *context, uint64_t tick, uint8_t levels)
{
    (void)context;
    mix(tick * 256U + levels);
}

static int64_t offset_of(unsigned motor)
{
    return step_channel_position(&b.unit.queue.channel[motor]) - b.pin[motor];
}

static uint64_t main_pass(void *context)
{
    (void)context;
    const struct gve_queue *queue = &b.unit.queue;
    bool may_set = !gve_queue_moves(queue) || b.unit.waiting == (uint8_t)GVE134_WAITS_FOR_RESET;
    b.passes++;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        FUZZ_REQUIRE(offset_of(motor) == b.offset[motor]);
    }
    uint64_t wake = gve134_poll(&b.unit);
    may_set = may_set || !gve_queue_moves(queue); /* it has seen the end, and done what waited for that */
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        FUZZ_REQUIRE(may_set || offset_of(motor) == b.offset[motor]);
        b.offset[motor] = offset_of(motor);
    }
    bool resets = b.unit.waiting == (uint8_t)GVE134_WAITS_FOR_RESET;
    FUZZ_REQUIRE(resets || !gve_queue_inta(queue) || !gve_queue_moves(queue));
    FUZZ_REQUIRE(resets || !gve_queue_moves(queue) || gve_queue_runs(queue));
    return wake;
}

static bool is_over(void *context)
{
    (void)context;
    return b.passes >= PASSES_MAX || b.machine.pulses >= PULSES_MAX;
}

static void run(uint64_t ticks)
{
    if (!is_over(NULL)) {
        host_machine_run(&b.machine, b.machine.now + ticks, main_pass, is_over, NULL);
    }
}

static void switch_on(void)
{
    b.machine.faults.late_tick_ticks = FUZZ_LATE_TICKS;
    gve134_init(&b.unit);
    gve134_start(&b.unit);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        b.offset[motor] = offset_of(motor);
    }
}

static void begin(unsigned epoch)
{
    memset(&b, 0, sizeof b);
    b.hash = FUZZ_DIGEST_SEED;
    host_machine_init(&b.machine, fuzz_epoch_tick(epoch));
    b.machine.ahead_ticks = FUZZ_AHEAD_TICKS;
    b.machine.listener = (struct host_listener){
        .step = step_seen, .direction = direction_seen, .line = line_seen, .output = output_seen};
    host_machine_set_byte_ticks(&b.machine, BYTE_TICKS);
    host_machine_select(&b.machine);
    switch_on();
}

static void hear(const char *bytes, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        b.script[i] =
            (struct host_line_byte){.tick = b.machine.now + (i + 1U) * BYTE_TICKS, .value = (uint8_t)bytes[i]};
        b.asked += bytes[i] == '!' ? 1U : 0U;
    }
    b.heard_count = 0;
    host_machine_set_line(&b.machine, b.script, (uint32_t)length);
    run((length + 1U) * BYTE_TICKS);
}

/* A line with its ! and CR, and its checksum if the unit has them on. */
static void ask(const char *text, size_t length)
{
    char line[BYTES_MAX];
    unsigned sum = '!' + ',';
    if (length > TEXT_ROOM) {
        return;
    }
    line[0] = '!';
    memcpy(&line[1], text, length);
    for (size_t i = 0; i < length; i++) {
        sum += (uint8_t)text[i];
    }
    size_t end = length + 1U;
    if (b.unit.line.receiver.sums) {
        end += (size_t)snprintf(&line[end], sizeof line - end, ",%02X", sum % 256U);
    }
    line[end] = '\r';
    hear(line, end + 1U);
}

static void take_text(struct fuzz_stream *stream, bool line)
{
    size_t length = 0;
    const char *text = (const char *)fuzz_take_text(stream, &length);
    if (line) {
        ask(text, length);
    } else if (length <= BYTES_MAX) {
        hear(text, length);
    }
}

static void do_trouble(unsigned operand)
{
    if (fuzz_order_flash_fault(&b.machine, operand)) {
        return;
    }
    host_machine_restart(&b.machine);
    memset(b.turn_tick, 0, sizeof b.turn_tick);
    b.machine.faults.start_cause = (enum hal_board_cause)(operand / 4U % 4U);
    b.machine.faults.no_crystal = operand / 16U != 0;
    switch_on();
}

static void do_operation(struct fuzz_stream *stream)
{
    uint8_t operation = fuzz_take_byte(stream);
    unsigned operand = operation / 8U;
    switch (operation % 8U) {
    case 3:
        take_text(stream, false);
        break;
    case 4:
        host_machine_set_input(&b.machine, 1U + operand % 8U, operand / 8U % 2U != 0);
        break;
    case 5:
        fuzz_order_edge(&b.machine, &b.edge, stream, operand);
        break;
    case 6: {
        uint64_t time = fuzz_take_byte(stream);
        run(time * time * TIME_UNIT_US * TICKS_PER_US);
        break;
    }
    case 7:
        do_trouble(operand);
        break;
    default:
        take_text(stream, true);
        break;
    }
}

static void require_heard(const char *answer)
{
    size_t length = strlen(answer);
    FUZZ_REQUIRE(is_over(NULL) || (b.heard_count == length && memcmp(b.heard, answer, length) == 0));
}

/* Whatever has happened, J makes the unit a fresh one. */
static void require_fresh(void)
{
    run((uint64_t)END_MS * TICKS_PER_MS);
    ask("0J", 2);
    run((uint64_t)50 * TICKS_PER_MS);
    bool locked = b.machine.faults.no_crystal;
    ask("0@", 2);
    run(TICKS_PER_MS);
    require_heard(locked ? "8,0\r" : "0,0\r");
    ask("0P4", 3);
    run(TICKS_PER_MS);
    require_heard(locked ? "8,0,0,0,0\r" : "0,0,0,0,0\r");
}

static uint64_t run_once(struct fuzz_stream stream, unsigned epoch)
{
    begin(epoch);
    for (unsigned i = 0; i < OPERATIONS_MAX && !fuzz_stream_is_over(&stream) && !is_over(NULL); i++) {
        do_operation(&stream);
    }
    require_fresh();
    FUZZ_REQUIRE(b.machine.late_steps == 0);
    return b.hash;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_run_at_epochs(data, size, run_once);
}

/* Two times in three, puts the example of a command somewhere as a line, with some time after it. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    char line[TEXT_ROOM];
    unsigned opcode = seed / 3U % GVE_OPCODES;
    size = LLVMFuzzerMutate(data, size, max_size);
    size_t length = (size_t)snprintf(&line[1], sizeof line - 1U, "%c%s", gve_row(opcode)->address == 2 ? '7' : '0',
                                     gve_words(opcode)->example) +
                    2U;
    line[0] = 0;
    line[length++] = 6;
    line[length++] = (char)(seed >> 24U);
    return seed % 3U == 0 ? size : fuzz_insert(data, size, max_size, 1, seed / 256U, line, length);
}
