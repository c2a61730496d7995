/*
 * Four motors whose edges are laid ahead: rings for TIM5_CH1 to CH4 in toggle mode, circular, by streams 2, 4, 0 and 1
 * of channel 6. Every 25 us the update interrupt of TIM2 lays the pulses of the next 50 us, 42 ticks wide. A pulse
 * comes `whole` ticks after the one before, or, `part` times of PARTS, one more.
 */
#include "dma.h"

enum {
    MOTORS = 4,
    RING = 128,
    FIRST = 20000,
    WIDTH = 42,
    REFILL = 2100,
    AHEAD = 2 * REFILL,
    PARTS = 1000,
    END = 84 * 5000,
    FAR = 0x80000000,
    TIM_IRQ = 28,
};

struct motor {
    uint32_t ring[RING];
    uint32_t head; /* edges laid */
    uint32_t tick; /* of the last pulse laid */
    uint32_t whole, part, rest;
};

extern const uint32_t whole[MOTORS], part[MOTORS];
const uint32_t whole[MOTORS] __attribute__((section(".rodata.whole"))) = {210, 210, 210, 210};
const uint32_t part[MOTORS] __attribute__((section(".rodata.part"))) = {0, 0, 0, 0};

static struct motor motors[MOTORS];
static const uint8_t streams[MOTORS] = {2, 4, 0, 1};

static void put_edge(struct motor *motor, uint32_t tick)
{
    motor->ring[motor->head++ % RING] = tick;
}

static void lay(struct motor *motor, uint32_t until)
{
    while ((int32_t)(motor->tick - until) < 0) {
        motor->rest += motor->part;
        motor->tick += motor->whole + (motor->rest >= PARTS);
        motor->rest -= motor->rest >= PARTS ? PARTS : 0;
        put_edge(motor, motor->tick);
        put_edge(motor, motor->tick + WIDTH);
    }
    motor->ring[motor->head % RING] = motor->tick + FAR;
}

__attribute__((section(".ramcode"), noinline)) void tim2_handler(void)
{
    TIM_SR(TIM2) = 0;
    uint32_t until = TIM_CNT(TIM5) + AHEAD;
    for (unsigned i = 0; i < MOTORS; i++) {
        lay(&motors[i], until);
    }
    result[0]++;
    (void)TIM_SR(TIM2);
}

/* The first edge gets into the compare register as all others do, by a request; TIM_EGR makes it. */
static void begin(struct motor *motor, unsigned number)
{
    motor->whole = ((const volatile uint32_t *)whole)[number];
    motor->part = ((const volatile uint32_t *)part)[number];
    motor->tick = FIRST;
    put_edge(motor, FIRST);
    put_edge(motor, FIRST + WIDTH);
    lay(motor, AHEAD);
    set_up(streams[number], &TIM_CCR(TIM5, number + 1), motor->ring, RING,
           CHSEL(6) | CR_WORDS | CR_CIRC | CR_PL_VERY_HIGH);
    enable(streams[number]);
    TIM_EGR(TIM5) = 2u << number;
    wait_cycles(100);
}

int main(void)
{
    run_at_168_mhz();
    switch_on();
    start_counting_cycles();
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~0xFFu) | 0xAA;
    GPIO_AFRL(GPIOA) = 0x2222;
    TIM_CCMR1(TIM5) = 3 << 4 | 3 << 12;
    TIM_CCMR2(TIM5) = 3 << 4 | 3 << 12;
    TIM_CCER(TIM5) = 0x1111;
    TIM_DIER(TIM5) = DIER_CC1DE | DIER_CC2DE | DIER_CC3DE | DIER_CC4DE;
    for (unsigned i = 0; i < MOTORS; i++) {
        begin(&motors[i], i);
    }
    TIM_ARR(TIM2) = REFILL - 1;
    TIM_EGR(TIM2) = 1;
    TIM_SR(TIM2) = 0;
    TIM_DIER(TIM2) = 1;
    NVIC_ISER(0) = 1u << TIM_IRQ;
    TIM_CR1(TIM2) = 1;
    TIM_CR1(TIM5) = 1;
    while (TIM_CNT(TIM5) < END) {
    }
    return 0;
}
