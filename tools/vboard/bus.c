#include "bus.h"

#include <stddef.h>

#include "board.h"
#include "reserved.h"

enum {
    BLOCK_BYTES = 0x400,
    PERIPHERAL_BYTES = 0x80000, /* APB1, APB2 and AHB1 */
    APB1_BYTES = 0x10000,
    APB_BYTES = 0x20000, /* APB1 and APB2 */
    SYSTEM_BYTES = 0x100000,
};

#define PERIPHERAL_BASE UINT32_C(0x40000000)
#define SYSTEM_BASE UINT32_C(0xE0000000)
#define SYSTEM_IPR UINT32_C(0xE000E400)
#define SYSTEM_IPR_BYTES 0x54U
#define SYSTEM_SHPR UINT32_C(0xE000ED18)
#define SYSTEM_SHPR_BYTES 12U
#define SYSTEM_CFSR UINT32_C(0xE000ED28)
#define RESERVED_TEXT "it sets bits that are reserved, and must stay 0"

/* A row of RM0090 table 1. */
struct block {
    const char *name;
    bus_reader *read;
    bus_writer *write;
    uint32_t base;
    uint8_t instance;
    bool takes_bytes;     /* whether single bytes may be accessed */
    uint8_t clock_offset; /* of its clock enable register in RCC; 0: always on */
    uint8_t clock_bit;
};

static const struct block blocks[] = {
    {"TIM2", timer_read, timer_write, 0x40000000, 0, false, RCC_APB1ENR, 0},
    {"TIM3", timer_read, timer_write, 0x40000400, 1, false, RCC_APB1ENR, 1},
    {"TIM4", timer_read, timer_write, 0x40000800, 2, false, RCC_APB1ENR, 2},
    {"TIM5", timer_read, timer_write, 0x40000C00, 3, false, RCC_APB1ENR, 3},
    {"IWDG", iwdg_read, iwdg_write, 0x40003000, 0, false, 0, 0},
    {"USART2", usart_read, usart_write, 0x40004400, 1, false, RCC_APB1ENR, 17},
    {"USART3", usart_read, usart_write, 0x40004800, 2, false, RCC_APB1ENR, 18},
    {"PWR", pwr_read, pwr_write, 0x40007000, 0, false, RCC_APB1ENR, 28},
    {"USART1", usart_read, usart_write, 0x40011000, 0, false, RCC_APB2ENR, 4},
    {"SYSCFG", syscfg_read, syscfg_write, 0x40013800, 0, true, RCC_APB2ENR, 14},
    {"EXTI", exti_read, exti_write, 0x40013C00, 0, false, 0, 0},
    {"GPIOA", gpio_read, gpio_write, 0x40020000, 0, true, RCC_AHB1ENR, 0},
    {"GPIOB", gpio_read, gpio_write, 0x40020400, 1, true, RCC_AHB1ENR, 1},
    {"GPIOC", gpio_read, gpio_write, 0x40020800, 2, true, RCC_AHB1ENR, 2},
    {"GPIOD", gpio_read, gpio_write, 0x40020C00, 3, true, RCC_AHB1ENR, 3},
    {"GPIOE", gpio_read, gpio_write, 0x40021000, 4, true, RCC_AHB1ENR, 4},
    {"GPIOF", gpio_read, gpio_write, 0x40021400, 5, true, RCC_AHB1ENR, 5},
    {"GPIOG", gpio_read, gpio_write, 0x40021800, 6, true, RCC_AHB1ENR, 6},
    {"GPIOH", gpio_read, gpio_write, 0x40021C00, 7, true, RCC_AHB1ENR, 7},
    {"GPIOI", gpio_read, gpio_write, 0x40022000, 8, true, RCC_AHB1ENR, 8},
    {"RCC", rcc_read, rcc_write, 0x40023800, 0, true, 0, 0},
    {"FLASH", flash_read_register, flash_write_register, 0x40023C00, 0, true, 0, 0},
};

static const struct block *find_block(uint32_t address)
{
    for (unsigned i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        if (address - blocks[i].base < BLOCK_BYTES) {
            return &blocks[i];
        }
    }
    return NULL;
}

uint64_t bus_idle_cycle(const struct board *board)
{
    return board->bus.apb_busy_until;
}

