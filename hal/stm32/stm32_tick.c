#include <stddef.h>

#include "board.h"
#include "base_tick.h"
#include "hal_io.h"
#include "hal_run.h"
#include "hal_time.h"
#include "image.h"
#include "stm32_private.h"
#include "stm32f4.h"

/*
 * The clock comes every millisecond, and when main wants to be woken. An edge at an input has an interrupt of its own,
 * at the same priority, so that it acts at once. After it edges are held off for 50 us; then the clock looks at the
 * inputs and lets edges through again. So a contact that bounces, or noise, has two short interrupts in 50 us at most,
 * and nothing is seen later than that.
 */
enum {
    PERIODS_HZ = 1000,
    HOLDS_HZ = 20000,
    ALARM_CYCLES_MIN = 100,
    BLINK_MS = 100,
    ENTRY_TICKS = 5 * TICKS_PER_US / 4, /* from an edge to its look at the time, the interrupt of a step in between */
    PRIORITY_SHIFT = 4,                 /* four bits of priority, at the top of a byte; PM0214 4.3.7 */
};

static struct {
    struct hal_client client;
    uint64_t time; /* the unit's time at the last millisecond */
    bool crystal;
    bool edges_held;
    bool shortened; /* the clock comes before its millisecond is over, or did before that */
    uint8_t inputs;
    uint32_t milliseconds;
    uint32_t period; /* cycles */
    uint32_t hold;
    uint32_t tick_cycles; /* of a tick */
    uint32_t rest;        /* cycles of the millisecond that are left when the clock comes next */
} tick;

volatile bool stm32_event;
volatile bool stm32_looking;

static uint64_t time_now(void)
{
    uint32_t since = TIM2_CNT - (uint32_t)tick.time;
    return tick.time + since;
}

uint64_t hal_time_now(void)
{
    uint32_t mask = stm32_mask();
    uint64_t now = time_now();
    stm32_unmask(mask);
    return now;
}

static void every_millisecond(void)
{
    tick.time = time_now();
    tick.milliseconds++;
    stm32_line_tick();
    stm32_driver_tick();
    stm32_watchdog_tick();
    if (!tick.crystal && IMAGE_LEDS_BLINK != 0) {
        stm32_io_blink(tick.milliseconds / BLINK_MS % 2U != 0);
    }
}

/* `entered` is the time at which the interrupt began. */
static void look_at_inputs(bool must_call, uint64_t entered)
{
    uint8_t inputs = hal_io_read_inputs();
    if (must_call || inputs != tick.inputs) {
        tick.inputs = inputs;
        stm32_event = true;
        stm32_looking = true;
        tick.client.tick_isr(tick.client.context, entered - ENTRY_TICKS);
        stm32_looking = false;
    }
}

/* The clock comes after so many cycles. */
static void restart_clock(uint32_t cycles)
{
    STK_LOAD = cycles - 1U;
    STK_VAL = 0;
    SCB_ICSR = SCB_ICSR_PENDSTCLR;
}

/* The clock comes earlier than it would, and the millisecond goes on after that. */
static void shorten_clock(uint32_t until_millisecond, uint32_t cycles)
{
    tick.rest = until_millisecond > cycles ? until_millisecond - cycles : 0;
    tick.shortened = true;
    restart_clock(cycles);
}

/* Cycles until the millisecond is over; none if the clock has come and its interrupt waits. */
static uint32_t find_rest(void)
{
    uint32_t cycles = STK_VAL + tick.rest;
    return (SCB_ICSR & SCB_ICSR_PENDSTSET) != 0 ? 0 : cycles;
}

/* Goes on after a clock that was shortened. What is left of the millisecond comes next, unless it is so short that it
 * is over now. */
static bool lengthen_clock(void)
{
    bool millisecond = tick.rest < tick.hold;
    restart_clock(millisecond ? tick.period : tick.rest);
    tick.rest = 0;
    tick.shortened = !millisecond;
    return millisecond;
}

void stm32_tick_interrupt(void)
{
    uint64_t entered = time_now();
    bool millisecond = true;
    if (tick.shortened) {
        millisecond = lengthen_clock();
        stm32_event = true;
    }
    if (tick.edges_held) {
        tick.edges_held = false;
        stm32_edge_let_through();
    }
    if (millisecond) {
        every_millisecond();
    }
    look_at_inputs(millisecond, entered);
}

void stm32_edge_interrupt(void)
{
    uint64_t entered = time_now();
    uint32_t rest = find_rest();
    stm32_edge_hold();
    shorten_clock(rest, tick.hold);
    tick.edges_held = true;
    look_at_inputs(false, entered);
}

void stm32_tick_start(const struct hal_client *client, uint32_t core_hz, bool crystal)
{
    tick.client = *client;
    tick.crystal = crystal;
    tick.period = core_hz / PERIODS_HZ;
    tick.hold = core_hz / HOLDS_HZ;
    tick.tick_cycles = core_hz > TICK_HZ ? core_hz / TICK_HZ : 1U;
    SCB_SHPR3 = ((uint32_t)STM32_PRIORITY_TICK << (24U + PRIORITY_SHIFT)) |
                ((uint32_t)STM32_PRIORITY_PLAN << (16U + PRIORITY_SHIFT));
    restart_clock(tick.period);
    STK_CTRL = STK_CTRL_CLKSOURCE | STK_CTRL_TICKINT | STK_CTRL_ENABLE;
}

void stm32_plan_interrupt(void)
{
    tick.client.plan_isr(tick.client.context);
}

/* The barriers: it comes here, and not some instructions later, if nothing holds it off (PM0214 4.4.3). */
void hal_run_plan(void)
{
    SCB_ICSR = SCB_ICSR_PENDSVSET;
    stm32_barrier();
}

/* Holds interrupts off from a priority on; 0: none. */
static void hold_from(uint32_t priority)
{
    __asm__ volatile("msr basepri, %0\n\tisb" ::"r"(priority << PRIORITY_SHIFT) : "memory");
}

void hal_run_hold_plan(void)
{
    hold_from(STM32_PRIORITY_PLAN);
}

void hal_run_release_plan(void)
{
    hold_from(0);
}

bool stm32_event_take(void)
{
    bool event = stm32_event;
    if (event) {
        stm32_event = false;
    }
    return event;
}

/* A hold ends soon enough. */
void stm32_event_alarm(uint32_t ticks)
{
    hold_from(STM32_PRIORITY_TICK);
    uint32_t rest = find_rest();
    uint32_t cycles = ticks * tick.tick_cycles;
    cycles = cycles < ALARM_CYCLES_MIN ? (uint32_t)ALARM_CYCLES_MIN : cycles;
    if (!tick.edges_held && rest > tick.rest && cycles < rest - tick.rest) {
        shorten_clock(rest, cycles);
    }
    hold_from(0);
}

/* An interrupt that comes between the look and the sleep ends the sleep, as it stays pending. */
void stm32_event_sleep(void)
{
    uint32_t mask = stm32_mask();
    if (!stm32_event) {
        __asm__ volatile("dsb\n\twfi" ::: "memory");
    }
    stm32_unmask(mask);
}
