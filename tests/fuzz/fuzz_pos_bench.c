#include "fuzz_pos_bench.h"

#include <string.h>

#include "base_tick.h"
#include "fuzz_host.h"
#include "fuzz_stream.h"
#include "hal_board.h"
#include "hal_time.h"

enum {
    LIMIT_TICKS = 2 * TICKS_PER_MS, /* a pass or two */
    SPACE_MAX = 6,
    STORE_SETTINGS = 1,
};

enum code {
    CODE_NONE,
    CODE_INIT,
    CODE_MODE,
    CODE_RESET,
    CODE_MODE_ABS,
    CODE_HOME,
    CODE_CAPTURE,
};

static struct fuzz_pos live;

static void mix(uint64_t number)
{
    live.hash = fuzz_digest(live.hash, number);
}

/* ---- pins ------------------------------------------------------------------------------------------------------ */

/* How far outside of the limits that are set, micrometres. */
static int64_t outside_um(const struct pos_axis *axis, int64_t motor_steps)
{
    int64_t min_um = (int32_t)axis->settings[POS_AXIS_SOFT_MIN];
    int64_t max_um = (int32_t)axis->settings[POS_AXIS_SOFT_MAX];
    int64_t um = pos_frame_position_um(&axis->frame, pos_frame_step_of(&axis->frame, motor_steps));
    if (min_um >= max_um || !axis->frame.referenced) {
        return 0;
    }
    return um < min_um ? min_um - um : um > max_um ? um - max_um : 0;
}

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    const struct pos_axis *axis = &live.unit.axes[motor];
    int64_t before = live.pin[motor];
    live.pin[motor] += backward ? -1 : 1;
    FUZZ_REQUIRE(pos_axis_is_busy(axis) && pos_axis_moves(axis));
    FUZZ_REQUIRE(axis->negative == backward);
    FUZZ_REQUIRE(live.pulse_tick[motor] == 0 || tick - live.pulse_tick[motor] >= (uint64_t)FUZZ_APART_TICKS_MIN);
    FUZZ_REQUIRE(live.turn_tick[motor] == 0 || tick - live.turn_tick[motor] >= HOST_SETUP_TICKS);
    int64_t outside = outside_um(axis, live.pin[motor]);
    FUZZ_REQUIRE(outside == 0 || outside <= outside_um(axis, before));
    live.pulse_tick[motor] = tick;
    mix(tick * 8U + motor * 2U + (backward ? 1U : 0U));
}

static void direction_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    (void)backward;
    live.turn_tick[motor] = tick;
}

static void line_seen(void *context, uint64_t tick, uint8_t value)
{
    (void)context;
    FUZZ_REQUIRE(live.sent_count < FUZZ_POS_HEARD_MAX);
    live.sent[live.sent_count++] = value;
    mix(tick * 256U + value);
}

static void output_seen(void *context, uint64_t tick, uint8_t levels)
{
    (void)context;
    (void)tick;
    FUZZ_REQUIRE(levels == 0);
}

static void input_seen(void *context, uint64_t tick, uint8_t levels)
{
    (void)context;
    (void)levels;
    live.input_tick = tick;
}

/* ---- a request, judged ----------------------------------------------------------------------------------------- */

static void keep_before(void)
{
    struct fuzz_pos_before *before = &live.before;
    before->registers = live.unit.registers;
    memcpy(before->counts, live.unit.server.counts, sizeof before->counts);
    before->flash_operations = live.machine.flash_operations;
    before->damaged = live.unit.settings.damaged;
    before->other = live.unit.settings.other;
    for (unsigned i = 0; i < (unsigned)POS_AXES; i++) {
        const struct pos_axis *axis = &live.unit.axes[i];
        before->axes[i] = (struct fuzz_pos_axis){
            .order = axis->order,
            .frame = axis->frame,
            .feed = axis->feed,
            .error = axis->error,
            .state = axis->state,
            .waits = axis->waits,
            .busy = pos_axis_is_busy(axis),
            .permitted = (axis->control->control2 & POS_CNT_MP) != 0,
            .armed = axis->watch.armed,
        };
    }
}

