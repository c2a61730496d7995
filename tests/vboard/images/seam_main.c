/*
 * What the seam gives a unit with a line of full duplex, one thing after the other as constants in flash say: every
 * byte that comes is sent back, motors step at a constant rate, PWM, LEDs and polarities change. Not of any unit.
 */
#include <assert.h>
#include <stddef.h>

#include "base_limits.h"
#include "base_tick.h"
#include "hal_board.h"
#include "hal_io.h"
#include "hal_line.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"

enum {
    HEARD_MAX = 4096,
    ACTS = 16,
    ACT_MS = 5,
    BEGIN_MS = 40,
    QUEUE_MAX = 1024, /* bytes that wait to be sent back */
};

/* Ticks between two pulses of each motor, or 0; acts, 5 ms each from 40 ms on: PWM and LEDs, and polarities as EEPROM
 * 05 of GVE134 has them. */
extern const uint32_t seam_interval_ticks[UNIT_MOTORS];
const uint32_t seam_interval_ticks[UNIT_MOTORS] __attribute__((section(".rodata.seam_interval_ticks"))) = {0, 0, 0, 0};
extern const uint32_t seam_pwm[ACTS];
const uint32_t seam_pwm[ACTS] __attribute__((section(".rodata.seam_pwm"))) = {0};
extern const uint8_t seam_leds[ACTS];
const uint8_t seam_leds[ACTS] __attribute__((section(".rodata.seam_leds"))) = {0};
extern const uint8_t seam_polarity[ACTS];
const uint8_t seam_polarity[ACTS] __attribute__((section(".rodata.seam_polarity"))) = {
    0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF,
};
/* Steps of each motor in each act, backward in every second one. */
extern const uint32_t seam_steps;
const uint32_t seam_steps __attribute__((section(".rodata.seam_steps"))) = 0;
/* An assertion fails in this act; 0: none. */
extern const uint32_t seam_fails;
const uint32_t seam_fails __attribute__((section(".rodata.seam_fails"))) = 0;

extern uint32_t seam_heard;
uint32_t seam_heard;
extern uint32_t seam_broken[HEARD_MAX / 32];
uint32_t seam_broken[HEARD_MAX / 32];

/* What is in flash in that run. */
#define SET(constant) (*(const volatile __typeof__(constant) *)&(constant))

static struct {
    uint8_t queue[QUEUE_MAX];
    uint32_t in;
    uint32_t out;
    uint32_t next_tick[UNIT_MOTORS];
    uint32_t left[UNIT_MOTORS];
} seam;

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    uint32_t interval = SET(seam_interval_ticks[motor]);
    unsigned count = 0;
    (void)context;
    while (interval != 0 && count < room->count && seam.left[motor] != 0 &&
           (count == 0 || (int32_t)(seam.next_tick[motor] - room->until_tick) < 0)) {
        room->pulse[count] = (struct hal_step_pulse){seam.next_tick[motor], seam.next_tick[motor] + room->high_ticks};
        seam.next_tick[motor] += interval;
        seam.left[motor]--;
        count++;
    }
    return count;
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
}

static void plan_isr(void *context)
{
    (void)context;
}

static void run_motors(uint32_t steps)
{
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        if (SET(seam_interval_ticks[motor]) != 0) {
            seam.next_tick[motor] = (uint32_t)hal_time_now() + (uint32_t)TICKS_PER_MS / 5U;
            seam.left[motor] = steps;
            hal_step_hold();
            hal_step_run(motor);
            hal_step_release();
        }
    }
}

static void act(uint32_t number)
{
    uint8_t polarity = SET(seam_polarity[number]);
    assert(SET(seam_fails) == 0 || number != SET(seam_fails));
    hal_io_write_pwm(SET(seam_pwm[number]));
    for (unsigned led = 0; led < (unsigned)HAL_IO_LEDS; led++) {
        hal_io_set_led(led, (SET(seam_leds[number]) >> led & 1U) != 0);
    }
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        hal_step_set_polarity(motor, (polarity >> motor & 1U) == 0, (polarity >> (motor + 4U) & 1U) == 0);
        if (SET(seam_steps) != 0) {
            hal_step_set_direction(motor, number % 2U != 0);
        }
    }
    if (SET(seam_steps) != 0) {
        run_motors(SET(seam_steps));
    }
}

static void hear(void)
{
    struct hal_line_byte byte;
    while (seam.in - seam.out < (uint32_t)QUEUE_MAX && hal_line_read(&byte)) {
        if (seam_heard < (uint32_t)HEARD_MAX && byte.broken) {
            seam_broken[seam_heard / 32U] |= UINT32_C(1) << seam_heard % 32U;
        }
        seam_heard++;
        seam.queue[seam.in % QUEUE_MAX] = byte.value;
        seam.in++;
    }
    while (seam.out != seam.in && hal_line_write(seam.queue[seam.out % QUEUE_MAX])) {
        seam.out++;
    }
}

int main(void)
{
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    uint32_t acts = 0;
    hal_board_init();
    hal_run_start(&client);
    uint64_t begin = hal_time_now();
    if (SET(seam_steps) == 0) {
        run_motors(UINT32_MAX);
    }
    for (;;) {
        uint64_t due = begin + (uint64_t)TICKS_PER_MS * (BEGIN_MS + ACT_MS * acts);
        if (acts < (uint32_t)ACTS && hal_time_now() >= due) {
            act(acts++);
        }
        hear();
        hal_board_idle(acts < (uint32_t)ACTS ? due : hal_time_now() + TICKS_PER_MS);
    }
}
