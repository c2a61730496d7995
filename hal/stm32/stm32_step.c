#include "hal_step.h"

#include "base_hint.h"
#include "stm32_step_private.h"

struct stm32_step stm32_step;
uint32_t stm32_late_steps;

static inline struct hal_step_pulse *slot(struct stm32_channel *channel, uint32_t pulse)
{
    return &channel->ring[pulse % RING_PULSES];
}

/* The second edge of the last pulse laid. */
static inline uint32_t last_fall(struct stm32_channel *channel)
{
    return WIDEST_TICKS > HIGH_TICKS ? slot(channel, channel->laid - 1U)->fall_tick
                                     : channel->last_tick + (uint32_t)HIGH_TICKS;
}

/* Of the words of the ring, NDTR has counted those that have arrived (RM0090 10.5.6); the last of them is the edge to
 * come. */
static uint32_t count_waiting(const struct stm32_channel *channel)
{
    uint32_t arrived = (RING_EDGES - DMA_NDTR(channel->stream)) % RING_EDGES;
    return (channel->laid - arrived / 2U) % RING_PULSES;
}

/* All pulses that should have been made were, but for those that wait. */
static void check_made(const struct stm32_channel *channel, uint32_t waiting)
{
    if (BASE_SELDOM(count_waiting(channel) != waiting)) {
        stm32_fault_stop_output();
    }
}

/* The pin is low and stays so. First the stream, then who asks it (RM0090 10.3.17), which takes back what it has asked
 * for meanwhile (AN4031 4.1). */
BASE_APART static void stop(struct stm32_channel *channel)
{
    set_mode(&channel->step, MODE_LOW);
    DMA_CR(channel->stream) &= ~DMA_CR_EN;
    while ((DMA_CR(channel->stream) & DMA_CR_EN) != 0) {
    }
    set_asking(channel, false);
    channel->active = false;
    channel->laid = 0;
}

/* The stream moves the first edge into the compare register at once; none before it is near (RM0090 10.3.17 has the
 * order of the writes to the stream). */
static void start(struct stm32_channel *channel, uint32_t now)
{
    *channel->clear = channel->flags;
    DMA_NDTR(channel->stream) = RING_EDGES;
    DMA_CR(channel->stream) |= DMA_CR_EN;
    *channel->step.compare = now - TICKS_PER_MS;
    TIM_SR(channel->timer) = ~channel->event;
    set_asking(channel, true);
    TIM_EGR(channel->timer) = channel->event;
    channel->active = true;
    if (channel->connected) {
        set_mode(&channel->step, MODE_TOGGLE);
    }
}

/* Moves pulses on that are due before `tick`, or too soon after the one before. */
static void make_good(struct hal_step_pulse *pulse, uint32_t count, uint32_t tick)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!is_before(pulse[i].rise_tick, tick)) {
            return;
        }
        pulse[i] = (struct hal_step_pulse){.rise_tick = tick, .fall_tick = tick + (uint32_t)HIGH_TICKS};
        tick += (uint32_t)(HIGH_TICKS + CATCH_UP_TICKS);
        stm32_late_steps++;
    }
}

/* Whether the second edge of a pulse can still be moved: the stream has it from that of the pulse before on, and from
 * its start that of the first one. */
static bool is_open(struct stm32_channel *channel, uint32_t pulse, uint32_t now)
{
    return pulse != 0 && is_before(now + (uint32_t)WIDEN_TICKS, slot(channel, pulse - 1U)->fall_tick);
}

/* Pulses from `first` on that have a next one become half a period wide. */
BASE_APART static void widen(struct stm32_channel *channel, uint32_t first)
{
    uint32_t now = TIM2_CNT;
    for (uint32_t pulse = first; pulse + 1U != channel->laid; pulse++) {
        struct hal_step_pulse *one = slot(channel, pulse);
        uint32_t high = (slot(channel, pulse + 1U)->rise_tick - one->rise_tick) / 2U;
        high = high < (uint32_t)WIDEST_TICKS ? high : (uint32_t)WIDEST_TICKS;
        if (is_open(channel, pulse, now)) {
            one->fall_tick = one->rise_tick + (high > (uint32_t)HIGH_TICKS ? high : (uint32_t)HIGH_TICKS);
        }
    }
}

