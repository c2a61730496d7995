#include "rcc.h"

enum {
    RCC_CR = 0x00,
    RCC_CIR = 0x0C,
    RCC_AHB1RSTR = 0x10,
    RCC_APB1RSTR = 0x20,
    RCC_APB2RSTR = 0x24,
    RCC_AHB2ENR = 0x34,
    RCC_AHB3ENR = 0x38,
    RCC_AHB1LPENR = 0x50,
    RCC_APB2LPENR = 0x64,
    RCC_BDCR = 0x70,
    RCC_CSR = 0x74,
    RCC_SSCGR = 0x80,
    RCC_PLLI2SCFGR = 0x84,
};

#define CR_HSION (UINT32_C(1) << 0)
#define CR_HSIRDY (UINT32_C(1) << 1)
#define CR_HSEON (UINT32_C(1) << 16)
#define CR_HSERDY (UINT32_C(1) << 17)
#define CR_CSSON (UINT32_C(1) << 19)
#define CR_PLLON (UINT32_C(1) << 24)
#define CR_PLLRDY (UINT32_C(1) << 25)
#define CR_PLLI2SON (UINT32_C(1) << 26) /* kept; ready at once */
#define CR_PLLI2SRDY (UINT32_C(1) << 27)
#define CR_HSEBYP (UINT32_C(1) << 18)
#define CR_WRITABLE (CR_HSION | (UINT32_C(0x1F) << 3) | CR_HSEON | CR_HSEBYP | CR_CSSON | CR_PLLON | CR_PLLI2SON)
#define CR_RESET (CR_HSION | UINT32_C(0x80))
#define PLLCFGR_RESET UINT32_C(0x24003010)
#define AHB1ENR_CCM (UINT32_C(1) << 20) /* the core-coupled memory */
#define PLLCFGR_USABLE UINT32_C(0x0F437FFF)
#define CIR_CSSF (UINT32_C(1) << 7)
#define CIR_CSSC (UINT32_C(1) << 23)
#define CIR_ENABLES UINT32_C(0x3F00)
#define CSR_LSION (UINT32_C(1) << 0)
#define CSR_LSIRDY (UINT32_C(1) << 1)
#define CSR_RMVF (UINT32_C(1) << 24)
#define CSR_FLAGS_POWER UINT32_C(0x0E000000)     /* POR, PIN, BOR */
#define CSR_FLAGS_BROWN_OUT UINT32_C(0x06000000) /* BOR, PIN */
#define CSR_FLAGS_PIN UINT32_C(0x04000000)
#define CSR_FLAGS_SOFTWARE UINT32_C(0x14000000) /* SFT, and PIN, as the part pulls NRST itself */
#define CSR_FLAGS_WATCHDOG UINT32_C(0x24000000) /* IWDG and PIN */

/* Start-up times, typical, from the data sheet of the STM32F405 (tables of HSE, HSI, LSI and PLL). */
#define HSE_START_PS (2 * VTIME_PS_PER_MS)
#define HSI_START_PS (2 * VTIME_PS_PER_US)
#define LSI_START_PS (15 * VTIME_PS_PER_US)
#define PLL_LOCK_PS (200 * VTIME_PS_PER_US)

/* HSERDY goes low six of its cycles after HSEON (RM0090 section 7.3.1). How long PLLRDY takes is not said; assumed. */
#define HSE_STOP_CYCLES 6
#define PLL_STOP_PS VTIME_PS_PER_US

/* Errata ES0182, "delay after an RCC peripheral clock enabling": an access too short after the enable is lost: 2
 * cycles of AHB, or 1 + the divider of APB. The write itself is on its way for 2 more: with a store, a read-back and a
 * store at once the second one was lost on a part. */
enum {
    ENABLE_CYCLES_AHB = 2,
    ENABLE_CYCLES_APB = 1,
    ENABLE_WAY_CYCLES = 2
};

static uint32_t *word(struct rcc *rcc, uint32_t offset)
{
    return &rcc->word[offset / 4U];
}

static uint64_t ready_ps(const struct rcc *rcc, unsigned source)
{
    const uint64_t ready[] = {rcc->hsi_ready_ps, rcc->hse_ready_ps, rcc->pll_ready_ps};
    return ready[source];
}

