#include "flash.h"

enum {
    FLASH_ACR = 0x00,
    FLASH_KEYR = 0x04,
    FLASH_OPTKEYR = 0x08,
    FLASH_SR = 0x0C,
    FLASH_CR = 0x10,
    FLASH_OPTCR = 0x14,
    SECTORS = 12,
    OPTIONS_MS = 5, /* the data sheet does not say it; a sector of 16 kB takes 250 ms */
};

#define KEY1 UINT32_C(0x45670123)
#define KEY2 UINT32_C(0xCDEF89AB)
#define ACR_LATENCY UINT32_C(7)
#define ACR_PRFTEN (UINT32_C(1) << 8)
#define ACR_ICEN (UINT32_C(1) << 9)
#define ACR_DCEN (UINT32_C(1) << 10)
#define ACR_ICRST (UINT32_C(1) << 11)
#define ACR_DCRST (UINT32_C(1) << 12)
#define ACR_MASK UINT32_C(0x1F07)
#define SR_EOP (UINT32_C(1) << 0)
#define SR_OPERR (UINT32_C(1) << 1)
#define SR_WRPERR (UINT32_C(1) << 4)
#define SR_PGAERR (UINT32_C(1) << 5)
#define SR_PGPERR (UINT32_C(1) << 6)
#define SR_PGSERR (UINT32_C(1) << 7)
#define SR_BSY (UINT32_C(1) << 16)
#define SR_CLEARABLE (SR_EOP | SR_OPERR | SR_WRPERR | SR_PGAERR | SR_PGPERR | SR_PGSERR)
#define SR_ERRORS (SR_CLEARABLE & ~SR_EOP)
#define CR_PG (UINT32_C(1) << 0)
#define CR_SER (UINT32_C(1) << 1)
#define CR_MER (UINT32_C(1) << 2)
#define CR_STRT (UINT32_C(1) << 16)
#define CR_EOPIE (UINT32_C(1) << 24)
#define CR_ERRIE (UINT32_C(1) << 25)
#define CR_LOCK (UINT32_C(1) << 31)
#define CR_MASK UINT32_C(0x8301037F)
#define OPTION_KEY1 UINT32_C(0x08192A3B)
#define OPTION_KEY2 UINT32_C(0x4C5D6E7F)
#define OPTCR_LOCK (UINT32_C(1) << 0)
#define OPTCR_STRT (UINT32_C(1) << 1)
#define OPTCR_MASK UINT32_C(0x0FFFFFEC)

/* RM0090 table 5: four sectors of 16 kB, one of 64 kB, seven of 128 kB. */
static uint32_t sector_base(unsigned sector)
{
    static const uint32_t kilobytes[SECTORS] = {0, 16, 32, 48, 64, 128, 256, 384, 512, 640, 768, 896};
    return kilobytes[sector] * 1024U;
}

static uint32_t sector_bytes(unsigned sector)
{
    return (sector + 1U < SECTORS ? sector_base(sector + 1U) : MEMORY_FLASH_BYTES) - sector_base(sector);
}

/* Times of the data sheet (table of the flash memory's programming), for each size of access; microseconds. */
static uint64_t program_us(const struct flash *flash)
{
    return flash->wires.settings->slow ? 100 : 16;
}

static uint64_t erase_us(const struct flash *flash, uint32_t bytes, unsigned size)
{
    if (flash->wires.settings->erase_us != 0) {
        return flash->wires.settings->erase_us;
    }
    static const uint32_t typical_ms[3][3] = {{400, 300, 250}, {1200, 700, 550}, {2000, 1300, 1000}};
    unsigned row = (bytes > 16U * 1024U ? 1U : 0U) + (bytes > 64U * 1024U ? 1U : 0U);
    uint64_t us = 1000U * (uint64_t)typical_ms[row][size > 2 ? 2 : size];
    return flash->wires.settings->slow ? 2U * us : us;
}

unsigned flash_brown_out_level(const struct flash *flash)
{
    return flash->options >> 2 & 3U;
}

/* RM0090 section 3.6.2: what the supply must be at least for the parallelism in PSIZE; x64 needs VPP beside it. */
static uint32_t least_mv(const struct flash *flash)
{
    static const uint16_t by_size[] = {1800, 2100, 2700, 2700};
    return by_size[flash->cr >> 8 & 3U];
}

/* The supply has fallen in an operation: what it leaves may not last. */
void flash_watch_supply(struct flash *flash)
{
    if (flash_is_busy(flash) && !flash->weak && flash->wires.conditions->supply_mv < flash->needs_mv) {
        flash->weak = true;
        flash->weakened++;
    }
}

