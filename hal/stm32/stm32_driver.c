#include "hal_driver.h"

#include <assert.h>
#include <stddef.h>

#include "stm32_pins.h"
#include "stm32_private.h"

static_assert(BOARD_ENABLE_READY_US <= HAL_DRIVER_READY_US, "a first pulse would come before the drivers are ready");
static_assert(BOARD_ENABLE_IDLE_MS == 0U || BOARD_ENABLE_IDLE_MS >= 100U, "drivers that go off between two moves");

enum {
    NO_PIN = UINT8_MAX
};

static const uint8_t pins[] = {
#define X(signal, port, pin, use) STM32_PIN_##signal,
    BOARD_ENABLE_PINS(X)
#undef X
        NO_PIN,
};

/* The tick interrupt counts, main begins anew: what is lost where both do is a millisecond. */
static struct {
    volatile bool on;
    volatile uint32_t standing_ms;
} driver;

static void write_pins(bool on)
{
    for (size_t i = 0; pins[i] != NO_PIN; i++) {
        stm32_pin_write(pins[i], on == (BOARD_ENABLE_LEVEL == 1U));
    }
}

void hal_driver_enable(void)
{
    driver.standing_ms = 0;
    if (stm32_board_clock.crystal) {
        driver.on = true;
        write_pins(true);
    }
}

void stm32_driver_disable(void)
{
    driver.on = false;
    write_pins(false);
}

void stm32_driver_tick(void)
{
    if (BOARD_ENABLE_IDLE_MS == 0U || !driver.on) {
        return;
    }
    driver.standing_ms = stm32_step_is_quiet() ? driver.standing_ms + 1U : 0U;
    if (driver.standing_ms > BOARD_ENABLE_IDLE_MS) {
        stm32_driver_disable();
    }
}
