#include <stddef.h>

#include "board.h"
#include "base_tick.h"
#include "hal_io.h"
#include "hal_run.h"
#include "hal_time.h"
#include "stm32_private.h"
#include "stm32f4.h"

/* The inputs are looked at 20 times a millisecond, so that one acts within 50 us and what planning takes; the client
 * is called when one has changed, and every millisecond. */
enum {
    LOOKS_HZ = 20000,
    LOOKS_PER_MS = LOOKS_HZ / 1000,
    BLINK_MS = 100,
    PRIORITY_SHIFT = 4, /* four bits of priority, at the top of a byte; PM0214 4.3.7 */
};

static struct {
    struct hal_client client;
    uint64_t time; /* the unit's time at the last millisecond */
    bool crystal;
    uint8_t inputs;
    uint8_t looks;
    uint32_t milliseconds;
} tick;

volatile bool stm32_event;

static uint64_t extend_time(void)
{
    return tick.time + (uint32_t)(TIM2_CNT - (uint32_t)tick.time);
}

uint64_t hal_time_now(void)
{
    uint32_t mask = stm32_mask();
    uint64_t now = extend_time();
    stm32_unmask(mask);
    return now;
}

static void every_millisecond(void)
{
    tick.time = extend_time();
    tick.milliseconds++;
    stm32_line_tick();
    stm32_watchdog_tick();
    if (!tick.crystal) {
        stm32_io_blink(tick.milliseconds / BLINK_MS % 2U != 0);
    }
}

void stm32_tick_interrupt(void)
{
    uint8_t inputs = hal_io_read_inputs();
    bool millisecond = ++tick.looks == LOOKS_PER_MS;
    if (millisecond) {
        tick.looks = 0;
        every_millisecond();
    }
    if (millisecond || inputs != tick.inputs) {
        tick.inputs = inputs;
        stm32_event = true;
        tick.client.tick_isr(tick.client.context);
    }
}

void stm32_tick_start(const struct hal_client *client, uint32_t core_hz, bool crystal)
{
    tick.client = *client;
    tick.crystal = crystal;
    SCB_SHPR3 = (uint32_t)STM32_PRIORITY_TICK << (24U + PRIORITY_SHIFT);
    STK_LOAD = core_hz / LOOKS_HZ - 1U;
    STK_VAL = 0;
    STK_CTRL = STK_CTRL_CLKSOURCE | STK_CTRL_TICKINT | STK_CTRL_ENABLE;
}

void hal_run_hold_tick(void)
{
    uint32_t priority = STM32_PRIORITY_TICK << PRIORITY_SHIFT;
    __asm__ volatile("msr basepri, %0\n\tisb" ::"r"(priority) : "memory");
}

void hal_run_release_tick(void)
{
    __asm__ volatile("msr basepri, %0" ::"r"(0) : "memory");
}

bool stm32_event_take(void)
{
    bool event = stm32_event;
    if (event) {
        stm32_event = false;
    }
    return event;
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
