#include <assert.h>

#include "board.h"
#include "stm32_private.h"
#include "stm32_supply.h"
#include "stm32f4.h"

static_assert((BOARD_CRYSTAL_MHZ >= 4U) && (BOARD_CRYSTAL_MHZ <= 26U),
              "BOARD_CRYSTAL_MHZ must be 4 to 26, what the part's oscillator is for (DS8626)");

/*
 * 168 MHz for the core, 42 MHz for APB1 (its timers run at 84 MHz), 84 MHz for APB2. The PLL gets 2 MHz, or 1 MHz from
 * a crystal of odd frequency, makes 336 MHz of it and gives half (RM0090 7.2.3).
 */
enum {
    CORE_HZ = 168000000,
    INTERNAL_HZ = 16000000,
    INTERNAL_MHZ = 16,
    PLL_MHZ = 336,
    USB_DIVIDER = 7,           /* 48 MHz, where nothing is connected; the field must not be below 2 */
    PLL_RESERVED = 0x20000000, /* bits of PLLCFGR that stay as after a reset (RM0090 7.3.2) */

    CLOCK_PLL = 2,
    DIVIDE_BY_2 = 4,
    DIVIDE_BY_4 = 5,
    /* Down to the level at which the board's part is held in reset. */
    WAIT_STATES = STM32_WAIT_STATES(STM32_BROWN_OUT_FALLING_MIN_MV(BOARD_BROWN_OUT_LEVEL)),

    DEVICE = 0x413, /* DBGMCU_IDCODE: STM32F405 and F407 but for revision A (RM0090 38.6.1) */
    DEVICE_MASK = 0xFFF,
    REVISION_PLACE = 16,
    REVISION_A = 0x1000,

    /* A turn of a waiting loop takes at least 4 cycles of 16 MHz: 50 ms or more. A crystal takes 2 ms. */
    TURNS_MAX = 200000,
};

static bool wait_for(const volatile uint32_t *word, uint32_t mask, uint32_t value)
{
    for (uint32_t turns = 0; turns < TURNS_MAX; turns++) {
        if ((*word & mask) == value) {
            return true;
        }
    }
    return false;
}

/* The internal oscillator drives the chip, all else is off: so it is after a reset, and not where a boot loader has
 * started this program. The dividers change only then, as APB1 must not be too fast meanwhile. */
static bool return_to_internal(void)
{
    RCC_CR |= RCC_CR_HSION;
    if (!wait_for(&RCC_CR, RCC_CR_HSIRDY, RCC_CR_HSIRDY)) {
        return false;
    }
    RCC_CFGR &= ~RCC_CFGR_SW(3U);
    if (!wait_for(&RCC_CFGR, RCC_CFGR_SWS(3U), 0)) {
        return false;
    }
    RCC_CFGR = 0;
    RCC_CR &= ~(RCC_CR_CSSON | RCC_CR_PLLON | RCC_CR_PLLI2SON | RCC_CR_HSEON);
    if (!wait_for(&RCC_CR, RCC_CR_PLLRDY | RCC_CR_PLLI2SRDY | RCC_CR_HSERDY, 0)) {
        return false;
    }
    RCC_CR &= ~RCC_CR_HSEBYP;
    return true;
}

static bool start_crystal(void)
{
    RCC_CR |= RCC_CR_HSEON;
    if (wait_for(&RCC_CR, RCC_CR_HSERDY, RCC_CR_HSERDY)) {
        return true;
    }
    RCC_CR &= ~RCC_CR_HSEON;
    return false;
}

static bool start_pll(uint32_t source_mhz, uint32_t source)
{
    uint32_t step_mhz = source_mhz % 2U == 0 ? 2U : 1U;
    RCC_PLLCFGR = (uint32_t)PLL_RESERVED | source | RCC_PLLCFGR_PLLM(source_mhz / step_mhz) |
                  RCC_PLLCFGR_PLLN(PLL_MHZ / step_mhz) | RCC_PLLCFGR_PLLQ((uint32_t)USB_DIVIDER);
    RCC_CR |= RCC_CR_PLLON;
    /* They take effect up to 16 cycles later (RM0090 7.3.3), which are over when the PLL is ready. */
    RCC_CFGR = RCC_CFGR_PPRE1((uint32_t)DIVIDE_BY_4) | RCC_CFGR_PPRE2((uint32_t)DIVIDE_BY_2);
    return wait_for(&RCC_CR, RCC_CR_PLLRDY, RCC_CR_PLLRDY);
}

/* Revision A reads wrong instructions with it, and names itself as an STM32F2 does (errata ES0182). */
static uint32_t prefetch(void)
{
    uint32_t identity = DBG_IDCODE;
    bool known = (identity & (uint32_t)DEVICE_MASK) == (uint32_t)DEVICE;
    return known && identity >> REVISION_PLACE != (uint32_t)REVISION_A ? FLASH_ACR_PRFTEN : 0U;
}

static bool switch_to_pll(void)
{
    FLASH_ACR = FLASH_ACR_LATENCY((uint32_t)WAIT_STATES) | prefetch() | FLASH_ACR_ICEN | FLASH_ACR_DCEN;
    if (!wait_for(&FLASH_ACR, FLASH_ACR_LATENCY(7U), FLASH_ACR_LATENCY((uint32_t)WAIT_STATES))) {
        return false;
    }
    RCC_CFGR |= RCC_CFGR_SW((uint32_t)CLOCK_PLL);
    return wait_for(&RCC_CFGR, RCC_CFGR_SWS(3U), RCC_CFGR_SWS((uint32_t)CLOCK_PLL));
}

/* Without the crystal the internal oscillator drives the PLL: 1 % off when cool, good enough for the line. Without the
 * PLL it drives the chip itself. A crystal that fails later raises the NMI, a fault. */
struct stm32_clock stm32_clock_start(void)
{
    bool internal = return_to_internal();
    bool crystal = internal && start_crystal();
    uint32_t source_mhz = crystal ? BOARD_CRYSTAL_MHZ : (uint32_t)INTERNAL_MHZ;
    if (!internal || !start_pll(source_mhz, crystal ? RCC_PLLCFGR_PLLSRC : 0U) || !switch_to_pll()) {
        RCC_CFGR = 0;
        return (struct stm32_clock){.core_hz = INTERNAL_HZ, .apb1_hz = INTERNAL_HZ, .apb2_hz = INTERNAL_HZ};
    }
    if (crystal) {
        RCC_CR |= RCC_CR_CSSON;
    }
    return (struct stm32_clock){.core_hz = CORE_HZ, .apb1_hz = CORE_HZ / 4, .apb2_hz = CORE_HZ / 2, .crystal = crystal};
}
