#include "hal_step.h"

#include "base_tick.h"
#include "hal_driver.h"
#include "host_private.h"

/* Sets DIR and the connection of a motor; tells of what changes. */
static void set_pins(struct host_machine *machine, unsigned motor, bool backward, bool connected)
{
    const struct host_listener *listener = &machine->listener;
    bool before = machine->connected[motor] && machine->backward[motor];
    bool after = connected && backward;
    if (machine->connected[motor] != connected && listener->connection != NULL) {
        listener->connection(listener->context, machine->now, motor, connected);
    }
    machine->backward[motor] = backward;
    machine->connected[motor] = connected;
    if (before != after && listener->direction != NULL) {
        listener->direction(listener->context, machine->now, motor, after);
    }
}

static void set_polarity(struct host_machine *machine, unsigned motor, bool falling, bool turned)
{
    const struct host_listener *listener = &machine->listener;
    bool changes = machine->falling[motor] != falling || machine->turned[motor] != turned;
    machine->falling[motor] = falling;
    machine->turned[motor] = turned;
    if (changes && listener->polarity != NULL) {
        listener->polarity(listener->context, machine->now, motor, falling, turned);
    }
}

void host_step_reset(struct host_machine *machine)
{
    machine->enabled_tick = TICK_NEVER;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        machine->armed[motor] = TICK_NEVER;
        machine->step[motor] = TICK_NEVER;
        machine->laid[motor] = (struct host_laid){.turn = TICK_NEVER};
        set_pins(machine, motor, false, true);
        set_polarity(machine, motor, false, false);
    }
}

static uint64_t *laid_slot(struct host_laid *laid, uint32_t place)
{
    return &laid->tick[(laid->first + place) % HOST_LAID_MAX];
}

static void find_armed(struct host_machine *machine, unsigned motor)
{
    struct host_laid *laid = &machine->laid[motor];
    machine->armed[motor] = laid->count == 0 ? TICK_NEVER : *laid_slot(laid, 0);
}

/* The tick of a pulse that comes at `least` at the earliest. */
static uint64_t make_good(struct host_machine *machine, int64_t tick, uint64_t least)
{
    bool late = tick < (int64_t)least;
    machine->late_steps += late ? 1U : 0U;
    return late ? least : (uint64_t)tick;
}

/* DIR changes as soon as the pulse laid last allows. */
static void turn(struct host_machine *machine, unsigned motor)
{
    struct host_laid *laid = &machine->laid[motor];
    uint64_t held = laid->last + HOST_HOLD_TICKS;
    laid->turn = held > machine->now ? held : machine->now;
    laid->turned = 0;
}

static void put(struct host_machine *machine, unsigned motor, const struct hal_step_pulse *pulse)
{
    struct host_laid *laid = &machine->laid[motor];
    int32_t way = tick_difference(pulse->rise_tick, (uint32_t)host_unit_time(machine));
    bool turns = laid->turn != TICK_NEVER;
    uint64_t before = laid->count != 0 ? *laid_slot(laid, laid->count - 1U) : 0;
    uint64_t least = turns ? laid->turn + HOST_SETUP_TICKS : machine->now;
    least = before > least ? before : least;
    uint64_t tick = make_good(machine, (int64_t)machine->now + way, least);
    laid->turned += turns ? 1U : 0U;
    *laid_slot(laid, laid->count) = tick;
    laid->last = tick;
    laid->count++;
}

/* Not while DIR is to change. */
static bool wants_more(struct host_machine *machine, unsigned motor)
{
    struct host_laid *laid = &machine->laid[motor];
    return laid->turn == TICK_NEVER &&
           (laid->count == 0 ||
            (laid->count < HOST_LAID_MAX && *laid_slot(laid, laid->count - 1U) < machine->now + machine->ahead_ticks));
}

/* Asks for a pulse at a time. True: main has something to do. */
static bool lay(struct host_machine *machine, unsigned motor)
{
    bool main_has_work = false;
    bool more = true;
    while (more && wants_more(machine, motor)) {
        struct hal_step_pulse pulse;
        struct hal_step_room room = {
            .pulse = &pulse,
            .count = 1,
            .waiting = machine->laid[motor].count,
            .until_tick = (uint32_t)host_unit_time(machine) + machine->ahead_ticks,
            .high_ticks = HOST_PULSE_TICKS,
            .backward = machine->backward[motor],
        };
        more = machine->client.lay_isr(machine->client.context, motor, &room) != 0;
        main_has_work = main_has_work || room.main_has_work;
        if (more && room.backward != machine->backward[motor]) {
            turn(machine, motor);
        }
        if (more) {
            put(machine, motor, &pulse);
        }
    }
    find_armed(machine, motor);
    return main_has_work;
}