/* The switch waits until the source that was asked for is ready (RM0090 section 7.2.6). */
static void update_switch(struct rcc *rcc)
{
    unsigned wanted = *word(rcc, RCC_CFGR) & 3U;
    if (wanted > RCC_SOURCE_PLL) {
        report_fail(rcc->wires.report, "RCC_CFGR asks for a system clock that does not exist");
        return;
    }
    uint64_t ready = ready_ps(rcc, wanted);
    bool is_ready = ready <= clock_now_ps(rcc->wires.clock);
    if (is_ready) {
        rcc->source = wanted;
    }
    clock_set_ps(rcc->wires.clock, EVENT_RCC, is_ready ? VTIME_NEVER : ready);
    rcc_apply(rcc);
}

static void on_rcc_event(void *model, uint64_t cycle)
{
    struct rcc *rcc = model;
    (void)cycle;
    update_switch(rcc);
}

static uint64_t started(struct rcc *rcc, uint64_t ready, bool on, uint64_t start_ps)
{
    if (!on) {
        return VTIME_NEVER;
    }
    return ready != VTIME_NEVER ? ready : clock_now_ps(rcc->wires.clock) + start_ps;
}

static uint32_t ready_bits(struct rcc *rcc)
{
    uint64_t now = clock_now_ps(rcc->wires.clock);
    bool hse = rcc->hse_ready_ps <= now || now < rcc->hse_gone_ps;
    bool pll = rcc->pll_ready_ps <= now || now < rcc->pll_gone_ps;
    return (rcc->hsi_ready_ps <= now ? CR_HSIRDY : 0U) | (hse ? CR_HSERDY : 0U) | (pll ? CR_PLLRDY : 0U);
}

static void check_bypass(struct rcc *rcc, uint32_t value)
{
    bool changes = ((*word(rcc, RCC_CR) ^ value) & CR_HSEBYP) != 0;
    if (changes && (ready_bits(rcc) & CR_HSERDY) != 0) {
        report_fail(rcc->wires.report, "RCC_CR: HSEBYP must be written only while the crystal's oscillator is off");
    }
}

/* What is switched off is seen to be off a little later. */
static void note_stops(struct rcc *rcc, uint32_t value)
{
    uint64_t now = clock_now_ps(rcc->wires.clock);
    if ((value & CR_HSEON) == 0 && rcc->hse_ready_ps <= now) {
        rcc->hse_gone_ps = now + HSE_STOP_CYCLES * VTIME_PS_PER_SECOND / rcc->wires.crystal_hz;
    }
    if ((value & CR_PLLON) == 0 && rcc->pll_ready_ps <= now) {
        rcc->pll_gone_ps = now + PLL_STOP_PS;
    }
}

static void write_cr(struct rcc *rcc, uint32_t value)
{
    check_bypass(rcc, value);
    note_stops(rcc, value);
    *word(rcc, RCC_CR) = value & CR_WRITABLE;
    bool crystal = (value & CR_HSEON) != 0 && rcc->wires.has_crystal && !rcc->crystal_failed;
    rcc->hsi_ready_ps = started(rcc, rcc->hsi_ready_ps, (value & CR_HSION) != 0, HSI_START_PS);
    rcc->hse_ready_ps = started(rcc, rcc->hse_ready_ps, crystal, HSE_START_PS);
    bool locks = (value & CR_PLLON) != 0;
    if ((*word(rcc, RCC_PLLCFGR) & RCC_PLLCFGR_HSE) != 0 && rcc->hse_ready_ps > clock_now_ps(rcc->wires.clock)) {
        locks = false;
    }
    rcc->pll_ready_ps = started(rcc, rcc->pll_ready_ps, locks, PLL_LOCK_PS);
    uint32_t needed = rcc->source == RCC_SOURCE_HSE ? CR_HSEON : CR_PLLON;
    if (rcc->source != RCC_SOURCE_HSI && (value & needed) == 0) {
        report_fail(rcc->wires.report, "RCC_CR switches off the clock that the processor runs on");
    }
    update_switch(rcc);
}

