#include "adc.h"

#include <stddef.h>

enum {
    ADC_SR = 0x00,
    ADC_CR1 = 0x04,
    ADC_CR2 = 0x08,
    ADC_SMPR1 = 0x0C,
    ADC_SMPR2 = 0x10,
    ADC_SQR1 = 0x2C,
    ADC_SQR2 = 0x30,
    ADC_SQR3 = 0x34,
    ADC_DR = 0x4C,
    ADC_CCR = 0x304,
    SR_EOC = 1 << 1,
    SR_STRT = 1 << 4,
    CR2_ADON = 1 << 0,
    CR2_SWSTART = 1 << 30,
    CCR_PRESCALER_SHIFT = 16,
    REFERENCE = 17,
    FIRST_OF_SMPR1 = 10,
    CONVERTING_CYCLES = 12, /* section 13.5: of 12 bits, after the sampling */
};

#define CCR_PRESCALER (UINT32_C(3) << CCR_PRESCALER_SHIFT)
#define CCR_TSVREFE (UINT32_C(1) << 23)

/* DS8626: tSTAB at the most; the start of the reference, and the least time to sample it. */
#define STABLE_PS (3U * VTIME_PS_PER_US)
#define REFERENCE_PS (10U * VTIME_PS_PER_US)
#define SAMPLE_PS (10U * VTIME_PS_PER_US)
#define LEAST_HZ UINT64_C(600000)
#define MOST_HZ UINT64_C(36000000)
#define MOST_HZ_BELOW_2400_MV UINT64_C(18000000)

static uint64_t now_ps(const struct adc *adc)
{
    return clock_now_ps(adc->wires.clock);
}

static uint64_t clock_hz(const struct adc *adc)
{
    uint64_t divider = UINT64_C(2) * (((adc->common & CCR_PRESCALER) >> CCR_PRESCALER_SHIFT) + 1U);
    return adc->wires.clock->time.hclk_hz / adc->wires.conditions->pclk2_divider / divider;
}

static uint64_t sample_cycles(const struct adc *adc)
{
    static const uint16_t cycles[] = {3, 15, 28, 56, 84, 112, 144, 480}; /* 13.13.4 */
    return cycles[adc->smpr1 >> 3U * (REFERENCE - FIRST_OF_SMPR1) & 7U];
}

static uint64_t ps_of(const struct adc *adc, uint64_t cycles)
{
    return vtime_scale(cycles, VTIME_PS_PER_SECOND, clock_hz(adc));
}

/* What must not be, in words; null: nothing. */
static const char *find_fault(const struct adc *adc)
{
    uint64_t hz = clock_hz(adc);
    uint64_t most = adc->wires.conditions->supply_mv < 2400U ? MOST_HZ_BELOW_2400_MV : MOST_HZ;
    if (adc->stable_ps > now_ps(adc)) {
        return "a conversion is started less than 3 us after ADON, or while it is off (RM0090 13.3.1, DS8626)";
    }
    if (adc->end_ps != VTIME_NEVER && adc->end_ps > now_ps(adc)) {
        return "a conversion is started while one runs";
    }
    if ((adc->sqr3 & 0x1FU) != REFERENCE) {
        return "a channel other than 17 is not modelled";
    }
    if (adc->reference_ps > now_ps(adc)) {
        return "the reference is converted less than 10 us after TSVREFE, or without it (RM0090 13.10, DS8626)";
    }
    if (hz < LEAST_HZ || hz > most) {
        return "its clock is not from 0.6 to 36 MHz, or 18 MHz below 2.4 V (DS8626)";
    }
    return ps_of(adc, sample_cycles(adc)) < SAMPLE_PS ? "the reference is sampled for less than 10 us (DS8626)" : NULL;
}

static void start(struct adc *adc)
{
    const char *fault = find_fault(adc);
    if (fault != NULL) {
        report_fail(adc->wires.report, "ADC1: %s", fault);
        return;
    }
    uint32_t supply_mv = adc->wires.conditions->supply_mv;
    uint32_t value = ((uint32_t)ADC_REFERENCE_MV * ADC_FULL_SCALE + supply_mv / 2U) / supply_mv;
    adc->data = value > ADC_FULL_SCALE ? ADC_FULL_SCALE : value;
    adc->started = true;
    adc->ended = false;
    adc->end_ps = now_ps(adc) + ps_of(adc, sample_cycles(adc) + CONVERTING_CYCLES);
}