/* The first tick at which a pulse can rise: the driver of the motor has had its time at low. */
static uint32_t earliest(const struct stm32_channel *channel, uint32_t now)
{
    uint32_t started = now + (uint32_t)START_TICKS;
    uint32_t low = channel->last_tick + (uint32_t)HIGH_TICKS + (uint32_t)LOW_TICKS;
    uint32_t tick = is_before(started, low) && !is_before(now, channel->last_tick) ? low : started;
    return channel->turns ? later(tick, channel->turn_tick + (uint32_t)TURN_SETUP_TICKS) : tick;
}

/* The value comes before the mode, so that a match with the old value changes nothing. */
static void arm_turn(struct stm32_channel *channel)
{
    *channel->direction.compare = channel->turn_tick & UINT16_MAX;
    set_mode(&channel->direction, direction_level(channel) ? MODE_HIGH_ON_MATCH : MODE_LOW_ON_MATCH);
}

/* DIR changes as soon as the pulse laid last allows. TIM3 knows of that when it is near. */
BASE_APART static void turn(struct stm32_channel *channel)
{
    uint32_t held = channel->last_tick + (uint32_t)TURN_HOLD_TICKS;
    uint32_t soon = TIM2_CNT + (uint32_t)TURN_TICKS;
    channel->backward = !channel->backward;
    channel->turn_tick = held - soon < (uint32_t)TURN_AHEAD_TICKS ? held : soon;
    channel->turned = channel->laid;
    channel->turns = true;
    channel->armed = WIDEST_TICKS == HIGH_TICKS || channel->turn_tick - soon < (uint32_t)HORIZON_TICKS;
    if (channel->armed) {
        arm_turn(channel);
    }
}

/* All pulses from `pulse` on are taken back, as counted since the start. A turn before them stays undone, if it is not
 * too late for that. */
static void turn_back(struct stm32_channel *channel, uint32_t pulse, uint32_t now)
{
    if (!channel->turns || pulse > channel->turned) {
        return;
    }
    channel->turns = false;
    if (is_before(now + (uint32_t)TURN_TICKS, channel->turn_tick)) {
        channel->backward = !channel->backward;
        set_mode(&channel->direction, direction_level(channel) ? MODE_HIGH : MODE_LOW);
    }
}

/* How many pulses at a time. Slow ones cost more, each; where the others need not wait, fast ones cost less the more
 * they are. */
static inline uint32_t portion(struct stm32_channel *channel, uint32_t left_ticks)
{
    uint32_t interval = channel->last_tick - slot(channel, channel->laid - 2U)->rise_tick;
    if (channel->laid <= 1U || interval >= (uint32_t)FAST_TICKS) {
        return LAY_MAX;
    }
    if (left_ticks >= (uint32_t)LONG_TICKS && !stm32_looking) {
        return LAY_LONG_MAX;
    }
    return LAY_FAST_MAX;
}

/* Asks for pulses in one piece of the ring, `left_ticks` before the last one laid; before they turn, DIR is told. */
static inline uint32_t ask(unsigned motor, uint32_t waiting, uint32_t left_ticks, uint32_t until)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    uint32_t piece = RING_PULSES - channel->laid % RING_PULSES;
    uint32_t count = portion(channel, left_ticks);
    struct hal_step_room room = {
        .pulse = slot(channel, channel->laid),
        .count = piece < count ? piece : count,
        .waiting = waiting,
        .until_tick = until,
        .high_ticks = HIGH_TICKS,
        .backward = channel->backward,
    };
    count = stm32_step.client.lay_isr(stm32_step.client.context, motor, &room);
    if (room.main_has_work) {
        stm32_event = true;
    }
    if (BASE_SELDOM(count != 0 && room.backward != channel->backward)) {
        turn(channel);
    }
    return count;
}

