#include <assert.h>
#include <stddef.h>

#include "hal_io.h"
#include "stm32_pins.h"
#include "stm32_private.h"
#include "stm32f4.h"

/*
 * A channel of TIM4 in PWM mode 1 (RM0090 18.3.9): the pin is 1 while the counter is below the value of the channel, so
 * 0 is never and more than the counter gets to is always. A value comes into force when the counter begins anew.
 */
enum {
    COUNTS_HZ = 1000000,
    COUNTS = COUNTS_HZ / 1000, /* of a period */
    MODE_LOW = 4,              /* forced inactive, 18.4.7 */
    MODE_PWM = 6,

    CHANNEL_TIM4_CH1 = 0,
    CHANNEL_TIM4_CH2 = 1,
    CHANNEL_TIM4_CH3 = 2,
    CHANNEL_TIM4_CH4 = 3,
    NO_CHANNEL = UINT8_MAX
};
static_assert(COUNTS - HAL_IO_PWM_MAX == 0, "a count is a thousandth of a period");

static const uint8_t channels[] = {
#define X(signal, port, pin, use) CHANNEL_##use,
    STM32_PWM_PINS(X)
#undef X
        NO_CHANNEL,
};

/* Two channels share a register. Those that have no pin do the same. */
static void set_modes(uint32_t mode, uint32_t preload)
{
    uint32_t both = TIM_CCMR1_OC1M(mode) | TIM_CCMR1_OC2M(mode) | preload;
    TIM_CCMR1(TIM4_BASE) = both;
    TIM_CCMR2(TIM4_BASE) = both;
}

static void set_compare(size_t channel, uint32_t counts)
{
    *(&TIM_CCR1(TIM4_BASE) + channels[channel]) = counts;
}

void hal_io_write_pwm(uint32_t permille)
{
    for (size_t i = 0; channels[i] != NO_CHANNEL; i++) {
        set_compare(i, permille);
    }
}

void stm32_pwm_make_safe(void)
{
    for (size_t i = 0; channels[i] != NO_CHANNEL; i++) {
        stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_TIM4EN);
        set_modes(MODE_LOW, 0);
    }
}

/* The timers of a bus that is slower than the processor have twice its clock (RM0090 7.2). */
static void start_timer(const struct stm32_clock *clock)
{
    uint32_t timer_hz = clock->apb1_hz == clock->core_hz ? clock->core_hz : 2U * clock->apb1_hz;
    TIM_CR1(TIM4_BASE) = 0;
    TIM_PSC(TIM4_BASE) = timer_hz / (uint32_t)COUNTS_HZ - 1U;
    TIM_ARR(TIM4_BASE) = COUNTS - 1;
    set_modes(MODE_PWM, TIM_CCMR1_OC1PE | TIM_CCMR1_OC2PE);
    TIM_EGR(TIM4_BASE) = TIM_EGR_UG;
    TIM_CR1(TIM4_BASE) = TIM_CR1_CEN | TIM_CR1_ARPE;
}

void stm32_pwm_start(const struct stm32_clock *clock)
{
    const uint32_t enable = TIM_CCER_CC1E | (STM32_PWM_LEVEL == 1U ? 0U : TIM_CCER_CC1P);
    stm32_pwm_make_safe();
    for (size_t i = 0; channels[i] != NO_CHANNEL; i++) {
        set_compare(i, 0);
        start_timer(clock);
        TIM_CCER(TIM4_BASE) = enable << (4U * channels[i]);
    }
}
