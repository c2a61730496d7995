/*
 * ADC1 (RM0090 chapter 13), as far as the supply is measured by it: single conversions of 12 bits, started by software,
 * of channel 17, the internal reference. Times and limits are those of the data sheet DS8626, tables "ADC
 * characteristics" and "embedded internal reference voltage".
 */
#ifndef ADC_H
#define ADC_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "conditions.h"
#include "report.h"

enum {
    ADC_REFERENCE_MV = 1210, /* typical; 1180 to 1240 */
    ADC_FULL_SCALE = 4095,
    /* What the factory has measured at 3.3 V, and left in the part: VREFIN_CAL. */
    ADC_CALIBRATION = (ADC_REFERENCE_MV * ADC_FULL_SCALE + 3300 / 2) / 3300,
};

struct adc_wires {
    struct clock *clock;
    struct report *report;
    const struct conditions *conditions;
};

struct adc {
    struct adc_wires wires;
    uint32_t cr2;
    uint32_t smpr1;
    uint32_t smpr2;
    uint32_t sqr3;
    uint32_t common; /* CCR of all three converters */
    uint32_t data;
    bool started;          /* STRT */
    bool ended;            /* EOC */
    uint64_t stable_ps;    /* from then on it may convert; NEVER: off */
    uint64_t reference_ps; /* and the reference may be converted */
    uint64_t end_ps;       /* of the conversion that runs; NEVER: none */
};

void adc_init(struct adc *adc, struct adc_wires wires);
void adc_reset(struct adc *adc);

/* Registers of a struct adc; those of all three converters are at 300. */
bool adc_read(void *model, uint32_t offset, uint32_t *value);
bool adc_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

#endif