/* What the ring has from its start: so many pulses. Half a period wants the next pulse before the stream has this one's
 * second edge, so two ahead, but for those that are seconds apart. */
static void note_laid(struct stm32_channel *channel, uint32_t laid)
{
    channel->laid = laid;
    channel->last_tick = slot(channel, laid - 1U)->rise_tick;
    slot(channel, laid)->rise_tick = channel->last_tick + NEVER_TICKS;
    uint32_t tick = channel->last_tick;
    if (WIDEST_TICKS > HIGH_TICKS && laid > 1U) {
        tick = later(slot(channel, laid - 2U)->rise_tick, tick - (uint32_t)AHEAD_TICKS);
    }
    channel->from_tick = tick - (uint32_t)NEAR_TICKS;
    channel->due_tick = tick - (uint32_t)LEAD_TICKS;
    channel->ends = false;
}

/* Nothing more is laid before DIR has changed. */
BASE_APART static void wait_for_turn(struct stm32_channel *channel)
{
    if (channel->turns) {
        bool near = WIDEST_TICKS == HIGH_TICKS || channel->armed;
        uint32_t tick = near ? channel->turn_tick : channel->turn_tick - (uint32_t)NEAR_TICKS;
        channel->from_tick = later(channel->from_tick, tick);
        channel->due_tick = later(channel->due_tick, tick);
    }
}

/* What is laid comes to its end, and the pin to rest, before there is more. */
static void note_end(struct stm32_channel *channel)
{
    channel->from_tick = last_fall(channel) + (uint32_t)SETTLE_TICKS;
    channel->due_tick = channel->from_tick;
    channel->ends = true;
}

static void begin(unsigned motor, uint32_t ahead_ticks)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    channel->turns = false;
    uint32_t count = ask(motor, 0, 0, TIM2_CNT + ahead_ticks);
    if (count != 0) {
        uint32_t now = TIM2_CNT;
        make_good(channel->ring, count, earliest(channel, now) + count * (uint32_t)GOOD_TICKS);
        note_laid(channel, count);
        wait_for_turn(channel);
        start(channel, now);
        if (WIDEST_TICKS > HIGH_TICKS) {
            widen(channel, 0);
        }
    }
}

/* The pulse that was the last has begun while more were laid, which takes longer than the first of them. When it has
 * ended, the compare register has what the stream has loaded at its begin: that first one, or still the edge that is
 * never, and then the pulses are missing. So are those that had to be moved on, as nobody knows which tick it loaded.
 */
BASE_APART static void check_loaded(const struct stm32_channel *channel, uint32_t last, uint32_t fall, bool moved)
{
    uint32_t fallen = fall + (uint32_t)SETTLE_TICKS;
    while (is_before(TIM2_CNT, fallen)) {
    }
    if (moved || *channel->step.compare == last + NEVER_TICKS) {
        stm32_fault_stop_output();
    }
}

/* Nothing is laid before DIR knows of its turn, and while the ring is full. */
static inline bool must_wait(struct stm32_channel *channel, uint32_t waiting)
{
    bool unarmed = WIDEST_TICKS > HIGH_TICKS && channel->turns && !channel->armed;
    bool crowded = waiting > (uint32_t)WAITING_MAX;
    if (unarmed) {
        channel->armed = true;
        arm_turn(channel);
        wait_for_turn(channel);
    } else if (crowded) {
        channel->from_tick = slot(channel, channel->laid - (uint32_t)WAITING_MAX)->rise_tick;
    } else {
        /* there is room, and DIR is as it should be */
    }
    return unarmed || crowded;
}

/* The first pulse that waits is still to come. A stream that has met an error stops by itself, and one whose FIFO had
 * run empty has held a request up (RM0090 10.3.18): an edge that comes to the compare register after its time, and all
 * after it, are not made for a turn of the counter. */
