#include "base_tick.h"
#include "stm32_private.h"
#include "stm32f4.h"

enum {
    DETECT_2900_MV = 7,    /* of the voltage detector, RM0090 5.4.1 */
    BROWN_OUT_2700_MV = 0, /* level 3, RM0090 5.2.2 */
    BROWN_OUT_MASK = 3,
};
#define WRITE_TICKS_MAX (4U * TICK_HZ) /* the data sheet does not tell it; an erase takes 2 s */

static void wait_until_done(void)
{
    uint32_t start = TIM2_CNT;
    while ((FLASH_SR & FLASH_SR_BSY) != 0 && TIM2_CNT - start < WRITE_TICKS_MAX) {
    }
}

/* Once in the life of a board. From the next power-on on, the part is held in reset while its supply is below 2.7 V,
 * where neither the processor at this clock nor the flash is specified. */
static void set_brown_out_level(void)
{
    FLASH_OPTKEYR = FLASH_OPTION_KEY_1;
    FLASH_OPTKEYR = FLASH_OPTION_KEY_2;
    FLASH_OPTCR = (FLASH_OPTCR & ~FLASH_OPTCR_BOR_LEV((uint32_t)BROWN_OUT_MASK)) |
                  FLASH_OPTCR_BOR_LEV((uint32_t)BROWN_OUT_2700_MV);
    FLASH_OPTCR |= FLASH_OPTCR_OPTSTRT;
    stm32_barrier();
    wait_until_done();
    FLASH_OPTCR |= FLASH_OPTCR_OPTLOCK;
}

void stm32_supply_start(void)
{
    uint32_t level = FLASH_OPTCR & FLASH_OPTCR_BOR_LEV((uint32_t)BROWN_OUT_MASK);
    RCC_APB1ENR |= RCC_APB1ENR_PWREN;
    (void)RCC_APB1ENR;
    PWR_CR |= PWR_CR_PVDE | PWR_CR_PLS((uint32_t)DETECT_2900_MV);
    if (level != FLASH_OPTCR_BOR_LEV((uint32_t)BROWN_OUT_2700_MV) && (PWR_CSR & PWR_CSR_PVDO) == 0) {
        set_brown_out_level();
    }
}