static bool is_of_use(unsigned axis, unsigned index, enum pos_use use)
{
    const struct pos_place place = {.axis = (uint8_t)axis, .index = (uint8_t)index};
    return pos_row(&place)->use == (uint8_t)use;
}

static bool same_of_use(const struct pos_registers *a, const struct pos_registers *b, enum pos_use use)
{
    bool same = true;
    for (unsigned i = 0; i < (unsigned)POS_UNIT_REGISTERS; i++) {
        same = same && (!is_of_use(0, i, use) || a->unit[i] == b->unit[i]);
    }
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        for (unsigned i = 0; i < (unsigned)POS_AXIS_REGISTERS; i++) {
            same = same && (!is_of_use(axis + 1U, i, use) || a->axes[axis][i] == b->axes[axis][i]);
        }
    }
    return same;
}

bool fuzz_pos_same_settings(const struct pos_registers *a, const struct pos_registers *b)
{
    return same_of_use(a, b, POS_USE_SETTING);
}

/* Neither executed nor parameters changed. */
static void require_untouched(unsigned axis)
{
    const uint32_t *then = live.before.registers.axes[axis];
    const uint32_t *since = live.unit.registers.axes[axis];
    const struct fuzz_pos_axis *before = &live.before.axes[axis];
    const struct pos_axis *own = &live.unit.axes[axis];
    FUZZ_REQUIRE(then[POS_AXIS_DONE] == since[POS_AXIS_DONE] && then[POS_AXIS_RESULT] == since[POS_AXIS_RESULT]);
    FUZZ_REQUIRE(memcmp(&before->order, &own->order, sizeof own->order) == 0);
    FUZZ_REQUIRE(own->state != (uint8_t)POS_TAKEN || before->state == (uint8_t)POS_TAKEN);
    FUZZ_REQUIRE(own->state != (uint8_t)POS_FREE || before->state == (uint8_t)POS_FREE);
    FUZZ_REQUIRE(own->error == before->error || own->state == (uint8_t)POS_FAULT);
    FUZZ_REQUIRE(before->armed || !own->watch.armed);
    FUZZ_REQUIRE(!own->waits || before->waits);
}

static void require_nothing_changed(void)
{
    const struct fuzz_pos_before *before = &live.before;
    FUZZ_REQUIRE(memcmp(&before->registers, &live.unit.registers, sizeof before->registers) == 0);
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        const struct pos_axis *own = &live.unit.axes[axis];
        require_untouched(axis);
        FUZZ_REQUIRE(own->feed == before->axes[axis].feed || own->state == (uint8_t)POS_FAULT);
        FUZZ_REQUIRE(((own->control->control2 & POS_CNT_MP) != 0) == before->axes[axis].permitted);
    }
}

static bool is_free(uint8_t state, bool busy)
{
    return state == (uint8_t)POS_FREE && !busy;
}

/* Whether an axis of the mask was busy before the pass; whether one still was after it. */
static bool was_busy(uint32_t axes, bool *still)
{
    bool was = false;
    *still = false;
    for (unsigned i = 0; i < (unsigned)POS_AXES; i++) {
        if ((axes >> i & 1U) != 0) {
            was = was || !is_free(live.before.axes[i].state, live.before.axes[i].busy);
            *still = *still || !is_free(live.unit.axes[i].state, pos_axis_is_busy(&live.unit.axes[i]));
        }
    }
    return was;
}

/* What it writes to STORE; 0: nothing. */
static uint32_t store_of(const struct pos_write *write)
{
    uint32_t next = 0;
    const struct pos_written *written = pos_write_next(write, POS_USE_STORE, &next);
    return written != NULL ? written->value : 0;
}

