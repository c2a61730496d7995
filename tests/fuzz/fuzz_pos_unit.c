/*
 * The whole positioning unit on the host machine: requests, bytes, silences, input edges, time, flash faults and
 * restarts in. What holds at any time, fuzz_pos_bench.h says. And: the frames that an independent reader finds good are
 * taken, all others are not; each request to this unit gets one answer that the reader finds good, with its function;
 * a request that is repeated changes nothing; settings are, after a restart, those stored last or those that were
 * being stored when the power failed, whole. The same at another epoch, but for the shift.
 *
 * Input: a head (low 2 bits: epoch; bit 7: the run is made once more at another epoch) | operations, a byte each with
 * its operands after:
 *   low 3 bits 0  an instruction with its parameters, CONTROL and FEED   1  CONTROL and FEED, FEED alone, or the image
 *   2  a setting, or STORE     3  a frame, its CRC added      4  bytes as they are, one of them broken, no silence
 *   5  an input edge, at once or later: a byte, squared, in units of 10 us
 *   6  time: a byte, squared, in units of 50 us
 *   7  a flash fault, a power cut, off and on after some cause, or the last request once more
 */
#include <string.h>

#include "base_tick.h"
#include "fuzz_host.h"
#include "fuzz_pos_line.h"
#include "fuzz_stream.h"

enum {
    OPERATIONS_MAX = 48,
    TIME_UNIT_US = 50,
    STORE = 40,
    UNIT_SETTINGS = 3,
    AXIS_SETTINGS = 17,
    KEPT_MAX = 8,
    PIECES = 8,
    PIECE_ROOM = 24,
};

struct run {
    struct fuzz_pos *fuzz;
    struct fuzz_pos_line line;
    struct host_input edge;
    uint8_t number[POS_AXES];            /* of instructions */
    struct pos_registers kept[KEPT_MAX]; /* what may be stored: settings that an answer has confirmed, those since */
    uint32_t kept_count;
    bool faulty; /* a flash fault has been ordered since the start */
};

static struct run run;

static const size_t lengths[PIECES] = {18, 18, 18, 24, 10, 8, 4, 10};

/* ---- settings that are stored ---------------------------------------------------------------------------------- */

/* What was confirmed is stored; what was not may be, if the power has failed or nobody knows what the unit has heard;
 * what was refused is not. */
static void note_store(uint32_t stores)
{
    bool open = run.fuzz->machine.faults.flash_cut_after != 0 || run.line.vague;
    if (run.fuzz->stores == stores && !open) {
        return;
    }
    run.kept_count = open && run.kept_count < (uint32_t)KEPT_MAX ? run.kept_count : open ? KEPT_MAX - 1U : 0;
    run.kept[run.kept_count++] = run.fuzz->unit.registers;
}

static void require_kept(void)
{
    bool found = false;
    for (uint32_t i = 0; i < run.kept_count; i++) {
        found = found || fuzz_pos_same_settings(&run.kept[i], &run.fuzz->unit.registers);
    }
    FUZZ_REQUIRE(found && !run.fuzz->unit.settings.damaged && !run.fuzz->unit.settings.other);
    run.kept[0] = run.fuzz->unit.registers;
    run.kept_count = 1;
}

/* ---- operations ------------------------------------------------------------------------------------------------ */

static uint32_t put_words(uint8_t *bytes, const uint16_t *words, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        bytes[i * 2U] = (uint8_t)(words[i] >> 8U);
        bytes[i * 2U + 1U] = (uint8_t)(words[i] & 0xFFU);
    }
    return count * 2U;
}

/* Writes registers with 16, or with 23 that reads the full image too. */
static void write_words(uint8_t node, uint16_t first, const uint16_t *words, uint16_t count, bool reads)
{
    uint8_t bytes[FUZZ_POS_FRAME_ROOM] = {node, reads ? MODBUS_WRITE_AND_READ : MODBUS_WRITE};
    const uint16_t image[] = {640, 32};
    const uint16_t range[] = {first, count};
    uint32_t length = 2;
    length += reads ? put_words(&bytes[length], image, 2) : 0U;
    length += put_words(&bytes[length], range, 2);
    bytes[length++] = (uint8_t)(count * 2U);
    length += put_words(&bytes[length], words, count);
    fuzz_pos_line_ask(&run.line, bytes, length);
}

