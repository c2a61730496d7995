#include "bus.h"

#include <stddef.h>

#include "board.h"

enum {
    BLOCK_BYTES = 0x400,
    PERIPHERAL_BYTES = 0x80000, /* APB1, APB2 and AHB1 */
    APB_BYTES = 0x20000,
    SYSTEM_BYTES = 0x100000,
};

#define PERIPHERAL_BASE UINT32_C(0x40000000)
#define SYSTEM_BASE UINT32_C(0xE0000000)

/* A row of RM0090 table 1. */
struct block {
    const char *name;
    bus_reader *read;
    bus_writer *write;
    uint32_t base;
    uint8_t instance;
    bool takes_bytes; /* whether single bytes may be accessed */
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

/* Lets an access start when the one before has arrived. APB is slower than the processor: a read waits for the answer,
 * a write goes on its way while the processor runs on. */
static void wait_for_apb(struct board *board, uint32_t address, bool is_read)
{
    struct cpu *cpu = &board->cpu;
    uint64_t begin = cpu->now;
    if (address - PERIPHERAL_BASE >= APB_BYTES) {
        profile_bus(board, address, 0);
        return;
    }
    if (cpu->now < board->bus.apb_busy_until) {
        cpu->now = board->bus.apb_busy_until;
    }
    if (is_read) {
        cpu->now += board->bus.apb_wait;
    } else {
        board->bus.apb_busy_until = cpu->now + board->bus.apb_wait;
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

static void write_peripheral(uc_engine *engine, uint64_t offset, unsigned bytes, uint64_t value, void *user)
{
    struct board *board = user;
    uint32_t address = PERIPHERAL_BASE + (uint32_t)offset;
    const struct block *block = find_block(address);
    const char *why = refuse(board, block, address, bytes);
    (void)engine;

    wait_for_apb(board, address, false);
    events_run(board, board->cpu.now);
    if (why == NULL && !block->write(board, block->instance, (address - block->base) & ~3U,
                                     (uint32_t)value << 8U * (address & 3U), lanes(address, bytes))) {
        why = "no register that is modelled and can be written";
    }
    if (why != NULL) {
        complain_of(board, "write to", address, why);
    }
}

static uint64_t read_system(uc_engine *engine, uint64_t offset, unsigned bytes, void *user)
{
    struct board *board = user;
    uint32_t address = SYSTEM_BASE + (uint32_t)offset;
    uint32_t value = 0;
    (void)engine;
    events_run(board, board->cpu.now);
    if (!core_read(board, address & ~3U, &value)) {
        complain_of(board, "read of", address, "no register of the core that is modelled");
    }
    return (value & lanes(address, bytes)) >> 8U * (address & 3U);
}

static void write_system(uc_engine *engine, uint64_t offset, unsigned bytes, uint64_t value, void *user)
{
    struct board *board = user;
    uint32_t address = SYSTEM_BASE + (uint32_t)offset;
    (void)engine;
    events_run(board, board->cpu.now);
    if (!core_write(board, address & ~3U, (uint32_t)value << 8U * (address & 3U), lanes(address, bytes))) {
        complain_of(board, "write to", address, "no register of the core that is modelled and can be written");
    }
}

bool bus_init(struct board *board)
{
    uc_engine *engine = board->cpu.engine;
    return uc_mmio_map(engine, PERIPHERAL_BASE, PERIPHERAL_BYTES, read_peripheral, board, write_peripheral, board) ==
               UC_ERR_OK &&
           uc_mmio_map(engine, SYSTEM_BASE, SYSTEM_BYTES, read_system, board, write_system, board) == UC_ERR_OK;
}