static inline void check_made_in_time(struct stm32_channel *channel, uint32_t waiting, uint32_t now)
{
    bool is_over = is_before(slot(channel, channel->laid - waiting)->rise_tick + (uint32_t)SETTLE_TICKS, now);
    if (BASE_SELDOM(is_over && waiting != 0)) {
        stm32_fault_stop_output();
    }
}

/* The stream loads what comes after a pulse when that begins. Where that is far from the interrupt's begin, `now`, it
 * is far. */
static void append(unsigned motor, uint32_t now, uint32_t ahead_ticks)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    uint32_t waiting = count_waiting(channel);
    uint32_t last = channel->last_tick;
    bool far = !is_before(last, now + (uint32_t)FAR_TICKS);
    bool in_time = !is_before(last, now + (uint32_t)APPEND_LEFT_TICKS);
    check_made_in_time(channel, waiting, now);
    if (must_wait(channel, waiting)) {
        return;
    }
    channel->turns = false;
    uint32_t count = in_time ? ask(motor, waiting, last - now, now + ahead_ticks) : 0;
    if (BASE_SELDOM(count == 0)) {
        note_end(channel);
        return;
    }
    uint32_t fall = last_fall(channel);
    uint32_t least = fall + (uint32_t)LOW_TICKS;
    if (BASE_SELDOM(channel->turns)) {
        least = channel->turn_tick + (uint32_t)TURN_SETUP_TICKS;
    }
    bool moved = is_before(slot(channel, channel->laid)->rise_tick, least);
    make_good(slot(channel, channel->laid), count, least);
    note_laid(channel, channel->laid + count);
    if (BASE_SELDOM(channel->turns)) {
        wait_for_turn(channel);
    }
    if (BASE_SELDOM(!far && is_before(last, TIM2_CNT))) {
        check_loaded(channel, last, fall, moved);
    }
    if (WIDEST_TICKS > HIGH_TICKS) {
        widen(channel, channel->laid - count - 1U);
    }
}

static void refill(unsigned motor, uint32_t now, uint32_t ahead_ticks)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    if (BASE_SELDOM(channel->ends) && channel->active && !is_before(now, channel->from_tick)) {
        check_made(channel, 0);
        channel->last_tick = last_fall(channel) - (uint32_t)HIGH_TICKS;
        stop(channel);
    }
    if (BASE_SELDOM(!channel->active)) {
        begin(motor, ahead_ticks);
    } else if (!channel->ends) {
        append(motor, now, ahead_ticks);
    }
}

/* What the interrupt has to do. */
struct agenda {
    int32_t way;    /* ticks until a motor must be served */
    int32_t next;   /* of those that may be served now, the way of the one that must be first; */
    unsigned motor; /* that one */
};

static struct agenda look(uint32_t now)
{
    struct agenda agenda = {.way = TICKS_PER_MS, .next = INT32_MAX};
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        const struct stm32_channel *channel = &stm32_step.channel[motor];
        int32_t way = (int32_t)(channel->due_tick - now);
        if (channel->active && !is_before(now, channel->from_tick) && way < agenda.next) {
            agenda.next = way;
            agenda.motor = motor;
        }
        agenda.way = channel->active && way < agenda.way ? way : agenda.way;
    }
    return agenda;
}

/* Serves the motors in the order of what they have ahead, while that is urgent, or does not take long and holds up no
 * stop. */
void stm32_step_interrupt(void)
{
    TIM_SR(TIM2_BASE) = ~TIM_SR_CC4IF;
    uint32_t entered = TIM2_CNT;
    uint32_t now = entered;
    uint32_t time_ticks = stm32_looking ? 0U : (uint32_t)ENTRY_TICKS;
    struct agenda agenda = look(now);
    while (agenda.next != INT32_MAX && (agenda.next < (int32_t)SOON_TICKS || now - entered < time_ticks)) {
        refill(agenda.motor, now, HORIZON_TICKS);
        now = TIM2_CNT;
        agenda = look(now);
    }
    uint32_t next = now + (uint32_t)agenda.way;
    TIM2_CCR4 = next;
    if (BASE_SELDOM(is_before(next, TIM2_CNT + (uint32_t)SOON_TICKS))) {
        TIM_EGR(TIM2_BASE) = TIM_EGR_CC4G;
    }
}