static void write_one(uint16_t number, uint16_t value)
{
    uint8_t bytes[6] = {FUZZ_POS_NODE, MODBUS_WRITE_ONE};
    const uint16_t words[] = {number, value};
    (void)put_words(&bytes[2], words, 2);
    fuzz_pos_line_ask(&run.line, bytes, sizeof bytes);
}

static void do_instruction(struct fuzz_stream *stream, unsigned operand)
{
    static const uint16_t methods[] = {19, 21, 37, 20};
    unsigned axis = operand % POS_AXES;
    unsigned code = operand / POS_AXES;
    uint8_t how = fuzz_take_byte(stream);
    uint32_t len = (uint32_t)((int32_t)(int16_t)fuzz_take_pair(stream)) << (how >> 4U);
    uint16_t accel = fuzz_take_pair(stream);
    uint16_t feed = fuzz_take_pair(stream);
    run.number[axis] = (uint8_t)(run.number[axis] + ((how & 8U) != 0 ? 0U : 1U));
    uint16_t space = code == 5 ? methods[accel % 4U] : (uint16_t)(feed % 8U);
    const uint16_t words[] = {(uint16_t)(run.number[axis] * 256U + code),
                              space,
                              (uint16_t)(len >> 16U),
                              (uint16_t)(len & 0xFFFFU),
                              accel,
                              (uint16_t)(how & 1U),
                              feed,
                              0};
    write_words((how & 4U) != 0 ? 0U : FUZZ_POS_NODE, (uint16_t)(100U * (axis + 1U)), words, 8, (how & 2U) != 0);
}

static void do_control(struct fuzz_stream *stream, unsigned operand)
{
    unsigned base = 100U * (operand % POS_AXES + 1U);
    uint16_t feed = fuzz_take_pair(stream);
    uint16_t mp = (uint16_t)(operand / 4U % 2U);
    if (operand / 8U == 0) {
        write_one((uint16_t)(base + 6U), feed);
    } else if (operand / 8U == 1) {
        const uint16_t words[] = {mp, feed, 0};
        write_words(FUZZ_POS_NODE, (uint16_t)(base + 5U), words, 3, false);
    } else if (operand / 8U == 2) {
        write_one((uint16_t)(base + 5U), mp);
    } else {
        const uint16_t words[] = {1, feed, 0, mp, feed, 0, 1, 0, feed, mp, feed, feed};
        write_words(FUZZ_POS_NODE, 500, words, 12, false);
    }
}

static const struct pos_row *setting(unsigned axis, unsigned number)
{
    for (unsigned i = 0;; i++) {
        const struct pos_place place = {.axis = (uint8_t)axis, .index = (uint8_t)i};
        const struct pos_row *row = pos_row(&place);
        if (row->use == (uint8_t)POS_USE_SETTING && number-- == 0) {
            return row;
        }
    }
}

static void do_setting(struct fuzz_stream *stream, unsigned operand)
{
    uint8_t which = fuzz_take_byte(stream);
    uint16_t pair = fuzz_take_pair(stream);
    unsigned axis = operand % 5U;
    uint32_t stores = run.fuzz->stores;
    if (operand >= 30U) {
        write_one(STORE, (uint16_t)(operand - 29U));
        if (operand == 30U) {
            note_store(stores);
        }
        return;
    }
    const struct pos_row *row = setting(axis, which % (axis == 0 ? (unsigned)UNIT_SETTINGS : (unsigned)AXIS_SETTINGS));
    uint16_t number = (uint16_t)(row->number + 100U * axis);
    bool small = row->form == (uint8_t)POS_FORM_RANGE && row->max < 10U;
    uint32_t value = (uint32_t)((int32_t)(int16_t)pair) << (operand / 5U * 4U);
    const uint16_t words[] = {(uint16_t)(value >> 16U), (uint16_t)(value & 0xFFFFU)};
    if (pos_row_is_wide(row)) {
        write_words(FUZZ_POS_NODE, number, words, 2, false);
    } else {
        write_one(number, small ? (uint16_t)(pair % 20U - 9U) : pair);
    }
}

