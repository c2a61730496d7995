#include "flash.h"

#include <string.h>

#include "board.h"

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
static uint64_t program_us(const struct board *board)
{
    return board->options->slow_flash ? 100 : 16;
}

static uint64_t erase_us(const struct board *board, uint32_t bytes, unsigned size)
{
    if (board->options->erase_us != 0) {
        return board->options->erase_us;
    }
    static const uint32_t typical_ms[3][3] = {{400, 300, 250}, {1200, 700, 550}, {2000, 1300, 1000}};
    unsigned row = (bytes > 16U * 1024U ? 1U : 0U) + (bytes > 64U * 1024U ? 1U : 0U);
    uint64_t us = 1000U * (uint64_t)typical_ms[row][size > 2 ? 2 : size];
    return board->options->slow_flash ? 2U * us : us;
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
void flash_watch_supply(struct board *board)
{
    struct flash *flash = &board->flash;
    if (flash_is_busy(flash) && !flash->weak && board->supply.mv < flash->needs_mv) {
        flash->weak = true;
        flash->weakened++;
    }
}

void flash_set_wait_states(struct board *board, uint32_t states)
{
    board->flash.acr = ACR_ICEN | ACR_DCEN | states;
    if (!board->cpu.wait_states_fixed) {
        board->cpu.wait_states = states;
    }
}

void flash_leave_unlocked(struct board *board)
{
    board->flash.sr = SR_PGSERR | SR_PGAERR;
    board->flash.cr = 0;
    board->flash.optcr &= ~OPTCR_LOCK;
}

void flash_reset(struct board *board)
{
    struct flash *flash = &board->flash;
    flash->acr = 0;
    flash->sr = 0;
    flash->cr = CR_LOCK;
    flash->optcr = flash->options | OPTCR_LOCK;
    flash->keys = 0;
    flash->option_keys = 0;
    flash->locked_out = false;
    flash->operation = FLASH_IDLE;
    events_set(board, EVENT_FLASH, VTIME_NEVER);
}

uint64_t flash_done_cycle(const struct board *board)
{
    return board->events.due[EVENT_FLASH];
}

unsigned flash_latency(const struct flash *flash)
{
    return flash->acr & 7U;
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

static void update_interrupt(struct board *board)
{
    const struct flash *flash = &board->flash;
    bool end = (flash->cr & CR_EOPIE) != 0 && (flash->sr & SR_EOP) != 0;
    bool error = (flash->cr & CR_ERRIE) != 0 && (flash->sr & SR_OPERR) != 0;
    nvic_set_line(board, NVIC_IRQ_FLASH, end || error);
}

static void set_error(struct board *board, uint32_t error)
{
    board->flash.sr |= error | ((board->flash.cr & CR_ERRIE) != 0 ? SR_OPERR : 0U);
    update_interrupt(board);
}

static void begin(struct board *board, enum flash_operation operation, uint64_t us)
{
    struct flash *flash = &board->flash;
    flash->operation = operation;
    flash->operations++;
    flash->fails = flash->operations == board->options->flash_fail;
    flash->programs += operation == FLASH_PROGRAM ? 1U : 0U;
    flash->erases += operation == FLASH_ERASE ? 1U : 0U;
    flash->cut = NULL;
    for (unsigned i = 0; i < board->options->cuts; i++) {
        flash->cut = board->options->cut[i].operation == flash->operations ? &board->options->cut[i] : flash->cut;
    }
    if (board->supply.mv < least_mv(flash)) {
        board_fail(board,
                   "an operation of the flash begins at %u mV, PSIZE %u needs %u; it may not last (RM0090 "
                   "3.6.2)",
                   (unsigned)board->supply.mv, (unsigned)(flash->cr >> 8 & 3U), (unsigned)least_mv(flash));
    }
    flash->needs_mv = least_mv(flash);
    flash->weak = false;
    uint64_t ps = us * VTIME_PS_PER_US / (flash->cut != NULL ? 2U : 1U);
    events_set_ps(board, EVENT_FLASH, board_now_ps(board) + ps);
    cpu_poke(&board->cpu);
}

/* Whether anything in a range of the flash has been executed. */
static bool was_executed(const struct board *board, uint32_t offset, uint32_t bytes)
{
    for (uint32_t at = offset; at < offset + bytes; at += 2) {
        if (cost_find(&board->cpu.cost, MEMORY_FLASH_BASE + at)->kind != COST_UNKNOWN) {
            return true;
        }
    }
    return false;
}

static uint8_t after(const struct flash *flash, uint32_t index, uint8_t before)
{
    if (flash->operation == FLASH_ERASE) {
        return UINT8_MAX;
    }
    return (uint8_t)(before & (uint32_t)(flash->value >> 8U * index) & UINT8_MAX);
}

static void change(struct board *board, uint32_t bytes)
{
    struct flash *flash = &board->flash;
    uint8_t *at = board->memory.flash + flash->address;
    for (uint32_t i = 0; i < bytes; i++) {
        at[i] = after(flash, i, at[i]);
    }
    flash->code_changed |= was_executed(board, flash->address, bytes);
}

/* Of the bits that were to change some have and some have not (xorshift32). */
static void change_some(struct board *board, uint32_t seed)
{
    struct flash *flash = &board->flash;
    uint8_t *at = board->memory.flash + flash->address;
    uint32_t random = (seed + 1U) * UINT32_C(2654435761) | 1U;
    for (uint32_t i = 0; i < flash->bytes; i++) {
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        at[i] = (uint8_t)(at[i] ^ ((at[i] ^ after(flash, i, at[i])) & random >> 11));
    }
    flash->code_changed |= was_executed(board, flash->address, flash->bytes);
}

static void change_all_but_one_bit(struct board *board)
{
    struct flash *flash = &board->flash;
    uint8_t *at = board->memory.flash + flash->address;
    uint32_t place = 0;
    while (place + 1U < flash->bytes && at[place] == after(flash, place, at[place])) {
        place++;
    }
    uint32_t differs = at[place] ^ after(flash, place, at[place]);
    change(board, flash->bytes);
    at[place] ^= (uint8_t)(differs & (0U - differs));
}

static void fail(struct board *board)
{
    if (board->options->flash_bit) {
        change_all_but_one_bit(board);
    }
    if (board->options->flash_error != 0) {
        set_error(board, board->options->flash_error);
    }
}

void flash_cut(struct board *board)
{
    struct flash *flash = &board->flash;
    uint32_t leaves = flash->cut == NULL ? (uint32_t)OPTIONS_CUT_HALF : flash->cut->leaves;
    if (!flash_is_busy(flash)) {
        return;
    }
    if (leaves >= (uint32_t)OPTIONS_CUT_SEED) {
        change_some(board, leaves - (uint32_t)OPTIONS_CUT_SEED);
    } else if (leaves != (uint32_t)OPTIONS_CUT_NOTHING) {
        change(board, leaves == (uint32_t)OPTIONS_CUT_ALL ? flash->bytes : flash->bytes / 2U);
    }
    flash->operation = FLASH_IDLE;
}

/* Power goes in the middle of an operation; without --power-back that is the end of the run. */
static void lose_power(struct board *board)
{
    flash_cut(board);
    if (board->options->power_back) {
        board_request_reset(board, RESET_POWER);
    } else {
        board_finish(board, BOARD_POWER_CUT, "");
    }
}

void flash_event(struct board *board, uint64_t cycle)
{
    struct flash *flash = &board->flash;
    (void)cycle;
    if (flash->cut != NULL) {
        lose_power(board);
    } else if (flash->operation == FLASH_OPTIONS) {
        flash->options = flash->optcr & OPTCR_MASK;
        flash->optcr &= ~OPTCR_STRT;
    } else if (flash->fails) {
        fail(board);
    } else if (flash->weak) {
        change_some(board, flash->weakened);
    } else {
        change(board, flash->bytes);
        flash->sr |= (flash->cr & CR_EOPIE) != 0 ? SR_EOP : 0U;
    }
    flash->operation = FLASH_IDLE;
    flash->cr &= ~CR_STRT;
    update_interrupt(board);
    cpu_poke(&board->cpu);
}

/* Errors of section 3.7: PG must be set, the access as wide as PSIZE says. */
void flash_write(struct board *board, uint32_t address, unsigned bytes, uint32_t value)
{
    struct flash *flash = &board->flash;
    unsigned size = flash->cr >> 8 & 3U;
    cpu_stall_on_flash(board, MEMORY_FLASH_BASE);
    if ((flash->cr & CR_LOCK) != 0 || (flash->cr & CR_PG) == 0) {
        set_error(board, SR_PGSERR);
    } else if (bytes != 1U << size) {
        set_error(board, SR_PGPERR);
    } else if (address % bytes != 0) {
        set_error(board, SR_PGAERR);
    } else if ((flash->sr & SR_ERRORS) != 0) {
        set_error(board, SR_PGSERR);
    } else {
        flash->address = address & (MEMORY_FLASH_BYTES - 1U);
        flash->bytes = bytes;
        flash->value = value;
        begin(board, FLASH_PROGRAM, program_us(board));
    }
}

static void erase(struct board *board)
{
    struct flash *flash = &board->flash;
    unsigned sector = flash->cr >> 3 & 0xFU;
    unsigned size = flash->cr >> 8 & 3U;
    if ((flash->cr & CR_MER) != 0) {
        board_fail(board, "FLASH_CR: erase of the whole memory is not modelled");
    } else if ((flash->cr & CR_SER) == 0 || (flash->cr & CR_PG) != 0 || sector >= SECTORS) {
        set_error(board, SR_PGSERR);
        flash->cr &= ~CR_STRT;
    } else if ((flash->sr & SR_ERRORS) != 0) {
        set_error(board, SR_PGSERR);
        flash->cr &= ~CR_STRT;
    } else if (sector_base(sector) >= board->options->flash_kb * 1024U) {
        board_fail(board, "FLASH_CR: sector %u is erased, which a part of %u kB does not have", sector,
                   (unsigned)board->options->flash_kb);
    } else {
        flash->address = sector_base(sector);
        flash->bytes = sector_bytes(sector);
        begin(board, FLASH_ERASE, erase_us(board, flash->bytes, size));
    }
}

/* A wrong key, or one too many, locks FLASH_CR until the next reset (section 3.6.1). */
static void write_key(struct board *board, uint32_t value)
{
    struct flash *flash = &board->flash;
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
static void write_option_key(struct board *board, uint32_t value)
{
    struct flash *flash = &board->flash;
    bool right = value == (flash->option_keys == 0 ? OPTION_KEY1 : OPTION_KEY2);
    flash->option_keys = right ? flash->option_keys + 1U : 0U;
    if (flash->option_keys == 2) {
        flash->option_keys = 0;
        flash->optcr &= ~OPTCR_LOCK;
    }
}

/* Locked, it takes nothing. What is written is kept when OPTSTRT is set; it counts as no operation of the flash. */
static void write_options(struct board *board, uint32_t value)
{
    struct flash *flash = &board->flash;
    if ((flash->optcr & OPTCR_LOCK) != 0) {
        return;
    }
    cpu_stall_on_flash(board, MEMORY_FLASH_BASE);
    flash->optcr = value & (OPTCR_MASK | OPTCR_LOCK | OPTCR_STRT);
    if ((value & OPTCR_STRT) != 0) {
        flash->operation = FLASH_OPTIONS;
        flash->needs_mv = 0;
        flash->bytes = 0;
        flash->cut = NULL;
        flash->option_writes++;
        events_set_ps(board, EVENT_FLASH, board_now_ps(board) + OPTIONS_MS * VTIME_PS_PER_MS);
        cpu_poke(&board->cpu);
    }
}

static void write_control(struct board *board, uint32_t value)
{
    struct flash *flash = &board->flash;
    if (flash_is_busy(flash)) {
        cpu_stall_on_flash(board, MEMORY_FLASH_BASE);
    }
    if ((flash->cr & CR_LOCK) != 0) {
        return;
    }
    flash->cr = value & CR_MASK;
    update_interrupt(board);
    if ((value & CR_STRT) != 0) {
        erase(board);
    }
}

static void write_acr(struct board *board, uint32_t value)
{
    struct cpu *cpu = &board->cpu;
    uint32_t was_on = board->flash.acr & (ACR_ICEN | ACR_DCEN);
    if ((value & ACR_PRFTEN) != 0 && core_is_revision_a(board)) {
        board_fail(board, "FLASH_ACR: revision A has no prefetch that works (errata ES0182)");
    }
    if (((value & ACR_ICRST) != 0 && (was_on & ACR_ICEN) != 0) ||
        ((value & ACR_DCRST) != 0 && (was_on & ACR_DCEN) != 0)) {
        board_fail(board, "FLASH_ACR: a cache is reset while it is on (RM0090 3.9.1)");
    }
    board->flash.acr = value & ACR_MASK;
    if (!cpu->wait_states_fixed) {
        cpu->wait_states = flash_latency(&board->flash);
    }
    rcc_check_limits(board);
}

bool flash_read_register(struct board *board, unsigned instance, uint32_t offset, uint32_t *value)
{
    const struct flash *flash = &board->flash;
    (void)instance;
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

bool flash_write_register(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct flash *flash = &board->flash;
    (void)instance;
    switch (offset) {
    case FLASH_ACR:
        write_acr(board, (flash->acr & ~mask) | (value & mask));
        return true;
    case FLASH_KEYR:
        write_key(board, value);
        return true;
    case FLASH_OPTKEYR:
        write_option_key(board, value);
        return true;
    case FLASH_OPTCR:
        write_options(board, (flash->optcr & ~mask) | (value & mask));
        return true;
    case FLASH_SR:
        flash->sr &= ~(value & mask & SR_CLEARABLE);
        update_interrupt(board);
        return true;
    case FLASH_CR:
        write_control(board, (flash->cr & ~mask) | (value & mask));
        return true;
    default:
        return false;
    }
}