static void set_acr(struct flash *flash, uint32_t acr)
{
    uint32_t latency = acr & ACR_LATENCY;
    flash->acr = acr;
    stale_look_through_cache(&flash->stale, flash->wires.memory->flash, (acr & ACR_DCEN) != 0);
    flash->wires.conditions->flash_latency = latency;
    flash->wait_states = flash->wires.wait_states < 0 ? latency : (uint32_t)flash->wires.wait_states;
}

void flash_set_wait_states(struct flash *flash, uint32_t states)
{
    set_acr(flash, ACR_ICEN | ACR_DCEN | states);
}

void flash_leave_unlocked(struct flash *flash)
{
    flash->sr = SR_PGSERR | SR_PGAERR;
    flash->cr = 0;
    flash->optcr &= ~OPTCR_LOCK;
}

void flash_reset(struct flash *flash)
{
    stale_forget(&flash->stale, flash->wires.memory->flash);
    set_acr(flash, 0);
    flash->sr = 0;
    flash->cr = CR_LOCK;
    flash->optcr = flash->options | OPTCR_LOCK;
    flash->keys = 0;
    flash->option_keys = 0;
    flash->locked_out = false;
    flash->operation = FLASH_IDLE;
    clock_set(flash->wires.clock, EVENT_FLASH, VTIME_NEVER);
}

bool flash_instruction_cache_is_on(const struct flash *flash)
{
    return (flash->acr & ACR_ICEN) != 0;
}

bool flash_data_cache_is_on(const struct flash *flash)
{
    return (flash->acr & ACR_DCEN) != 0;
}

bool flash_prefetch_is_on(const struct flash *flash)
{
    return (flash->acr & ACR_PRFTEN) != 0;
}

void flash_stall(struct flash *flash, uint32_t address)
{
    struct clock *clock = flash->wires.clock;
    if (!memory_is_flash(flash->wires.memory, address) || !flash_is_busy(flash)) {
        return;
    }
    uint64_t done = clock->source[EVENT_FLASH].due;
    if (done > clock->now) {
        clock->stalled_cycles += done - clock->now;
        flash->stalls++;
        clock->now = done;
    }
    clock_run(clock, clock->now);
}

void flash_check_read(struct flash *flash, uint32_t address)
{
    if (flash_data_cache_is_on(flash) && stale_has(&flash->stale, address & (MEMORY_FLASH_BYTES - 1U))) {
        report_fail(flash->wires.report,
                    "%08x is read after its sector was erased: the data cache may have the old word (RM0090 3.5.2)",
                    address);
    }
}

static void update_interrupt(struct flash *flash)
{
    bool end = (flash->cr & CR_EOPIE) != 0 && (flash->sr & SR_EOP) != 0;
    bool error = (flash->cr & CR_ERRIE) != 0 && (flash->sr & SR_OPERR) != 0;
    nvic_set_line(flash->wires.nvic, NVIC_IRQ_FLASH, end || error);
}

static void set_error(struct flash *flash, uint32_t error)
{
    flash->sr |= error | ((flash->cr & CR_ERRIE) != 0 ? SR_OPERR : 0U);
    update_interrupt(flash);
}

static void begin(struct flash *flash, enum flash_operation operation, uint64_t us)
{
    flash->operation = operation;
    flash->operations++;
    flash->fails = flash->operations == flash->wires.settings->fail;
    flash->programs += operation == FLASH_PROGRAM ? 1U : 0U;
    flash->erases += operation == FLASH_ERASE ? 1U : 0U;
    flash->cut = NULL;
    for (unsigned i = 0; i < flash->wires.settings->cuts; i++) {
        flash->cut =
            flash->wires.settings->cut[i].operation == flash->operations ? &flash->wires.settings->cut[i] : flash->cut;
    }
    if (flash->wires.conditions->supply_mv < least_mv(flash)) {
        report_fail(flash->wires.report,
                    "an operation of the flash begins at %u mV, PSIZE %u needs %u; it may not last (RM0090 "
                    "3.6.2)",
                    (unsigned)flash->wires.conditions->supply_mv, (unsigned)(flash->cr >> 8 & 3U),
                    (unsigned)least_mv(flash));
    }
    flash->needs_mv = least_mv(flash);
    flash->weak = false;
    uint64_t ps = us * VTIME_PS_PER_US / (flash->cut != NULL ? 2U : 1U);
    clock_set_ps(flash->wires.clock, EVENT_FLASH, clock_now_ps(flash->wires.clock) + ps);
    clock_poke(flash->wires.clock);
}

static void fail(struct flash *flash)
{
    if (flash->wires.settings->bit) {
        flash_change_all_but_one_bit(flash);
    }
    if (flash->wires.settings->error != 0) {
        set_error(flash, flash->wires.settings->error);
    }
}