static void do_frame(struct fuzz_stream *stream, unsigned operand)
{
    size_t length = 0;
    uint8_t bytes[FUZZ_POS_FRAME_ROOM];
    const uint8_t *given = fuzz_take_bytes(stream, operand + 1U, &length);
    uint32_t stores = run.fuzz->stores;
    memcpy(bytes, given, length);
    fuzz_pos_line_ask(&run.line, bytes, (uint32_t)length);
    note_store(stores); /* it may be one */
}

static void do_bytes(struct fuzz_stream *stream, unsigned operand)
{
    size_t length = 0;
    uint8_t broken = fuzz_take_byte(stream);
    const uint8_t *given = fuzz_take_bytes(stream, operand + 1U, &length);
    if (run.line.length + length < (size_t)FUZZ_POS_LINE_ROOM && length != 0) {
        fuzz_pos_line_put(&run.line, given, (uint32_t)length, broken);
    }
    run.line.request_length = 0;
}

static void do_edge(struct fuzz_stream *stream, unsigned operand)
{
    if (operand / 16U == 0) {
        host_machine_set_input(&run.fuzz->machine, 1U + operand % 8U, operand / 8U % 2U != 0);
        return;
    }
    fuzz_order_edge(&run.fuzz->machine, &run.edge, stream, operand);
}

/* The same once more: no word is executed again, nothing that is stored is written again. */
static void do_repeat(void)
{
    uint32_t operations = run.fuzz->machine.flash_operations;
    uint8_t bytes[FUZZ_POS_FRAME_ROOM];
    uint32_t length = run.line.request_length;
    memcpy(bytes, run.line.request, length);
    if (length != 0) {
        fuzz_pos_line_ask(&run.line, bytes, length);
        FUZZ_REQUIRE(operations == run.fuzz->machine.flash_operations || run.faulty);
    }
}

static void restart(unsigned operand)
{
    fuzz_pos_restart(run.fuzz, (enum hal_board_cause)(operand % 4U), operand / 4U == 0);
    require_kept();
    memset(run.number, 0, sizeof run.number);
    fuzz_pos_line_begin(&run.line, run.fuzz);
    run.faulty = false;
}

static void do_trouble(unsigned operand)
{
    struct host_faults *faults = &run.fuzz->machine.faults;
    uint32_t at = run.fuzz->machine.flash_operations + 1U + operand / 4U * 8U;
    bool one = !run.faulty;
    switch (operand % 4U) {
    case 0:
        faults->flash_fail_at = one ? at : faults->flash_fail_at;
        faults->flash_done = (enum host_flash_done)(operand / 8U);
        run.faulty = true;
        break;
    case 1:
        faults->flash_cut_after = one ? at : faults->flash_cut_after;
        faults->flash_done = (enum host_flash_done)(operand / 8U);
        run.faulty = true;
        break;
    case 2:
        do_repeat();
        break;
    default:
        restart(operand / 4U);
        break;
    }
}

static void do_operation(struct fuzz_stream *stream)
{
    uint8_t operation = fuzz_take_byte(stream);
    unsigned operand = operation / 8U;
    switch (operation % 8U) {
    case 0:
        do_instruction(stream, operand);
        break;
    case 1:
        do_control(stream, operand);
        break;
    case 2:
        do_setting(stream, operand);
        break;
    case 3:
        do_frame(stream, operand);
        break;
    case 4:
        do_bytes(stream, operand);
        break;
    case 5:
        do_edge(stream, operand);
        break;
    case 6: {
        uint64_t time = fuzz_take_byte(stream);
        fuzz_pos_line_wait(&run.line, time * time * TIME_UNIT_US * TICKS_PER_US);
        break;
    }
    default:
        do_trouble(operand);
        break;
    }
}

/* What stands in the registers could be written there. */
static void require_registers(void)
{
    static struct pos_write write;
    uint16_t values[32];
    const struct pos_registers *registers = &run.fuzz->unit.registers;
    for (uint32_t axis = 1; axis <= (uint32_t)POS_AXES; axis++) {
        pos_registers_read(registers, axis * 100U + 30U, 26, values);
        FUZZ_REQUIRE(pos_write_init(&write, registers, axis * 100U + 30U, 26, values));
    }
    pos_registers_read(registers, 600, 32, values);
    FUZZ_REQUIRE(pos_write_init(&write, registers, 600, 32, values));
    pos_registers_read(registers, 30, 3, values);
    FUZZ_REQUIRE(pos_write_init(&write, registers, 30, 3, values));
}

