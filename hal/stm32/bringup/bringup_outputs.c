#include <stddef.h>

#include "base_limits.h"
#include "base_tick.h"
#include "bringup.h"
#include "hal_board.h"
#include "hal_io.h"
#include "hal_step.h"
#include "hal_time.h"
#include "stm32_pins.h"

enum {
    ON_MS_MAX = 60000,
    SETTLE_MS = 1,
    NO_PIN = UINT8_MAX,
};

static struct {
    uint64_t off_tick;
    bool on;
} outputs;

static const uint8_t output_pins[UNIT_OUTPUTS] = {
    STM32_PIN_BO_1, STM32_PIN_BO_2, STM32_PIN_BO_3, STM32_PIN_BO_4,
    STM32_PIN_BO_5, STM32_PIN_BO_6, STM32_PIN_BO_7, STM32_PIN_BO_8,
};
static const uint8_t led_pins[UNIT_MOTORS] = {STM32_PIN_LED_1, STM32_PIN_LED_2, STM32_PIN_LED_3, STM32_PIN_LED_4};
static const uint8_t direction_pins[UNIT_MOTORS] = {STM32_PIN_DIR_1, STM32_PIN_DIR_2, STM32_PIN_DIR_3, STM32_PIN_DIR_4};
static const uint8_t enable_pins[] = {
#define X(signal, port, pin, use) STM32_PIN_##signal,
    BOARD_ENABLE_PINS(X)
#undef X
        NO_PIN,
};
enum {
    ENABLES = sizeof enable_pins - 1U
};
static const uint8_t step_pins[UNIT_MOTORS] = {STM32_PIN_STEP_1, STM32_PIN_STEP_2, STM32_PIN_STEP_3, STM32_PIN_STEP_4};

/* Where number is 0, none. */
static void switch_all(char kind, uint32_t number)
{
    hal_io_write_outputs(kind == 'o' && number != 0 ? (uint8_t)(1U << (number - 1U)) : 0U);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        hal_io_set_led(i, kind == 'e' && number == i + 1U);
        hal_step_set_direction(i, kind == 'd' && number == i + 1U);
    }
    for (uint32_t i = 0; enable_pins[i] != NO_PIN; i++) {
        bool on = kind == 'a' && number == i + 1U;
        stm32_pin_write(enable_pins[i], on == (BOARD_ENABLE_LEVEL == 1U));
    }
}

/* The pins as they are, whatever was written. */
static void tell_pins(const char *name, const uint8_t *pins, unsigned count, bool one_is_high)
{
    uint32_t mask = 0;
    for (unsigned i = 0; i < count; i++) {
        mask |= stm32_pin_read(pins[i]) == one_is_high ? UINT32_C(1) << i : 0U;
    }
    say_name(name);
    say_hex(mask, 2);
    say_line_end();
}

static uint32_t count_of(char kind)
{
    switch (kind) {
    case 'o':
        return UNIT_OUTPUTS;
    case 'a':
        return ENABLES;
    default:
        return UNIT_MOTORS;
    }
}

/* Where a wire leads from an output to an input, the one is seen at the other. */
static void tell_inputs(void)
{
    say_name("inputs");
    say_hex(hal_io_read_inputs(), 2);
    say_line_end();
    say_name("capture");
    say_decimal(bringup_capture_read() ? 1U : 0U);
    say_line_end();
}

const char *bringup_outputs_set(char kind, uint32_t number)
{
    if (number > count_of(kind)) {
        return "number";
    }
    if (kind != 'o' && number != 0 && !hal_board_may_move()) {
        return "no_crystal";
    }
    switch_all(kind, number);
    outputs.on = number != 0;
    outputs.off_tick = hal_time_now() + (uint64_t)ON_MS_MAX * TICKS_PER_MS;
    bringup_wait(SETTLE_MS);
    tell_pins("outputs", output_pins, UNIT_OUTPUTS, BOARD_BO_LEVEL == 1U);
    tell_pins("leds", led_pins, UNIT_MOTORS, BOARD_LED_LEVEL == 1U);
    tell_pins("directions", direction_pins, UNIT_MOTORS, BOARD_DIR_LEVEL == 1U);
    tell_pins("steps", step_pins, UNIT_MOTORS, BOARD_STEP_LEVEL == 1U);
    tell_pins("enables", enable_pins, ENABLES, BOARD_ENABLE_LEVEL == 1U);
    tell_inputs();
    return NULL;
}

void bringup_outputs_watch(void)
{
    if (outputs.on && hal_time_now() >= outputs.off_tick) {
        switch_all('o', 0);
        outputs.on = false;
    }
}