static void complain_of(struct board *board, const char *verb, uint32_t address, const char *why)
{
    const struct block *block = address < SYSTEM_BASE ? find_block(address) : NULL;
    if (block == NULL) {
        board_fail(board, "%s %08x: %s", verb, address, why);
    } else {
        board_fail(board, "%s %08x (%s+%02x): %s", verb, address, block->name, address - block->base, why);
    }
}

/* What is wrong with an access, or null. */
static const char *refuse(struct board *board, const struct block *block, uint32_t address, unsigned bytes)
{
    if (block == NULL) {
        return "no peripheral that is modelled";
    }
    if (!rcc_clock_is_on(&board->rcc, block->clock_offset, block->clock_bit)) {
        return "its clock is not enabled in RCC";
    }
    if (!rcc_clock_has_come(board, block->clock_offset, block->clock_bit)) {
        return "its clock was enabled so short a time ago that the access is lost (errata ES0182)";
    }
    if (bytes == 1 && !block->takes_bytes) {
        return "a byte access, where the manual asks for half-words or words";
    }
    return address % bytes != 0 ? "not aligned" : NULL;
}

/* The same for a write. */
static const char *refuse_write(struct board *board, const struct block *block, uint32_t address, unsigned bytes,
                                uint32_t bits)
{
    const char *why = refuse(board, block, address, bytes);
    if (why == NULL && bytes == 2 && block->write == timer_write &&
        timer_register_is_wide(block->instance, (address - block->base) & ~UINT32_C(3))) {
        return "a half of a register of 32 bits, which must be written by words (RM0090 18.4)";
    }
    return why == NULL && (bits & reserved_bits(address)) != 0 ? RESERVED_TEXT : why;
}

/* PM0214 sections 4.3.12, 4.4.15 and 4.5: words, but for priorities and CFSR, which may be accessed by their parts. */
static const char *refuse_system(uint32_t address, unsigned bytes)
{
    bool has_parts = address - SYSTEM_IPR < SYSTEM_IPR_BYTES || address - SYSTEM_SHPR < SYSTEM_SHPR_BYTES ||
                     address - SYSTEM_CFSR < 4U;
    if (address % bytes != 0) {
        return "not aligned";
    }
    return bytes == 4 || has_parts ? NULL : "registers of the core are accessed by words (PM0214 4.3, 4.4, 4.5)";
}

/* AN4031 table 4: an access to APB takes two clocks of that bus, and before them one of HCLK each for the matrix and to
 * get into step with the bus. An instruction that finds it idle has the latter two in its own cycles. */
enum {
    MATRIX_CYCLES = 2,
    QUARTER = 4
};

static uint32_t apb_wait(const struct board *board, uint32_t address)
{
    bool is_apb1 = address - PERIPHERAL_BASE < APB1_BYTES;
    uint32_t divider = is_apb1 ? board->rcc.pclk1_divider : board->rcc.pclk2_divider;
    return board->bus.apb_wait * divider / QUARTER;
}

static bool is_apb(uint32_t address)
{
    return address - PERIPHERAL_BASE < APB_BYTES;
}

/* Lets an access to APB begin when the one before has arrived; then a read waits for its answer, and a write goes on
 * its way while the processor runs on. */
static void wait_for_apb(struct board *board, uint32_t address, bool is_read)
{
    struct cpu *cpu = &board->cpu;
    struct bus *bus = &board->bus;
    uint64_t begin = cpu->now;
    if (is_apb(address)) {
        bool is_busy = bus->apb_busy_until > begin;
        uint64_t end = (is_busy ? bus->apb_busy_until + MATRIX_CYCLES : begin) + apb_wait(board, address);
        cpu->now = is_busy ? bus->apb_busy_until : begin;
        cpu->now = is_read ? end : cpu->now;
        bus->apb_busy_until = end;
    }
    profile_bus(board, address, cpu->now - begin);
}

static uint32_t lanes(uint32_t address, unsigned bytes)
{
    uint32_t ones = bytes == 4 ? UINT32_MAX : (UINT32_C(1) << 8U * bytes) - 1U;
    return ones << 8U * (address & 3U);
}