static void require_exception(uint8_t exception, const struct modbus_request *request, struct pos_write *write)
{
    bool inputs = request->function == (uint8_t)MODBUS_READ_INPUTS;
    bool reads = request->read_count == 0 || pos_registers_may_read(request->read_first, request->read_count, inputs);
    bool writes = request->write_count == 0 || pos_registers_may_write(request->write_first, request->write_count);
    bool still = false;
    write->count = 0;
    if (!reads || !writes) {
        FUZZ_REQUIRE(exception == MODBUS_EXCEPTION_ADDRESS);
    } else if (request->write_count != 0 && !pos_write_init(write, &live.before.registers, request->write_first,
                                                            request->write_count, request->values)) {
        FUZZ_REQUIRE(exception == MODBUS_EXCEPTION_VALUE);
    } else if (was_busy(pos_write_axes(write), &still) != (exception == MODBUS_EXCEPTION_BUSY)) {
        FUZZ_REQUIRE(exception != MODBUS_EXCEPTION_BUSY && !still); /* it came to rest in this pass */
    } else {
        FUZZ_REQUIRE(exception == MODBUS_EXCEPTION_NONE || exception == MODBUS_EXCEPTION_BUSY ||
                     (exception == MODBUS_EXCEPTION_FAILURE && store_of(write) != 0));
    }
}

/* What a measure is refused for, in the order of the contract. */
static enum pos_error measure_error(const struct fuzz_pos_axis *axis, const uint32_t *registers, unsigned code)
{
    int64_t len_um = (int32_t)registers[POS_AXIS_LEN];
    unsigned method = registers[POS_AXIS_SPACE];
    bool here = code == CODE_HOME && method == 37;
    int64_t way_um = code == CODE_MODE_ABS ? len_um - pos_frame_position_um(&axis->frame, axis->frame.step) : 0;
    const struct {
        bool applies;
        enum pos_error error;
    } causes[] = {
        {axis->state == (uint8_t)POS_FREE, POS_ERROR_NOT_TAKEN},
        {axis->state == (uint8_t)POS_FAULT, POS_ERROR_FAULT},
        {code == CODE_HOME && method != 19 && method != 21 && method != 37, POS_ERROR_METHOD},
        {!here && live.before.damaged, POS_ERROR_SETTINGS},
        {!here && live.machine.faults.no_crystal, POS_ERROR_NO_CRYSTAL},
        {code == CODE_HOME && !here && registers[POS_AXIS_REFERENCE] == 0, POS_ERROR_NO_INPUT},
        {!here && registers[POS_AXIS_ACCEL] == 0, POS_ERROR_ACCEL},
        {len_um == INT32_MIN || way_um > INT32_MAX || way_um < -INT32_MAX, POS_ERROR_WAY},
    };
    for (unsigned i = 0; i < sizeof causes / sizeof causes[0]; i++) {
        if (causes[i].applies) {
            return causes[i].error;
        }
    }
    return POS_OK;
}

static enum pos_error result_of(const struct fuzz_pos_axis *axis, const uint32_t *registers, unsigned code)
{
    switch ((enum code)code) {
    case CODE_INIT:
        return registers[POS_AXIS_SPACE] > SPACE_MAX ? POS_ERROR_SPACE : POS_OK;
    case CODE_MODE:
    case CODE_MODE_ABS:
    case CODE_HOME:
        return measure_error(axis, registers, code);
    case CODE_CAPTURE:
        return registers[POS_AXIS_CAPTURE] == 0 ? POS_ERROR_NO_INPUT : POS_OK;
    case CODE_NONE:
    case CODE_RESET:
        break;
    }
    return POS_OK;
}

/* In these the pass itself, before the request, may have brought the axis to another state. */
static bool is_settled(const struct fuzz_pos_axis *axis)
{
    return axis->state != (uint8_t)POS_MOVING && axis->state != (uint8_t)POS_WAITING && !axis->waits && !axis->busy;
}

