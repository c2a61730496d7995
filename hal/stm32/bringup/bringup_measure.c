#include "base_tick.h"
#include "board.h"
#include "bringup.h"
#include "hal_time.h"
#include "stm32_private.h"
#include "stm32f4.h"

/*
 * The low-speed oscillator, at channel 4 of TIM5 (RM0090 18.4.20), every eighth edge of it: before all else, as TIM5
 * makes steps afterwards. The slowest has 17 kHz (DS8626), so 64 captures take 31 ms at most.
 */
enum {
    CAPTURES = 64,
    EDGES_A_CAPTURE = 8,
    OWN_INPUT = 1, /* CCxS */
    EVERY_EIGHTH = 3,
    FROM_LSI = 1, /* TI4_RMP */
    LIMIT_MS = 2, /* from one capture to the next */
    TURNS_MAX = 100000,
};

/* The reference is measured at 21 MHz and sampled for 480 clocks, 23 us; at least 10 are asked for (DS8626). */
enum {
    CONVERSIONS = 16,
    REFERENCE = 17,
    DIVIDE_BY_4 = 1 << 16,  /* ADCPRE */
    REFERENCE_ON = 1 << 23, /* TSVREFE */
    SAMPLE_480 = 7 << 21,   /* SMP17 */
    START_US = 20,          /* of the reference and of the converter, 10 and 3 at most */
    CALIBRATED_AT_MV = 3300,
};

/* Where the factory has left what it has measured at 3.3 V (DS8626, VREFIN_CAL). */
static const uint32_t calibration_at = 0x1FFF7A2AU;

static uint32_t lsi_hz;

static uint32_t timer_hz(void)
{
    return bringup_timer_hz(stm32_board_clock.apb1_hz);
}

static void start_oscillator(void)
{
    RCC_CSR |= RCC_CSR_LSION;
    for (uint32_t turns = 0; turns < (uint32_t)TURNS_MAX && (RCC_CSR & RCC_CSR_LSIRDY) == 0; turns++) {
    }
}

static void start_capture(void)
{
    stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_TIM5EN);
    TIM5_OR = TIM5_OR_TI4_RMP((uint32_t)FROM_LSI);
    TIM5_CCMR2 = TIM5_CCMR2_CC4S((uint32_t)OWN_INPUT) | TIM5_CCMR2_IC4PSC((uint32_t)EVERY_EIGHTH);
    TIM_CCER(TIM5_BASE) = TIM_CCER_CC4E;
    TIM_CR1(TIM5_BASE) = TIM_CR1_CEN;
}

/* As after a reset. */
static void end_capture(void)
{
    RCC_APB1RSTR |= RCC_APB1RSTR_TIM5RST;
    RCC_APB1RSTR &= ~RCC_APB1RSTR_TIM5RST;
    RCC_APB1ENR &= ~RCC_APB1ENR_TIM5EN;
}

/* False: none has come in time. */
static bool wait_for_capture(uint32_t *tick)
{
    uint32_t begin = TIM_CNT(TIM5_BASE);
    while ((TIM_SR(TIM5_BASE) & TIM_SR_CC4IF) == 0) {
        if (TIM_CNT(TIM5_BASE) - begin > timer_hz() / 1000U * LIMIT_MS) {
            return false;
        }
    }
    *tick = TIM5_CCR4;
    return true;
}

void bringup_measure_oscillator(void)
{
    uint32_t first = 0;
    uint32_t last = 0;
    start_oscillator();
    start_capture();
    bool comes = wait_for_capture(&first);
    for (uint32_t i = 0; comes && i < CAPTURES; i++) {
        comes = wait_for_capture(&last);
    }
    end_capture();
    uint64_t edges = (uint64_t)CAPTURES * EDGES_A_CAPTURE;
    lsi_hz = comes ? (uint32_t)(edges * timer_hz() / (last - first)) : 0U;
}

static void tell(const char *name, uint32_t value)
{
    say_name(name);
    say_decimal(value);
    say_line_end();
}

void bringup_measure_tell_oscillator(void)
{
    tell("lsi_hz", lsi_hz);
}

static void wait_us(uint32_t microseconds)
{
    uint64_t end = hal_time_now() + (uint64_t)microseconds * TICKS_PER_US;
    while (hal_time_now() < end) {
    }
}

static void start_converter(void)
{
    stm32_enable_clock(&RCC_APB2ENR, RCC_APB2ENR_ADC1EN);
    C_ADC_CCR = REFERENCE_ON | DIVIDE_BY_4;
    ADC1_SMPR1 = SAMPLE_480;
    ADC1_SQR3 = ADC1_SQR3_SQ1((uint32_t)REFERENCE);
    ADC1_CR2 = ADC1_CR2_ADON;
    wait_us(START_US);
}

static void end_converter(void)
{
    ADC1_CR2 = 0;
    C_ADC_CCR = 0;
    RCC_APB2ENR &= ~RCC_APB2ENR_ADC1EN;
}

/* 0: it does not come to its end. */
static uint32_t convert(void)
{
    ADC1_CR2 = ADC1_CR2_ADON | ADC1_CR2_SWSTART;
    for (uint32_t turns = 0; turns < (uint32_t)TURNS_MAX; turns++) {
        if ((ADC1_SR & ADC1_SR_EOC) != 0) {
            return ADC1_DR;
        }
    }
    return 0;
}

void bringup_measure_tell_supply(void)
{
    uint32_t calibration = *(const volatile uint16_t *)(uintptr_t)calibration_at;
    uint32_t sum = 0;
    start_converter();
    for (uint32_t i = 0; i < CONVERSIONS; i++) {
        sum += convert();
    }
    end_converter();
    tell("reference_sum", sum);
    tell("calibration", calibration);
    tell("supply_mv", sum == 0 ? 0U : CALIBRATED_AT_MV * calibration * CONVERSIONS / sum);
    tell("detector_good", (PWR_CSR & PWR_CSR_PVDO) == 0 ? 1U : 0U);
}