bool rcc_lsi_runs(const struct rcc *rcc)
{
    return rcc->lsi_ready_ps <= clock_now_ps(rcc->wires.clock);
}

void rcc_start_lsi(struct rcc *rcc)
{
    *word(rcc, RCC_CSR) |= CSR_LSION;
    rcc->lsi_ready_ps = started(rcc, rcc->lsi_ready_ps, true, LSI_START_PS);
}

static void write_csr(struct rcc *rcc, uint32_t value)
{
    *word(rcc, RCC_CSR) = value & CSR_LSION;
    rcc->lsi_ready_ps = started(rcc, rcc->lsi_ready_ps, (value & CSR_LSION) != 0, LSI_START_PS);
    if ((value & CSR_RMVF) != 0) {
        rcc->reset_flags = 0;
    }
}

/* The crystal stops: with the clock security system on, the part goes on with HSI and an NMI (section 7.2.7). */
static void on_rcc_crystal_event(void *model, uint64_t cycle)
{
    struct rcc *rcc = model;
    bool on_crystal = rcc->source == RCC_SOURCE_HSE ||
                      (rcc->source == RCC_SOURCE_PLL && (*word(rcc, RCC_PLLCFGR) & RCC_PLLCFGR_HSE) != 0);
    bool was_ready = rcc->hse_ready_ps <= clock_now_ps(rcc->wires.clock);
    (void)cycle;
    rcc->crystal_failed = true;
    rcc->hse_ready_ps = VTIME_NEVER;
    if ((*word(rcc, RCC_CR) & CR_CSSON) != 0 && was_ready) {
        *word(rcc, RCC_CR) &= ~(CR_HSEON | CR_CSSON);
        if (on_crystal) {
            *word(rcc, RCC_CR) = (*word(rcc, RCC_CR) & ~CR_PLLON) | CR_HSION;
            *word(rcc, RCC_CFGR) &= ~UINT32_C(3);
            rcc->pll_ready_ps = VTIME_NEVER;
            rcc->hsi_ready_ps = 0;
            update_switch(rcc);
        }
        rcc->css_flag = true;
        nvic_pend(rcc->wires.nvic, NVIC_NMI);
    } else if (on_crystal) {
        rcc->wires.outlet.stop(rcc->wires.outlet.board);
    }
}

bool rcc_clock_is_on(const struct rcc *rcc, uint32_t offset, unsigned bit)
{
    return offset == 0 || (rcc->word[offset / 4U] >> bit & 1U) != 0;
}

static unsigned enable_index(uint32_t offset)
{
    if (offset == RCC_AHB1ENR) {
        return 0;
    }
    return offset == RCC_APB1ENR ? 1U : 2U;
}

bool rcc_clock_has_come(const struct rcc *rcc, uint32_t offset, unsigned bit)
{
    unsigned index = enable_index(offset);
    bool fresh = offset != 0 && (rcc->enabled[index].bits >> bit & 1U) != 0;
    return !fresh || rcc->wires.clock->now >= rcc->enabled[index].cycle;
}

/* The reset registers are at the same distance before the enables (RM0090 sections 7.3.5 to 7.3.14). */
bool rcc_is_held(const struct rcc *rcc, uint32_t offset, unsigned bit)
{
    return offset != 0 && (rcc->word[(offset - (RCC_AHB1ENR - RCC_AHB1RSTR)) / 4U] >> bit & 1U) != 0;
}

static void switch_ccm(struct rcc *rcc)
{
    memory_switch_ccm(rcc->wires.memory, (*word(rcc, RCC_AHB1ENR) & AHB1ENR_CCM) != 0);
    clock_poke(rcc->wires.clock);
}