void flash_cut(struct flash *flash)
{
    uint32_t leaves = flash->cut == NULL ? (uint32_t)FLASH_CUT_HALF : flash->cut->leaves;
    if (!flash_is_busy(flash)) {
        return;
    }
    if (leaves >= (uint32_t)FLASH_CUT_SEED) {
        flash_change_some(flash, leaves - (uint32_t)FLASH_CUT_SEED);
    } else if (leaves != (uint32_t)FLASH_CUT_NOTHING) {
        flash_change(flash, leaves == (uint32_t)FLASH_CUT_ALL ? flash->bytes : flash->bytes / 2U);
    }
    flash->operation = FLASH_IDLE;
}

/* Power goes in the middle of an operation; without --power-back that is the end of the run. */
static void lose_power(struct flash *flash)
{
    flash_cut(flash);
    if (flash->wires.settings->power_back) {
        reset_request(flash->wires.reset, RESET_POWER);
    } else {
        report_finish(flash->wires.report, REPORT_POWER_CUT, "");
    }
}

static void take_effect(struct flash *flash)
{
    if (flash->cut != NULL) {
        lose_power(flash);
    } else if (flash->operation == FLASH_OPTIONS) {
        flash->options = flash->optcr & OPTCR_MASK;
        flash->optcr &= ~OPTCR_STRT;
    } else if (flash->fails) {
        fail(flash);
    } else if (flash->weak) {
        flash_change_some(flash, flash->weakened);
    } else {
        flash_change(flash, flash->bytes);
        flash->sr |= (flash->cr & CR_EOPIE) != 0 ? SR_EOP : 0U;
    }
}

static void on_flash_event(void *model, uint64_t cycle)
{
    struct flash *flash = model;
    uint8_t *memory = flash->wires.memory->flash;
    struct stale_word word = {.offset = flash->address, .bytes = flash->bytes};
    (void)cycle;
    stale_look_through_cache(&flash->stale, memory, false);
    if (flash->operation == FLASH_ERASE) {
        stale_note_erase(&flash->stale, flash->address, flash->bytes);
        take_effect(flash);
    } else if (flash->operation == FLASH_PROGRAM) {
        for (uint32_t i = 0; i < flash->bytes; i++) {
            word.seems[i] = flash_after(flash, i, memory[flash->address + i]);
        }
        take_effect(flash);
        stale_note_program(&flash->stale, memory, &word);
    } else {
        take_effect(flash);
    }
    stale_look_through_cache(&flash->stale, memory, flash_data_cache_is_on(flash));
    flash->operation = FLASH_IDLE;
    flash->cr &= ~CR_STRT;
    update_interrupt(flash);
    clock_poke(flash->wires.clock);
}

/* Errors of section 3.7: PG must be set, the access as wide as PSIZE says. */
void flash_write(struct flash *flash, uint32_t address, unsigned bytes, uint32_t value)
{
    unsigned size = flash->cr >> 8 & 3U;
    flash_stall(flash, MEMORY_FLASH_BASE);
    if ((flash->cr & CR_LOCK) != 0 || (flash->cr & CR_PG) == 0) {
        set_error(flash, SR_PGSERR);
    } else if (bytes != 1U << size) {
        set_error(flash, SR_PGPERR);
    } else if (address % bytes != 0) {
        set_error(flash, SR_PGAERR);
    } else if ((flash->sr & SR_ERRORS) != 0) {
        set_error(flash, SR_PGSERR);
    } else {
        flash->address = address & (MEMORY_FLASH_BYTES - 1U);
        flash->bytes = bytes;
        flash->value = value;
        begin(flash, FLASH_PROGRAM, program_us(flash));
    }
}

static void erase(struct flash *flash)
{
    unsigned sector = flash->cr >> 3 & 0xFU;
    unsigned size = flash->cr >> 8 & 3U;
    if ((flash->cr & CR_MER) != 0) {
        report_fail(flash->wires.report, "FLASH_CR: erase of the whole memory is not modelled");
    } else if ((flash->cr & CR_SER) == 0 || (flash->cr & CR_PG) != 0 || sector >= SECTORS) {
        set_error(flash, SR_PGSERR);
        flash->cr &= ~CR_STRT;
    } else if ((flash->sr & SR_ERRORS) != 0) {
        set_error(flash, SR_PGSERR);
        flash->cr &= ~CR_STRT;
    } else if (sector_base(sector) >= flash->wires.settings->kb * 1024U) {
        report_fail(flash->wires.report, "FLASH_CR: sector %u is erased, which a part of %u kB does not have", sector,
                    (unsigned)flash->wires.settings->kb);
    } else {
        flash->address = sector_base(sector);
        flash->bytes = sector_bytes(sector);
        begin(flash, FLASH_ERASE, erase_us(flash, flash->bytes, size));
    }
}

