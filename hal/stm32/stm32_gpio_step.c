#include "base_hint.h"
#include "stm32_gpio_private.h"

struct stm32_gpio stm32_gpio;
uint32_t stm32_late_steps;
uint32_t stm32_step_worst_ticks;

static inline struct hal_step_pulse *slot(struct stm32_gpio_channel *channel, uint32_t pulse)
{
    return &channel->ring[pulse % RING_PULSES];
}

/* The look at the timer comes after the edge, as the bus keeps the order of both. */
static inline void rise(struct stm32_gpio_channel *channel)
{
    *channel->pin = channel->high_bits;
    uint32_t now = TIM2_CNT;
    uint32_t late = now - slot(channel, channel->made)->rise_tick;
    channel->made = channel->made + 1U;
    channel->high = true;
    channel->risen_tick = now;
    channel->edge_tick = now + (uint32_t)HIGH_TICKS;
    stm32_late_steps += late > (uint32_t)LATE_TICKS ? 1U : 0U;
    stm32_step_worst_ticks = late > stm32_step_worst_ticks ? late : stm32_step_worst_ticks;
}

/* Between two pulses: whether DIR turns before the next one. */
static void look_for_turn(struct stm32_gpio_channel *channel)
{
    uint32_t now = TIM2_CNT;
    uint32_t held = channel->risen_tick + (uint32_t)TURN_HOLD_TICKS;
    channel->turns_next = channel->turns && channel->made == channel->turned;
    if (channel->turns_next) {
        channel->edge_tick = held - now < (uint32_t)TURN_HOLD_TICKS ? held : now;
    }
}

/* A pulse that is late leaves its driver the time at low all the same. */
static inline void fall(struct stm32_gpio_channel *channel)
{
    *channel->pin = channel->low_bits;
    uint32_t rest = TIM2_CNT + (uint32_t)LOW_TICKS;
    uint32_t next = slot(channel, channel->made)->rise_tick;
    channel->high = false;
    channel->pending = channel->made != channel->laid;
    channel->edge_tick = later(next, rest);
    if (BASE_SELDOM(channel->turns)) {
        look_for_turn(channel);
    }
}

static void turn(struct stm32_gpio_channel *channel)
{
    *channel->direction = channel->turn_bits;
    uint32_t stands = TIM2_CNT + (uint32_t)SETUP_TICKS;
    channel->turns = false;
    channel->turns_next = false;
    channel->edge_tick = later(slot(channel, channel->made)->rise_tick, stands);
}

/* Makes the edge of a channel that is due; ticks until the next one. */
static inline int32_t serve(struct stm32_gpio_channel *channel, uint32_t now)
{
    int32_t way = (int32_t)(channel->edge_tick - now);
    if (!channel->pending) {
        return INT32_MAX;
    }
    if (way <= 0) {
        if (channel->high) {
            fall(channel);
        } else if (BASE_SELDOM(channel->turns_next)) {
            turn(channel);
        } else {
            rise(channel);
        }
        way = channel->pending ? (int32_t)(channel->edge_tick - now) : INT32_MAX;
    }
    return way;
}

/* Ticks until the refill is to be called. */
static inline int32_t call_refill(uint32_t now)
{
    int32_t way = (int32_t)(stm32_gpio.refill_tick - now);
    if (stm32_gpio.called) {
        return TICKS_PER_MS;
    }
    if (way <= 0) {
        stm32_gpio.called = true;
        NVIC_ISPR(REFILL_IRQ / 32U) = UINT32_C(1) << REFILL_IRQ % 32U;
        way = TICKS_PER_MS;
    }
    return way;
}

/* A match that was written too late would come in 51 s, so the counter is looked at once more after that. */
void stm32_step_interrupt(void)
{
    uint32_t next;
    do {
        TIM_SR(TIM2_BASE) = ~TIM_SR_CC1IF;
        uint32_t now = TIM2_CNT;
        int32_t way = call_refill(now);
        for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
            int32_t own = serve(&stm32_gpio.channel[motor], now);
            way = own < way ? own : way;
        }
        next = now + (uint32_t)way;
        TIM_CCR1(TIM2_BASE) = next;
    } while (is_before(next, TIM2_CNT + (uint32_t)SPIN_TICKS));
}

/* Lets the edges look at what has changed. */
static void look_again(void)
{
    TIM_EGR(TIM2_BASE) = TIM_EGR_CC1G;
}

static uint32_t count_waiting(const struct stm32_gpio_channel *channel)
{
    uint32_t laid = channel->laid;
    return laid - channel->made;
}

/* Asks for pulses in one piece of the ring. */
static uint32_t ask(unsigned motor, uint32_t waiting, uint32_t until)
{
    struct stm32_gpio_channel *channel = &stm32_gpio.channel[motor];
    uint32_t piece = RING_PULSES - channel->laid % RING_PULSES;
    struct hal_step_room room = {
        .pulse = slot(channel, channel->laid),
        .count = piece < (uint32_t)LAY_MAX ? piece : (uint32_t)LAY_MAX,
        .waiting = waiting,
        .until_tick = until,
        .high_ticks = HIGH_TICKS,
        .backward = channel->backward,
    };
    uint32_t count = stm32_gpio.client.lay_isr(stm32_gpio.client.context, motor, &room);
    if (room.main_has_work) {
        stm32_event = true;
    }
    if (BASE_SELDOM(count != 0 && room.backward != channel->backward)) {
        channel->backward = room.backward;
        channel->turn_bits = stm32_gpio_direction_bits(motor);
        channel->turned = channel->laid;
        channel->turns = true;
    }
    return count;
}