static void look_for_end(struct adc *adc)
{
    if (adc->end_ps <= now_ps(adc)) {
        adc->ended = true;
        adc->end_ps = VTIME_NEVER;
    }
}

bool adc_read(void *model, uint32_t offset, uint32_t *value)
{
    struct adc *adc = model;
    look_for_end(adc);
    *value = 0;
    switch (offset) {
    case ADC_SR:
        *value = (adc->ended ? SR_EOC : 0U) | (adc->started ? SR_STRT : 0U);
        return true;
    case ADC_CR2:
        *value = adc->cr2;
        return true;
    case ADC_SMPR1:
        *value = adc->smpr1;
        return true;
    case ADC_SMPR2:
        *value = adc->smpr2;
        return true;
    case ADC_SQR3:
        *value = adc->sqr3;
        return true;
    case ADC_DR: /* reading it clears EOC, section 13.13.1 */
        *value = adc->end_ps == VTIME_NEVER ? adc->data : 0U;
        adc->ended = false;
        return true;
    case ADC_CCR:
        *value = adc->common;
        return true;
    default:
        return offset == ADC_CR1 || offset == ADC_SQR1 || offset == ADC_SQR2;
    }
}

/* 13.13.3: what else it has is not modelled. */
static bool write_cr2(struct adc *adc, uint32_t value)
{
    bool was_on = (adc->cr2 & CR2_ADON) != 0;
    adc->cr2 = value & CR2_ADON;
    if (adc->cr2 == 0) {
        adc->stable_ps = VTIME_NEVER;
        adc->end_ps = VTIME_NEVER;
    } else if (!was_on) {
        adc->stable_ps = now_ps(adc) + STABLE_PS;
    }
    if ((value & (uint32_t)CR2_SWSTART) != 0) {
        start(adc);
    }
    return (value & ~((uint32_t)CR2_ADON | (uint32_t)CR2_SWSTART)) == 0;
}

/* 13.13.16. The clock of a converter that is on is left alone. */
static bool write_common(struct adc *adc, uint32_t value)
{
    if (((value ^ adc->common) & CCR_PRESCALER) != 0 && (adc->cr2 & CR2_ADON) != 0) {
        report_warn(adc->wires.report, "ADC_CCR: the clock of ADC1 is changed while it is on");
    }
    if ((value & CCR_TSVREFE) == 0) {
        adc->reference_ps = VTIME_NEVER;
    } else if ((adc->common & CCR_TSVREFE) == 0) {
        adc->reference_ps = now_ps(adc) + REFERENCE_PS;
    }
    adc->common = value;
    return (value & ~(CCR_PRESCALER | CCR_TSVREFE)) == 0;
}

/* 13.13.1: flags are cleared by 0. */
static void write_status(struct adc *adc, uint32_t value)
{
    adc->ended = adc->ended && (value & SR_EOC) != 0;
    adc->started = adc->started && (value & SR_STRT) != 0;
}

bool adc_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct adc *adc = model;
    look_for_end(adc);
    if (mask != UINT32_MAX) {
        report_fail(adc->wires.report, "ADC: its registers are written as words (RM0090 13.13)");
        return true;
    }
    switch (offset) {
    case ADC_SR:
        write_status(adc, value);
        return true;
    case ADC_CR2:
        return write_cr2(adc, value);
    case ADC_SMPR1:
        adc->smpr1 = value;
        return value >> 27U == 0;
    case ADC_SMPR2:
        adc->smpr2 = value;
        return value >> 30U == 0;
    case ADC_SQR3:
        adc->sqr3 = value;
        return value >> 30U == 0;
    case ADC_CCR:
        return write_common(adc, value);
    default: /* one conversion, of 12 bits, without interrupts */
        return (offset == ADC_CR1 || offset == ADC_SQR1 || offset == ADC_SQR2) && value == 0;
    }
}

void adc_reset(struct adc *adc)
{
    *adc =
        (struct adc){.wires = adc->wires, .stable_ps = VTIME_NEVER, .reference_ps = VTIME_NEVER, .end_ps = VTIME_NEVER};
}

void adc_init(struct adc *adc, struct adc_wires wires)
{
    adc->wires = wires;
}
