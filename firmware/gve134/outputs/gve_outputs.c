#include "gve_outputs.h"

#include <assert.h>

#include "base_tick.h"
#include "hal_io.h"

#define BLINK_TICKS ((uint64_t)TICK_HZ / 2U)
#define DATA_TICKS ((uint64_t)20 * TICKS_PER_MS)
#define BRAKE_UNIT_TICKS ((uint64_t)100 * TICKS_PER_MS)

enum {
    ALL_OFF = 0xFF,
    BRAKE_UNITS_MAX = 0x32,
};

/* Bits of port 0. */
enum {
    PORT_SPINDLE,
    PORT_BRAKE,
    PORT_COOLING,
    PORT_BLOW,
    PORT_LOCK,
    PORT_RELEASE,
    PORT_OPENING,
};

/* Outputs of the board, from 0. */
enum {
    BOARD_RELAY = 0,
    BOARD_OUT_0 = 4,
    BOARD_OUT_1 = 5,
    BOARD_OUT_2 = 6,
    BOARD_OUT_3 = 7,
};

/* Functions of the relay. */
enum {
    RELAY_SPINDLE = 0x00,
    RELAY_LASER = 0x01,
    RELAY_COOLING = 0x02,
    RELAY_BLOW = 0x03,
    RELAY_LOCK = 0x04,
    RELAY_RELEASE = 0x05,
    RELAY_OPENING = 0x06,
    RELAY_BRAKE_OF_Z = 0x08,
    RELAY_INTERRUPT = 0x09,
};

/* LEDs of the board. */
enum {
    LED_POWER,
    LED_RUN,
    LED_DATA,
    LED_RELAY,
    LED_REFERENCES, /* the first of four */
    REFERENCE_MASK = 0x0F,
};

static_assert(LED_REFERENCES + UNIT_MOTORS == HAL_IO_LEDS, "each axis has an LED");

void gve_outputs_init(struct gve_outputs *outputs, struct io *io, bool locked, uint64_t now_ticks)
{
    *outputs = (struct gve_outputs){
        .io = io,
        .free_tick = locked ? TICK_NEVER : now_ticks,
        .data_tick = now_ticks,
        .port = ALL_OFF,
    };
    hal_io_write_pwm(0);
    for (unsigned led = 0; led < (unsigned)HAL_IO_LEDS; led++) {
        hal_io_set_led(led, false);
    }
}

void gve_outputs_write(struct gve_outputs *outputs, uint8_t port)
{
    outputs->port = port;
}

void gve_outputs_spindle(struct gve_outputs *outputs, uint32_t permille)
{
    unsigned bit = 1U << (unsigned)PORT_SPINDLE;
    outputs->port = (uint8_t)(permille == 0 ? outputs->port | bit : outputs->port & ~bit);
    hal_io_write_pwm(permille);
}

void gve_outputs_unlock(struct gve_outputs *outputs, uint64_t now_ticks)
{
    outputs->free_tick = now_ticks;
}

void gve_outputs_note_data(struct gve_outputs *outputs, uint64_t now_ticks)
{
    outputs->data_tick = now_ticks + DATA_TICKS;
}

static bool is_on(const struct gve_outputs *outputs, unsigned bit)
{
    return ((unsigned)outputs->port >> bit & 1U) == 0;
}

/* When the brake is released; TICK_NEVER: it is not. */
static uint64_t release_tick(const struct gve_outputs *outputs, const struct gve_memory *memory)
{
    uint64_t units = memory->bytes[GVE_MEMORY_BRAKE];
    units = units > (uint64_t)BRAKE_UNITS_MAX ? (uint64_t)BRAKE_UNITS_MAX : units;
    return outputs->free_tick == TICK_NEVER ? TICK_NEVER : outputs->free_tick + units * BRAKE_UNIT_TICKS;
}

static bool relay(const struct gve_outputs *outputs, const struct gve_memory *memory, const struct gve_doing *doing,
                  uint64_t now_ticks)
{
    switch (memory->bytes[GVE_MEMORY_RELAY]) {
    case RELAY_SPINDLE:
    case RELAY_LASER:
        return is_on(outputs, PORT_SPINDLE);
    case RELAY_COOLING:
        return is_on(outputs, PORT_COOLING);
    case RELAY_BLOW:
        return is_on(outputs, PORT_BLOW);
    case RELAY_LOCK:
        return is_on(outputs, PORT_LOCK);
    case RELAY_RELEASE:
        return is_on(outputs, PORT_RELEASE);
    case RELAY_OPENING:
        return is_on(outputs, PORT_OPENING);
    case RELAY_BRAKE_OF_Z:
        return !doing->locked && now_ticks >= release_tick(outputs, memory);
    case RELAY_INTERRUPT:
        return doing->inta;
    default:
        return false;
    }
}

static void set_output(const struct gve_outputs *outputs, unsigned output, bool on, uint64_t now_ticks)
{
    if (((outputs->io->outputs >> output & 1U) != 0) != on) {
        io_set(outputs->io, output, on, 0, now_ticks);
    }
}

static void show_leds(struct gve_outputs *outputs, unsigned leds)
{
    unsigned changed = leds ^ outputs->leds;
    for (unsigned led = 0; changed != 0; led++) {
        if ((changed & 1U) != 0) {
            hal_io_set_led(led, (leds >> led & 1U) != 0);
        }
        changed >>= 1U;
    }
    outputs->leds = (uint8_t)leds;
}

static unsigned led_of(unsigned led, bool on)
{
    return on ? 1U << led : 0U;
}

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* The next of the times at which something changes by itself. */
static uint64_t wake_of(const struct gve_outputs *outputs, const struct gve_memory *memory,
                        const struct gve_doing *doing, uint64_t now_ticks)
{
    uint64_t release = release_tick(outputs, memory);
    uint64_t wake = doing->locked ? (now_ticks / BLINK_TICKS + 1U) * BLINK_TICKS : TICK_NEVER;
    wake = outputs->data_tick > now_ticks ? earlier(wake, outputs->data_tick) : wake;
    return release > now_ticks ? earlier(wake, release) : wake;
}

uint64_t gve_outputs_poll(struct gve_outputs *outputs, const struct gve_memory *memory, const struct gve_doing *doing,
                          uint64_t now_ticks)
{
    bool relay_on = relay(outputs, memory, doing, now_ticks);
    set_output(outputs, BOARD_RELAY, relay_on, now_ticks);
    set_output(outputs, BOARD_OUT_0, is_on(outputs, PORT_SPINDLE), now_ticks);
    set_output(outputs, BOARD_OUT_1, is_on(outputs, PORT_COOLING), now_ticks);
    set_output(outputs, BOARD_OUT_2, is_on(outputs, PORT_BLOW), now_ticks);
    set_output(outputs, BOARD_OUT_3, is_on(outputs, PORT_BRAKE), now_ticks);
    show_leds(outputs, led_of(LED_POWER, !doing->locked || now_ticks / BLINK_TICKS % 2U == 0) |
                           led_of(LED_RUN, doing->moves) | led_of(LED_DATA, now_ticks < outputs->data_tick) |
                           led_of(LED_RELAY, relay_on) |
                           ((unsigned)doing->inputs & (unsigned)REFERENCE_MASK) << (unsigned)LED_REFERENCES);
    return wake_of(outputs, memory, doing, now_ticks);
}