/* The interrupt comes when a motor is due, if not before. */
static void call_for(const struct stm32_channel *channel)
{
    uint32_t due = channel->due_tick;
    if (is_before(due, TIM2_CCR4)) {
        TIM2_CCR4 = due;
        if (is_before(due, TIM2_CNT + (uint32_t)SOON_TICKS)) {
            TIM_EGR(TIM2_BASE) = TIM_EGR_CC4G;
        }
    }
}

/* More is laid when it is due, and not along with others: those may wait for a stop. */
void hal_step_run(unsigned motor)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    uint32_t now = TIM2_CNT;
    if (channel->active && channel->ends) {
        note_laid(channel, channel->laid);
        wait_for_turn(channel);
    }
    if (!channel->active || !is_before(now, channel->from_tick)) {
        refill(motor, now, RUN_TICKS);
    }
    if (channel->active) {
        channel->from_tick = later(channel->from_tick, channel->due_tick);
        call_for(channel);
    }
}

unsigned hal_step_waiting(unsigned motor)
{
    const struct stm32_channel *channel = &stm32_step.channel[motor];
    return channel->active ? count_waiting(channel) : 0;
}

/* Takes all back from `pulse` on, as counted since the start, once the one before has come to its end. False if there
 * is no time for that. */
static bool stop_before(struct stm32_channel *channel, uint32_t pulse, uint32_t now)
{
    uint32_t quiet = now;
    if (pulse != 0) {
        uint32_t fallen = slot(channel, pulse - 1U)->fall_tick + (uint32_t)SETTLE_TICKS;
        quiet = is_before(now, fallen) ? fallen : now;
    }
    if (is_before(slot(channel, pulse)->rise_tick, quiet + (uint32_t)STOP_TICKS)) {
        return false;
    }
    while (is_before(TIM2_CNT, quiet)) {
    }
    check_made(channel, channel->laid - pulse);
    turn_back(channel, pulse, quiet);
    if (pulse != 0) {
        channel->last_tick = slot(channel, pulse - 1U)->fall_tick - (uint32_t)HIGH_TICKS;
    }
    stop(channel);
    return true;
}

/* Takes all back from `pulse` on. The one before has not begun, and its rising edge is not what the stream waits for.
 */
static bool cut_before(struct stm32_channel *channel, uint32_t pulse, uint32_t now)
{
    uint32_t before = slot(channel, pulse - 1U)->rise_tick;
    if (is_before(before, now + (uint32_t)CUT_TICKS)) {
        return false;
    }
    turn_back(channel, pulse, now);
    if (WIDEST_TICKS > HIGH_TICKS && is_open(channel, pulse - 1U, now)) {
        slot(channel, pulse - 1U)->fall_tick = before + (uint32_t)HIGH_TICKS;
    }
    note_laid(channel, pulse);
    wait_for_turn(channel);
    return true;
}

unsigned hal_step_take_back(unsigned motor, unsigned count)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    uint32_t now = TIM2_CNT;
    uint32_t waiting = hal_step_waiting(motor);
    uint32_t laid = channel->laid;
    uint32_t back = count < waiting ? count : waiting;
    while (back > 0 && !(back < waiting && cut_before(channel, laid - back, now)) &&
           !stop_before(channel, laid - back, now)) {
        back--;
    }
    return back;
}

uint32_t hal_step_turn_us(void)
{
    return TURN_US;
}

uint32_t hal_step_lead_ticks(void)
{
    return CHANGE_TICKS;
}

void hal_step_hold(void)
{
    __asm__ volatile("cpsid i" ::: "memory");
}

void hal_step_release(void)
{
    __asm__ volatile("cpsie i" ::: "memory");
}