static void write_enable(struct rcc *rcc, uint32_t offset, uint32_t value)
{
    const uint32_t delays[RCC_ENABLES] = {ENABLE_CYCLES_AHB, ENABLE_CYCLES_APB + rcc->wires.conditions->pclk1_divider,
                                          ENABLE_CYCLES_APB + rcc->wires.conditions->pclk2_divider};
    unsigned index = enable_index(offset);
    uint32_t fresh = value & ~*word(rcc, offset);
    *word(rcc, offset) = value;
    if (offset == RCC_AHB1ENR) {
        switch_ccm(rcc);
    }
    if (fresh != 0) {
        uint32_t coming = rcc->wires.clock->now < rcc->enabled[index].cycle ? rcc->enabled[index].bits : 0U;
        rcc->enabled[index].bits = coming | fresh;
        rcc->enabled[index].cycle = rcc->wires.clock->now + ENABLE_WAY_CYCLES + delays[index];
    }
}

/* M and N for a comparison at 2 MHz and 240 MHz; P = 4, Q = 5; APB1 at a half. */
void rcc_run_from_pll(struct rcc *rcc)
{
    bool from_crystal = rcc->wires.has_crystal;
    uint64_t now = clock_now_ps(rcc->wires.clock);
    uint32_t m = from_crystal ? (uint32_t)(rcc->wires.crystal_hz / 2000000U) : 8U;
    *word(rcc, RCC_PLLCFGR) = m | 120U << 6 | 1U << 16 | (from_crystal ? RCC_PLLCFGR_HSE : 0U) | 5U << 24;
    *word(rcc, RCC_CR) |= CR_PLLON | CR_PLLI2SON | (from_crystal ? CR_HSEON | CR_CSSON : 0U);
    *word(rcc, RCC_CFGR) = RCC_SOURCE_PLL | 4U << 10;
    *word(rcc, RCC_AHB1ENR) = 0;
    *word(rcc, RCC_APB2ENR) = UINT32_C(1) << 4;
    switch_ccm(rcc);
    rcc->hse_ready_ps = from_crystal ? now : VTIME_NEVER;
    rcc->pll_ready_ps = now;
    update_switch(rcc);
}

/* The flags stay until they are cleared, or the supply has been too low. */
static uint32_t flags_of(enum reset_cause cause, uint32_t before)
{
    static const uint32_t flags[RESET_CAUSES] = {
        [RESET_POWER] = CSR_FLAGS_POWER,       [RESET_BROWN_OUT] = CSR_FLAGS_BROWN_OUT,
        [RESET_SOFTWARE] = CSR_FLAGS_SOFTWARE, [RESET_WATCHDOG] = CSR_FLAGS_WATCHDOG,
        [RESET_PIN] = CSR_FLAGS_PIN,
    };
    bool supply = cause == RESET_POWER || cause == RESET_BROWN_OUT;
    return flags[cause] | (supply ? 0U : before);
}

void rcc_reset(struct rcc *rcc, enum reset_cause cause)
{
    uint32_t flags = flags_of(cause, rcc->reset_flags);
    bool failed = rcc->crystal_failed;
    struct conditions *conditions = rcc->wires.conditions;
    conditions->pclk1_divider = 0;
    conditions->pclk2_divider = 0;
    conditions->timer1_divider = 0;
    conditions->timer2_divider = 0;
    *rcc = (struct rcc){
        .wires = rcc->wires, .hse_ready_ps = VTIME_NEVER, .pll_ready_ps = VTIME_NEVER, .lsi_ready_ps = VTIME_NEVER};
    rcc->reset_flags = flags;
    rcc->crystal_failed = failed;
    *word(rcc, RCC_CR) = CR_RESET;
    *word(rcc, RCC_PLLCFGR) = PLLCFGR_RESET;
    *word(rcc, RCC_AHB1ENR) = AHB1ENR_CCM;
    switch_ccm(rcc);
    *word(rcc, RCC_AHB1LPENR) = UINT32_C(0x7E6791FF);
    *word(rcc, 0x54) = UINT32_C(0x000000F1);
    *word(rcc, 0x58) = UINT32_C(0x00000001);
    *word(rcc, 0x60) = UINT32_C(0x36FEC9FF);
    *word(rcc, RCC_APB2LPENR) = UINT32_C(0x00075F33);
    *word(rcc, RCC_PLLI2SCFGR) = UINT32_C(0x20003000);
    clock_set(rcc->wires.clock, EVENT_RCC, VTIME_NEVER);
    rcc_apply(rcc);
}