static void require_instruction(unsigned axis, uint32_t word)
{
    const struct fuzz_pos_axis *before = &live.before.axes[axis];
    const uint32_t *registers = live.unit.registers.axes[axis];
    FUZZ_REQUIRE(registers[POS_AXIS_DONE] == word);
    if (word == live.before.registers.axes[axis][POS_AXIS_DONE]) {
        require_untouched(axis);
        return;
    }
    if (!is_settled(before)) {
        return;
    }
    enum pos_error result = result_of(before, registers, word & 0xFFU);
    FUZZ_REQUIRE(registers[POS_AXIS_RESULT] == (uint32_t)result);
    if (result != POS_OK) {
        uint16_t error = before->error != POS_OK ? before->error : (uint16_t)result;
        FUZZ_REQUIRE(live.unit.axes[axis].error == error || live.unit.axes[axis].state == (uint8_t)POS_FAULT);
        FUZZ_REQUIRE(memcmp(&before->order, &live.unit.axes[axis].order, sizeof before->order) == 0);
    }
}

/* It has been executed: settings and parameters are there, instructions have their results, all else is untouched. */
static void require_executed(const struct pos_write *write)
{
    struct pos_registers *before = &live.before.registers;
    uint32_t next = 0;
    bool instructed[POS_AXES] = {false};
    pos_write_apply(write, before);
    if (store_of(write) == 0) {
        FUZZ_REQUIRE(same_of_use(before, &live.unit.registers, POS_USE_SETTING));
        FUZZ_REQUIRE(live.before.flash_operations == live.machine.flash_operations);
    }
    FUZZ_REQUIRE(same_of_use(before, &live.unit.registers, POS_USE_PARAMETER));
    for (const struct pos_written *written = pos_write_next(write, POS_USE_INSTRUCTION, &next); written != NULL;
         written = pos_write_next(write, POS_USE_INSTRUCTION, &next)) {
        require_instruction(written->place.axis - 1U, written->value);
        instructed[written->place.axis - 1U] = true;
    }
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        if (!instructed[axis]) {
            require_untouched(axis);
        }
    }
}

static void require_request(void)
{
    static struct pos_write write;
    const struct modbus *server = &live.unit.server;
    const uint8_t *bytes = server->receiver.bytes;
    struct modbus_request request = {0};
    bool refused = server->counts[MODBUS_COUNT_EXCEPTIONS] != live.before.counts[MODBUS_COUNT_EXCEPTIONS];
    uint8_t exception = refused ? server->answer[2] : (uint8_t)MODBUS_EXCEPTION_NONE;
    bool one_way = bytes[0] == 0 && bytes[1] != MODBUS_WRITE_ONE && bytes[1] != MODBUS_WRITE;
    if (bytes[1] == MODBUS_IDENTIFY || one_way) {
        FUZZ_REQUIRE(!one_way || !refused);
        require_nothing_changed();
        return;
    }
    enum modbus_exception form = modbus_request_read(&request, &bytes[1], server->receiver.length - 3U);
    if (form != MODBUS_EXCEPTION_NONE) {
        FUZZ_REQUIRE(exception == (uint8_t)form);
    } else {
        require_exception(exception, &request, &write);
    }
    if (refused) {
        require_nothing_changed();
    } else {
        require_executed(&write);
        live.executed++;
        live.stores += store_of(&write) == STORE_SETTINGS ? 1U : 0U;
    }
}

/* ---- passes ---------------------------------------------------------------------------------------------------- */

static void require_watched(void)
{
    uint64_t patience = (uint64_t)live.unit.registers.unit[POS_UNIT_WATCHDOG] * TICKS_PER_MS;
    bool silent = patience != 0 && live.machine.now >= live.heard_tick + patience;
    for (unsigned i = 0; i < (unsigned)POS_AXES; i++) {
        uint8_t state = live.unit.axes[i].state;
        FUZZ_REQUIRE(!silent || state == (uint8_t)POS_FREE || state == (uint8_t)POS_FAULT);
    }
}

/* A limit that has been active for a while leaves no axis moving towards it, but for the one that homing seeks. */
static bool goes_past_limit(const struct pos_axis *axis)
{
    enum pos_axis_register limit = axis->negative ? POS_AXIS_LIMIT_MINUS : POS_AXIS_LIMIT_PLUS;
    bool settled = live.machine.now - live.input_tick >= (uint64_t)LIMIT_TICKS;
    bool measure = axis->state == (uint8_t)POS_MOVING && axis->phase == (uint8_t)POS_PHASE_NONE;
    return settled && measure && pos_watch_is_active((int32_t)axis->settings[limit], live.machine.inputs);
}