/* What has been written to the ring counts from here on. A pin that rests has no edge to come: the first is one. */
static void append(struct stm32_gpio_channel *channel, uint32_t count)
{
    uint32_t low = channel->risen_tick + (uint32_t)(HIGH_TICKS + LOW_TICKS);
    uint32_t first = slot(channel, channel->laid)->rise_tick;
    channel->last_tick = slot(channel, channel->laid + count - 1U)->rise_tick;
    uint32_t before = stm32_mask();
    if (!channel->pending) {
        bool near = TIM2_CNT - channel->risen_tick < (uint32_t)(HIGH_TICKS + LOW_TICKS);
        channel->edge_tick = near ? later(first, low) : first;
        look_for_turn(channel);
        channel->pending = true;
    }
    channel->laid = channel->laid + count;
    stm32_unmask(before);
    channel->active = true;
    channel->due_tick = channel->last_tick - (uint32_t)LEAD_TICKS;
    if (channel->turns) {
        channel->due_tick = later(channel->due_tick, first - (uint32_t)SETUP_TICKS);
    }
}

/* Nothing can be laid before all has been made; then the client is asked once more. */
static void wait_for_end(struct stm32_gpio_channel *channel, uint32_t waiting)
{
    uint32_t again = TIM2_CNT + (uint32_t)AGAIN_TICKS;
    channel->active = waiting != 0;
    channel->due_tick = is_before(channel->last_tick, again) ? again : channel->last_tick;
}

static void refill(unsigned motor, uint32_t until)
{
    struct stm32_gpio_channel *channel = &stm32_gpio.channel[motor];
    uint32_t waiting = count_waiting(channel);
    if (waiting > (uint32_t)WAITING_MAX || channel->turns) {
        channel->due_tick = TIM2_CNT + (uint32_t)AGAIN_TICKS;
        return;
    }
    uint32_t count = ask(motor, waiting, until);
    if (count == 0) {
        wait_for_end(channel, waiting);
    } else {
        append(channel, count);
    }
}

/* The motor that has the least ahead, and ticks until it must be served. */
static int32_t find_next(uint32_t now, unsigned *motor)
{
    int32_t least = TICKS_PER_MS;
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        const struct stm32_gpio_channel *channel = &stm32_gpio.channel[i];
        int32_t way = (int32_t)(channel->due_tick - now);
        if (channel->active && way < least) {
            least = way;
            *motor = i;
        }
    }
    return least;
}

void stm32_step_refill_interrupt(void)
{
    unsigned motor = 0;
    uint32_t now = TIM2_CNT;
    int32_t way = find_next(now, &motor);
    while (way < (int32_t)SOON_TICKS) {
        refill(motor, now + (uint32_t)HORIZON_TICKS);
        now = TIM2_CNT;
        way = find_next(now, &motor);
    }
    uint32_t before = stm32_mask();
    stm32_gpio.refill_tick = now + (uint32_t)way;
    stm32_gpio.called = false;
    stm32_unmask(before);
    look_again();
}

/* The refill comes as soon as it may. */
void hal_step_run(unsigned motor)
{
    refill(motor, TIM2_CNT + (uint32_t)RUN_TICKS);
    NVIC_ISPR(REFILL_IRQ / 32U) = UINT32_C(1) << REFILL_IRQ % 32U;
    look_again();
}

unsigned hal_step_waiting(unsigned motor)
{
    return count_waiting(&stm32_gpio.channel[motor]);
}

unsigned hal_step_take_back(unsigned motor, unsigned count)
{
    struct stm32_gpio_channel *channel = &stm32_gpio.channel[motor];
    uint32_t before = stm32_mask();
    uint32_t waiting = count_waiting(channel);
    uint32_t back = count < waiting ? count : waiting;
    channel->laid = channel->laid - back;
    if (channel->turns && channel->laid - channel->turned - 1U >= (uint32_t)RING_PULSES) {
        channel->turns = false;
        channel->turns_next = false;
        channel->backward = !channel->backward;
    }
    channel->pending = channel->high || channel->made != channel->laid;
    channel->last_tick = back < waiting ? slot(channel, channel->laid - 1U)->rise_tick : channel->risen_tick;
    stm32_unmask(before);
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

/* The edges go on. Whoever else runs with BASEPRI raised, main while it holds the plan interrupt off, has it back. */
void hal_step_hold(void)
{
    uint32_t before;
    __asm__ volatile("mrs %0, basepri\n\tmsr basepri_max, %1\n\tisb"
                     : "=&r"(before)
                     : "r"((uint32_t)STM32_PRIORITY_LINE << PRIORITY_PLACE)
                     : "memory");
    stm32_gpio.held_before = before;
}

void hal_step_release(void)
{
    __asm__ volatile("msr basepri, %0" ::"r"(stm32_gpio.held_before) : "memory");
}