unsigned host_step_first(const struct host_machine *machine)
{
    unsigned first = 0;
    uint64_t earliest = host_step_next_tick(machine, 0);
    for (unsigned motor = 1; motor < UNIT_MOTORS; motor++) {
        uint64_t tick = host_step_next_tick(machine, motor);
        first = tick < earliest ? motor : first;
        earliest = tick < earliest ? tick : earliest;
    }
    return first;
}

uint64_t host_step_next_tick(const struct host_machine *machine, unsigned motor)
{
    uint64_t edge = machine->armed[motor];
    uint64_t step = machine->step[motor];
    uint64_t turn = machine->laid[motor].turn;
    uint64_t next = edge < step ? edge : step;
    return turn < next ? turn : next;
}

static void make_edge(struct host_machine *machine, unsigned motor)
{
    const struct host_listener *listener = &machine->listener;
    struct host_laid *laid = &machine->laid[motor];
    void (*tell)(void *, uint64_t, unsigned, bool) = machine->connected[motor] ? listener->step : listener->simulated;
    machine->pulses++;
    if (tell != NULL) {
        tell(listener->context, machine->now, motor, machine->backward[motor]);
    }
    laid->made = machine->now;
    laid->first++;
    laid->count--;
}

/* The interrupt comes with the edge, unless it is late. */
void host_step_event(struct host_machine *machine, unsigned motor)
{
    machine->now = host_step_next_tick(machine, motor);
    if (machine->laid[motor].turn == machine->now) {
        machine->laid[motor].turn = TICK_NEVER;
        set_pins(machine, motor, !machine->backward[motor], machine->connected[motor]);
        machine->step[motor] = machine->now;
    }
    if (machine->armed[motor] == machine->now) {
        uint64_t step = machine->now + machine->faults.late_step_ticks;
        make_edge(machine, motor);
        find_armed(machine, motor);
        machine->step[motor] = step < machine->step[motor] ? step : machine->step[motor];
    }
    if (machine->step[motor] == machine->now) {
        machine->step[motor] = TICK_NEVER;
        if (lay(machine, motor)) {
            host_wake_main(machine, machine->now + HOST_PULSE_TICKS);
        }
    }
}

static struct host_machine *held_machine(unsigned motor)
{
    struct host_machine *machine = host_current();
    assert(motor < UNIT_MOTORS);
    assert(machine->step_held);
    return machine;
}

/* Whoever calls knows that main has work. */
void hal_step_run(unsigned motor)
{
    (void)lay(held_machine(motor), motor);
}

unsigned hal_step_waiting(unsigned motor)
{
    return held_machine(motor)->laid[motor].count;
}

unsigned hal_step_take_back(unsigned motor, unsigned count)
{
    struct host_machine *machine = held_machine(motor);
    struct host_laid *laid = &machine->laid[motor];
    unsigned back = 0;
    while (back < count && laid->count != 0 &&
           *laid_slot(laid, laid->count - 1U) >= machine->now + machine->faults.keep_ticks) {
        laid->count--;
        back++;
    }
    laid->last = laid->count != 0 ? *laid_slot(laid, laid->count - 1U) : laid->made;
    if (laid->turned <= back) {
        laid->turn = TICK_NEVER;
    }
    laid->turned -= laid->turned < back ? laid->turned : back;
    find_armed(machine, motor);
    return back;
}

void hal_step_set_direction(unsigned motor, bool backward)
{
    struct host_machine *machine = host_current();
    assert(motor < UNIT_MOTORS);
    assert(machine->armed[motor] == TICK_NEVER);
    set_pins(machine, motor, backward, machine->connected[motor]);
}

void hal_step_connect(unsigned motor, bool connected)
{
    struct host_machine *machine = host_current();
    assert(motor < UNIT_MOTORS);
    assert(machine->armed[motor] == TICK_NEVER);
    set_pins(machine, motor, machine->backward[motor], connected);
}

void hal_step_set_polarity(unsigned motor, bool falling, bool turned)
{
    struct host_machine *machine = host_current();
    assert(motor < UNIT_MOTORS);
    assert(machine->armed[motor] == TICK_NEVER);
    set_polarity(machine, motor, falling, turned);
}

void hal_driver_enable(void)
{
    struct host_machine *machine = host_current();
    machine->enabled_tick = machine->now;
}

uint32_t hal_step_turn_us(void)
{
    return HOST_TURN_US;
}

uint32_t hal_step_lead_ticks(void)
{
    return 0;
}

void hal_step_hold(void)
{
    struct host_machine *machine = host_current();
    assert(!machine->step_held);
    machine->step_held = true;
}

void hal_step_release(void)
{
    struct host_machine *machine = host_current();
    assert(machine->step_held);
    machine->step_held = false;
}