/* The states follow their table whatever comes. */
static void require_states(void)
{
    for (unsigned i = 0; i < (unsigned)POS_AXES; i++) {
        const struct pos_axis *axis = &live.unit.axes[i];
        bool busy = pos_axis_is_busy(axis);
        FUZZ_REQUIRE(pos_drive_steps(&axis->drive) == live.pin[i]);
        FUZZ_REQUIRE(!busy || (axis->state != (uint8_t)POS_READY && axis->state != (uint8_t)POS_REACHED));
        FUZZ_REQUIRE(axis->state != (uint8_t)POS_FAULT ||
                     (axis->error == POS_ERROR_LIMIT || axis->error == POS_ERROR_SILENT ||
                      axis->error == POS_ERROR_SOFT || axis->error == POS_ERROR_HOME));
        FUZZ_REQUIRE(axis->state != (uint8_t)POS_FREE || axis->feed == 0);
        FUZZ_REQUIRE(!goes_past_limit(axis));
    }
}

static uint64_t main_pass(void *context)
{
    (void)context;
    live.passes++;
    keep_before();
    uint64_t wake = positioning_poll(&live.unit);
    uint32_t frames = live.unit.server.counts[MODBUS_COUNT_FRAMES] - live.before.counts[MODBUS_COUNT_FRAMES];
    FUZZ_REQUIRE(frames <= 1);
    require_states();
    require_watched();
    if (frames != 0) {
        require_request();
    } else {
        require_nothing_changed();
    }
    return wake;
}

bool fuzz_pos_is_over(const struct fuzz_pos *fuzz)
{
    return fuzz->passes >= FUZZ_POS_PASSES_MAX || fuzz->machine.pulses >= FUZZ_POS_PULSES_MAX;
}

static bool is_over(void *context)
{
    (void)context;
    return fuzz_pos_is_over(&live);
}

void fuzz_pos_run(struct fuzz_pos *fuzz, uint64_t ticks)
{
    if (!fuzz_pos_is_over(fuzz)) {
        host_machine_run(&fuzz->machine, fuzz->machine.now + ticks, main_pass, is_over, NULL);
    }
}

static void switch_on(void)
{
    live.machine.faults.late_tick_ticks = FUZZ_LATE_TICKS;
    memset(live.pin, 0, sizeof live.pin);
    memset(live.turn_tick, 0, sizeof live.turn_tick);
    live.heard_tick = live.machine.now;
    positioning_init(&live.unit);
    positioning_start(&live.unit);
    host_machine_set_byte_ticks(&live.machine, FUZZ_POS_BYTE_TICKS); /* whatever RATE is */
}

struct fuzz_pos *fuzz_pos_begin(unsigned epoch)
{
    memset(&live, 0, sizeof live);
    live.hash = FUZZ_DIGEST_SEED;
    host_machine_init(&live.machine, fuzz_epoch_tick(epoch));
    live.machine.ahead_ticks = FUZZ_AHEAD_TICKS;
    live.machine.listener = (struct host_listener){
        .step = step_seen, .direction = direction_seen, .line = line_seen, .output = output_seen, .input = input_seen};
    host_machine_select(&live.machine);
    switch_on();
    return &live;
}

void fuzz_pos_restart(struct fuzz_pos *fuzz, enum hal_board_cause cause, bool crystal)
{
    host_machine_restart(&fuzz->machine);
    fuzz->machine.faults.start_cause = cause;
    fuzz->machine.faults.no_crystal = !crystal;
    switch_on();
    for (unsigned i = 0; i < (unsigned)POS_AXES; i++) {
        FUZZ_REQUIRE(is_free(fuzz->unit.axes[i].state, pos_axis_is_busy(&fuzz->unit.axes[i])));
    }
}