static uint64_t read_peripheral(uc_engine *engine, uint64_t offset, unsigned bytes, void *user)
{
    struct board *board = user;
    uint32_t address = PERIPHERAL_BASE + (uint32_t)offset;
    const struct block *block = find_block(address);
    const char *why = refuse(board, block, address, bytes);
    uint32_t value = 0;
    (void)engine;

    wait_for_apb(board, address, true);
    events_run(board, board->cpu.now);
    if (why == NULL && !block->read(board, block->instance, (address - block->base) & ~3U, &value)) {
        why = "no register that is modelled";
    }
    if (why != NULL) {
        complain_of(board, "read of", address, why);
    }
    return (value & lanes(address, bytes)) >> 8U * (address & 3U);
}

static void arrive(struct board *board, const struct bus_write *write)
{
    const struct block *block = write->block;
    uint32_t offset = (write->address - block->base) & ~UINT32_C(3);
    if (!block->write(board, block->instance, offset, write->value, write->mask)) {
        complain_of(board, "write to", write->address, "no register that is modelled and can be written");
    }
}

/* The program may be some instructions further. */
void bus_event(struct board *board, uint64_t cycle)
{
    struct cpu *cpu = &board->cpu;
    uint64_t now = cpu->now;
    uint32_t at = cpu->at;
    cpu->now = cycle;
    cpu->at = board->bus.write.at;
    arrive(board, &board->bus.write);
    cpu->now = now;
    cpu->at = at;
}

void bus_reset(struct board *board)
{
    board->bus.apb_busy_until = 0;
    events_set(board, EVENT_BUS, VTIME_NEVER);
}

static void write_peripheral(uc_engine *engine, uint64_t offset, unsigned bytes, uint64_t value, void *user)
{
    struct board *board = user;
    uint32_t address = PERIPHERAL_BASE + (uint32_t)offset;
    const struct block *block = find_block(address);
    struct bus_write write = {.block = block,
                              .address = address,
                              .value = (uint32_t)value << 8U * (address & 3U),
                              .mask = lanes(address, bytes),
                              .at = board->cpu.at};
    const char *why = refuse_write(board, block, address, bytes, write.value & write.mask);
    (void)engine;

    wait_for_apb(board, address, false);
    events_run(board, board->cpu.now);
    if (why != NULL) {
        complain_of(board, "write to", address, why);
    } else if (is_apb(address)) {
        board->bus.write = write;
        events_set(board, EVENT_BUS, board->bus.apb_busy_until);
    } else {
        arrive(board, &write);
    }
}

static uint64_t read_system(uc_engine *engine, uint64_t offset, unsigned bytes, void *user)
{
    struct board *board = user;
    uint32_t address = SYSTEM_BASE + (uint32_t)offset;
    const char *why = refuse_system(address, bytes);
    uint32_t value = 0;
    (void)engine;
    events_run(board, board->cpu.now);
    if (why == NULL && !core_read(board, address & ~3U, &value)) {
        why = "no register of the core that is modelled";
    }
    if (why != NULL) {
        complain_of(board, "read of", address, why);
    }
    return (value & lanes(address, bytes)) >> 8U * (address & 3U);
}

static void write_system(uc_engine *engine, uint64_t offset, unsigned bytes, uint64_t value, void *user)
{
    struct board *board = user;
    uint32_t address = SYSTEM_BASE + (uint32_t)offset;
    uint32_t word = (uint32_t)value << 8U * (address & 3U);
    uint32_t mask = lanes(address, bytes);
    const char *why = refuse_system(address, bytes);
    (void)engine;
    events_run(board, board->cpu.now);
    if (why == NULL && (word & mask & reserved_bits(address)) != 0) {
        why = RESERVED_TEXT;
    }
    if (why == NULL && !core_write(board, address & ~3U, word, mask)) {
        why = "no register of the core that is modelled and can be written";
    }
    if (why != NULL) {
        complain_of(board, "write to", address, why);
    }
}

bool bus_init(struct board *board)
{
    uc_engine *engine = board->cpu.engine;
    return uc_mmio_map(engine, PERIPHERAL_BASE, PERIPHERAL_BYTES, read_peripheral, board, write_peripheral, board) ==
               UC_ERR_OK &&
           uc_mmio_map(engine, SYSTEM_BASE, SYSTEM_BYTES, read_system, board, write_system, board) == UC_ERR_OK;
}