/* A wrong key, or one too many, locks FLASH_CR until the next reset (section 3.6.1). */
static void write_key(struct flash *flash, uint32_t value)
{
    if (flash->locked_out || (flash->cr & CR_LOCK) == 0 || value != (flash->keys == 0 ? KEY1 : KEY2)) {
        flash->locked_out = true;
        flash->cr |= CR_LOCK;
        return;
    }
    flash->keys++;
    if (flash->keys == 2) {
        flash->keys = 0;
        flash->cr &= ~CR_LOCK;
    }
}

/* Section 3.6.3. Further wrong keys lock as those of FLASH_CR do; that is not modelled. */
static void write_option_key(struct flash *flash, uint32_t value)
{
    bool right = value == (flash->option_keys == 0 ? OPTION_KEY1 : OPTION_KEY2);
    flash->option_keys = right ? flash->option_keys + 1U : 0U;
    if (flash->option_keys == 2) {
        flash->option_keys = 0;
        flash->optcr &= ~OPTCR_LOCK;
    }
}

/* Locked, it takes nothing. What is written is kept when OPTSTRT is set; it counts as no operation of the flash. */
static void write_options(struct flash *flash, uint32_t value)
{
    if ((flash->optcr & OPTCR_LOCK) != 0) {
        return;
    }
    flash_stall(flash, MEMORY_FLASH_BASE);
    flash->optcr = value & (OPTCR_MASK | OPTCR_LOCK | OPTCR_STRT);
    if ((value & OPTCR_STRT) != 0) {
        flash->operation = FLASH_OPTIONS;
        flash->needs_mv = 0;
        flash->bytes = 0;
        flash->cut = NULL;
        flash->option_writes++;
        clock_set_ps(flash->wires.clock, EVENT_FLASH, clock_now_ps(flash->wires.clock) + OPTIONS_MS * VTIME_PS_PER_MS);
        clock_poke(flash->wires.clock);
    }
}

static void write_control(struct flash *flash, uint32_t value)
{
    if (flash_is_busy(flash)) {
        flash_stall(flash, MEMORY_FLASH_BASE);
    }
    if ((flash->cr & CR_LOCK) != 0) {
        return;
    }
    flash->cr = value & CR_MASK;
    update_interrupt(flash);
    if ((value & CR_STRT) != 0) {
        erase(flash);
    }
}

static void write_acr(struct flash *flash, uint32_t value)
{
    uint32_t was_on = flash->acr & (ACR_ICEN | ACR_DCEN);
    if ((value & ACR_PRFTEN) != 0 && !flash->wires.prefetch_works) {
        report_fail(flash->wires.report, "FLASH_ACR: revision A has no prefetch that works (errata ES0182)");
    }
    if (((value & ACR_ICRST) != 0 && (was_on & ACR_ICEN) != 0) ||
        ((value & ACR_DCRST) != 0 && (was_on & ACR_DCEN) != 0)) {
        report_fail(flash->wires.report, "FLASH_ACR: a cache is reset while it is on (RM0090 3.9.1)");
    }
    if ((value & ACR_DCRST) != 0) {
        stale_forget(&flash->stale, flash->wires.memory->flash);
    }
    set_acr(flash, value & ACR_MASK);
    conditions_check(flash->wires.conditions);
}

bool flash_read_register(void *model, uint32_t offset, uint32_t *value)
{
    const struct flash *flash = model;
    switch (offset) {
    case FLASH_ACR:
        *value = flash->acr;
        return true;
    case FLASH_SR:
        *value = flash->sr | (flash_is_busy(flash) ? SR_BSY : 0U);
        return true;
    case FLASH_CR:
        *value = flash->cr;
        return true;
    case FLASH_OPTCR:
        *value = flash->optcr;
        return true;
    default:
        return false;
    }
}

bool flash_write_register(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct flash *flash = model;
    switch (offset) {
    case FLASH_ACR:
        write_acr(flash, (flash->acr & ~mask) | (value & mask));
        return true;
    case FLASH_KEYR:
        write_key(flash, value);
        return true;
    case FLASH_OPTKEYR:
        write_option_key(flash, value);
        return true;
    case FLASH_OPTCR:
        write_options(flash, (flash->optcr & ~mask) | (value & mask));
        return true;
    case FLASH_SR:
        flash->sr &= ~(value & mask & SR_CLEARABLE);
        update_interrupt(flash);
        return true;
    case FLASH_CR:
        write_control(flash, (flash->cr & ~mask) | (value & mask));
        return true;
    default:
        return false;
    }
}

void flash_init(struct flash *flash, struct flash_wires wires)
{
    flash->wires = wires;
    flash->options = wires.settings->option_bytes;
    clock_attach(wires.clock, EVENT_FLASH, on_flash_event, flash);
}