static bool is_known(uint32_t offset)
{
    static const uint8_t offsets[] = {RCC_CR,      RCC_PLLCFGR, RCC_CFGR, RCC_CIR,     0x10,          0x14,
                                      0x18,        0x20,        0x24,     RCC_AHB1ENR, RCC_AHB2ENR,   RCC_AHB3ENR,
                                      RCC_APB1ENR, RCC_APB2ENR, 0x50,     0x54,        0x58,          0x60,
                                      0x64,        RCC_BDCR,    RCC_CSR,  RCC_SSCGR,   RCC_PLLI2SCFGR};
    for (unsigned i = 0; i < sizeof offsets; i++) {
        if (offsets[i] == offset) {
            return true;
        }
    }
    return false;
}

bool rcc_read(void *model, uint32_t offset, uint32_t *value)
{
    struct rcc *rcc = model;
    if (!is_known(offset)) {
        return false;
    }
    *value = *word(rcc, offset);
    if (offset == RCC_CR) {
        *value |= ready_bits(rcc) | ((*value & CR_PLLI2SON) != 0 ? CR_PLLI2SRDY : 0U);
    } else if (offset == RCC_CFGR) {
        *value = (*value & ~UINT32_C(0xC)) | rcc->source << 2;
    } else if (offset == RCC_CIR) {
        *value |= rcc->css_flag ? CIR_CSSF : 0U;
    } else if (offset == RCC_CSR) {
        *value |= rcc->reset_flags | (rcc_lsi_runs(rcc) ? CSR_LSIRDY : 0U);
    }
    return true;
}

static void write_pllcfgr(struct rcc *rcc, uint32_t value)
{
    if ((*word(rcc, RCC_CR) & (CR_PLLON | CR_PLLI2SON)) != 0 || (ready_bits(rcc) & CR_PLLRDY) != 0) {
        report_fail(rcc->wires.report, "RCC_PLLCFGR must be written only while the PLL is off, and the one of I2S");
    }
    if (((value ^ PLLCFGR_RESET) & ~PLLCFGR_USABLE) != 0) {
        report_fail(rcc->wires.report,
                    "RCC_PLLCFGR: reserved bits must be kept at their reset value, %08x (RM0090 7.3.2)",
                    PLLCFGR_RESET & ~PLLCFGR_USABLE);
    }
    *word(rcc, RCC_PLLCFGR) = value;
}

static void write_cir(struct rcc *rcc, uint32_t value)
{
    if ((value & CIR_ENABLES) != 0) {
        report_fail(rcc->wires.report, "RCC_CIR: interrupts of ready clocks are not modelled");
    }
    if ((value & CIR_CSSC) != 0) {
        rcc->css_flag = false;
    }
}

bool rcc_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct rcc *rcc = model;
    if (!is_known(offset)) {
        return false;
    }
    uint32_t whole = (*word(rcc, offset) & ~mask) | (value & mask);
    switch (offset) {
    case RCC_CR:
        write_cr(rcc, whole);
        return true;
    case RCC_PLLCFGR:
        write_pllcfgr(rcc, whole);
        return true;
    case RCC_CFGR:
        *word(rcc, RCC_CFGR) = whole & ~UINT32_C(0xC);
        update_switch(rcc);
        return true;
    case RCC_CIR:
        write_cir(rcc, value & mask);
        return true;
    case RCC_AHB1ENR:
    case RCC_APB1ENR:
    case RCC_APB2ENR:
        write_enable(rcc, offset, whole);
        return true;
    case RCC_CSR:
        write_csr(rcc, whole);
        return true;
    case RCC_AHB1RSTR:
    case RCC_APB1RSTR:
    case RCC_APB2RSTR:
        *word(rcc, offset) = whole;
        rcc->wires.outlet.reset(rcc->wires.outlet.board, offset, whole);
        return true;
    default:
        *word(rcc, offset) = whole;
        return true;
    }
}

void rcc_init(struct rcc *rcc, struct rcc_wires wires)
{
    rcc->wires = wires;
    clock_attach(wires.clock, EVENT_RCC, on_rcc_event, rcc);
    clock_attach(wires.clock, EVENT_CRYSTAL, on_rcc_crystal_event, rcc);
}