/* Whatever has happened, the unit answers. */
static void require_alive(void)
{
    static const uint8_t identify[] = {FUZZ_POS_NODE, MODBUS_IDENTIFY, 14, 1, 0};
    fuzz_pos_line_wait(&run.line, fuzz_pos_line_silence_ticks(&run.line));
    fuzz_pos_line_ask(&run.line, identify, sizeof identify);
    require_registers();
    FUZZ_REQUIRE(run.fuzz->machine.late_steps == 0);
    FUZZ_REQUIRE(run.fuzz->machine.flash_rewrites == 0 || run.faulty);
}

static uint64_t run_once(struct fuzz_stream stream, unsigned epoch)
{
    memset(&run, 0, sizeof run);
    run.fuzz = fuzz_pos_begin(epoch);
    fuzz_pos_line_begin(&run.line, run.fuzz);
    run.kept[0] = run.fuzz->unit.registers;
    run.kept_count = 1;
    fuzz_pos_line_wait(&run.line, fuzz_pos_line_silence_ticks(&run.line));
    for (unsigned i = 0; i < OPERATIONS_MAX && !fuzz_stream_is_over(&stream) && !fuzz_pos_is_over(run.fuzz); i++) {
        do_operation(&stream);
    }
    require_alive();
    return run.fuzz->hash;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_run_at_epochs(data, size, run_once);
}

/* What chance alone would take long to write; axis, and bytes by chance. */
static size_t put_piece(uint8_t piece[PIECE_ROOM], unsigned which, unsigned seed)
{
    const uint8_t axis = (uint8_t)(seed % (unsigned)POS_AXES);
    const uint8_t chance[] = {(uint8_t)(seed >> 5U), (uint8_t)(seed >> 11U), (uint8_t)(seed >> 17U)};
    const uint8_t order = (uint8_t)(8U * axis); /* an instruction of the axis, code 0 */
    const uint8_t setting = (uint8_t)(8U * (axis + 1U) + 2U);
    const uint8_t relative = (uint8_t)(8U * (axis + 8U));
    const uint8_t absolute = (uint8_t)(8U * (axis + 16U));
    const uint8_t home = (uint8_t)(8U * (axis + 20U));
    const uint8_t init = (uint8_t)(8U * (axis + 4U));
    const uint8_t pieces[][PIECE_ROOM] = {
        {init, 0, 0, 0, 0, 0, 0, 0, relative, 1, chance[0], chance[1], chance[2], 1, chance[1], 0, 6, chance[2]},
        {init, 0, 0, 0, 0, 0, 0, 0, absolute, 1, chance[0], chance[1], chance[2], 1, chance[1], 0, 6, chance[2]},
        {init, 0, 0, 0, 0, 0, 0, 0, home, 1, chance[0], 0, chance[2], 1, chance[1], 0, 6, chance[2]},
        {init, 0, 0, 0, 0, 0, 0, 0, home, 1, chance[0], 0, 2, 0, 0, 0, order, 1, 0, 0, 0, 0, 0, 0},
        {setting, 8, chance[0], 0xFF, setting, 9, chance[1], 0, 6, 40},
        {setting, (uint8_t)(10U + chance[0] % 4U), chance[1], 0, 0x85, chance[2], 0xC5, chance[1]},
        {2, 0, (uint8_t)(10U + chance[0] % 64U), 0},
        {setting, (uint8_t)(chance[0] % 17U), chance[1], 0, (uint8_t)(7U + 8U * (chance[2] % 32U)), 0xF2, 0, 0, 0,
         0x1F},
    };
    memcpy(piece, pieces[which % PIECES], PIECE_ROOM);
    return lengths[which % PIECES];
}

/* Two times in three, puts such a piece somewhere. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    uint8_t piece[PIECE_ROOM];
    size_t length = put_piece(piece, seed / 3U, seed / 32U);
    size = LLVMFuzzerMutate(data, size, max_size);
    return seed % 3U == 0 ? size : fuzz_insert(data, size, max_size, 1, seed / 256U, piece, length);
}
