#include "bus.h"

#include <assert.h>
#include <stddef.h>

#include "reserved.h"

enum {
    WORD_BYTES = 4,
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

static const struct bus_block *find_block(const struct bus *bus, uint32_t address)
{
    for (unsigned i = 0; i < bus->blocks; i++) {
        if (address - bus->block[i].base < BLOCK_BYTES) {
            return &bus->block[i];
        }
    }
    return NULL;
}

uint64_t bus_idle_cycle(const struct bus *bus)
{
    return bus->apb_busy_until;
}

static void complain_of(struct bus *bus, const char *verb, uint32_t address, const char *why)
{
    const struct bus_block *block = address < SYSTEM_BASE ? find_block(bus, address) : NULL;
    if (block == NULL) {
        report_fail(bus->wires.report, "%s %08x: %s", verb, address, why);
    } else {
        report_fail(bus->wires.report, "%s %08x (%s+%02x): %s", verb, address, block->name, address - block->base, why);
    }
}

/* What is wrong with an access, or null. */
static const char *refuse(struct bus *bus, const struct bus_block *block, uint32_t address, unsigned bytes)
{
    if (block == NULL) {
        return "no peripheral that is modelled";
    }
    if (!rcc_clock_is_on(bus->wires.rcc, block->clock_offset, block->clock_bit)) {
        return "its clock is not enabled in RCC";
    }
    if (!rcc_clock_has_come(bus->wires.rcc, block->clock_offset, block->clock_bit)) {
        return "its clock was enabled so short a time ago that the access is lost (errata ES0182)";
    }
    if (rcc_is_held(bus->wires.rcc, block->clock_offset, block->clock_bit)) {
        return "RCC holds it in reset (RM0090 7.3.5 to 7.3.9)";
    }
    if (bytes < block->least_bytes) {
        return block->least_bytes == WORD_BYTES ? "not a word, where the manual asks for words"
                                                : "a byte access, where the manual asks for half-words or words";
    }
    return address % bytes != 0 ? "not aligned" : NULL;
}

/* The same for a write. */
static const char *refuse_write(struct bus *bus, const struct bus_block *block, uint32_t address, unsigned bytes,
                                uint32_t bits)
{
    const char *why = refuse(bus, block, address, bytes);
    if (why == NULL && bytes == 2 && block->is_wide != NULL &&
        block->is_wide(block->model, (address - block->base) & ~UINT32_C(3))) {
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
    ADDRESS_CYCLES = 1, /* in which the DMA controller computes an address */
    QUARTER = 4
};

/* RM0090 5.4.2: PWR_CSR takes additional cycles of APB; it does not say how many. Assumed: as many again. */
#define PWR_CSR UINT32_C(0x40007004)

static uint32_t apb_wait(const struct bus *bus, uint32_t address)
{
    uint32_t divider =
        bus_is_apb1(address) ? bus->wires.conditions->pclk1_divider : bus->wires.conditions->pclk2_divider;
    return (address == PWR_CSR ? 2U : 1U) * bus->wires.apb_wait * divider / QUARTER;
}

bool bus_is_apb1(uint32_t address)
{
    return address - PERIPHERAL_BASE < APB1_BYTES;
}

bool bus_is_apb2(uint32_t address)
{
    return address - PERIPHERAL_BASE - APB1_BYTES < APB_BYTES - APB1_BYTES;
}

static bool is_apb(uint32_t address)
{
    return address - PERIPHERAL_BASE < APB_BYTES;
}

static uint64_t later(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* When an access has arrived that is ready at a cycle and then needs some to begin; it waits for whoever has the bus.
 */
static uint64_t take_apb(struct bus *bus, uint32_t address, uint64_t ready, unsigned begin_cycles)
{
    uint64_t *taken_until = &bus->taken_until[bus_is_apb1(address) ? 0 : 1];
    uint64_t begin = *taken_until > ready ? *taken_until + MATRIX_CYCLES : ready + begin_cycles;
    *taken_until = begin + apb_wait(bus, address);
    return *taken_until;
}

uint64_t bus_take_apb(struct bus *bus, uint32_t address, uint64_t cycle)
{
    return take_apb(bus, address, cycle + ADDRESS_CYCLES, MATRIX_CYCLES);
}

/* Lets an access to APB begin when the processor's one before has arrived; then a read waits for its answer, and a
 * write goes on its way while the processor runs on. The matrix goes round (RM0090 section 2.1): who has waited for the
 * processor's access comes before its next one. */
static void wait_for_apb(struct bus *bus, uint32_t address, bool is_read)
{
    struct clock *clock = bus->wires.clock;
    uint64_t begin = clock->now;
    clock_run(clock, clock->now);
    if (is_apb(address)) {
        bool is_busy = bus->apb_busy_until > begin;
        clock->now = later(begin, bus->apb_busy_until);
        clock_run(clock, clock->now);
        bus->apb_busy_until = take_apb(bus, address, clock->now, is_busy ? MATRIX_CYCLES : 0U);
        clock->now = is_read ? bus->apb_busy_until : clock->now;
    }
    profile_bus(bus->wires.profile, address, clock->now - begin);
}

static uint32_t lanes(uint32_t address, unsigned bytes)
{
    uint32_t ones = bytes == 4 ? UINT32_MAX : (UINT32_C(1) << 8U * bytes) - 1U;
    return ones << 8U * (address & 3U);
}

static uint64_t read_peripheral(uc_engine *engine, uint64_t offset, unsigned bytes, void *user)
{
    struct bus *bus = user;
    uint32_t address = PERIPHERAL_BASE + (uint32_t)offset;
    const struct bus_block *block = find_block(bus, address);
    const char *why = refuse(bus, block, address, bytes);
    uint32_t value = 0;
    (void)engine;

    wait_for_apb(bus, address, true);
    clock_run(bus->wires.clock, bus->wires.clock->now);
    if (why == NULL && !block->read(block->model, (address - block->base) & ~3U, &value)) {
        why = "no register that is modelled";
    }
    if (why != NULL) {
        complain_of(bus, "read of", address, why);
    }
    return (value & lanes(address, bytes)) >> 8U * (address & 3U);
}

static void arrive(struct bus *bus, const struct bus_write *write)
{
    const struct bus_block *block = write->block;
    uint32_t offset = (write->address - block->base) & ~UINT32_C(3);
    if (!block->write(block->model, offset, write->value, write->mask)) {
        complain_of(bus, "write to", write->address, "no register that is modelled and can be written");
    }
}

/* The program may be some instructions further. */
static void on_bus_event(void *model, uint64_t cycle)
{
    struct bus *bus = model;
    struct clock *clock = bus->wires.clock;
    struct cpu *cpu = bus->wires.cpu;
    uint64_t now = clock->now;
    uint32_t at = cpu->at;
    clock->now = cycle;
    cpu->at = bus->write.at;
    arrive(bus, &bus->write);
    clock->now = now;
    cpu->at = at;
}

/* The complaint names the instruction at which the processor is meanwhile. */
void bus_deliver(struct bus *bus, uint32_t address, unsigned bytes, uint32_t value, uint64_t cycle)
{
    struct clock *clock = bus->wires.clock;
    uint64_t now = clock->now;
    struct bus_write write = {.block = find_block(bus, address),
                              .address = address,
                              .value = value << 8U * (address & 3U),
                              .mask = lanes(address, bytes)};
    clock->now = cycle;
    const char *why = refuse_write(bus, write.block, address, bytes, write.value & write.mask);
    if (why != NULL) {
        complain_of(bus, "a DMA stream's write to", address, why);
    } else {
        arrive(bus, &write);
    }
    clock->now = now;
}

uint32_t bus_fetch(struct bus *bus, uint32_t address, unsigned bytes, uint64_t cycle)
{
    struct clock *clock = bus->wires.clock;
    uint64_t now = clock->now;
    const struct bus_block *block = find_block(bus, address);
    const char *why = refuse(bus, block, address, bytes);
    uint32_t value = 0;
    clock->now = cycle;
    if (why == NULL && !block->read(block->model, (address - block->base) & ~UINT32_C(3), &value)) {
        why = "no register that is modelled";
    }
    if (why != NULL) {
        complain_of(bus, "a DMA stream's read of", address, why);
    }
    clock->now = now;
    return (value & lanes(address, bytes)) >> 8U * (address & 3U);
}

void bus_reset(struct bus *bus)
{
    bus->apb_busy_until = 0;
    for (unsigned i = 0; i < BUS_APBS; i++) {
        bus->taken_until[i] = 0;
    }
    clock_set(bus->wires.clock, EVENT_BUS, VTIME_NEVER);
}

static void write_peripheral(uc_engine *engine, uint64_t offset, unsigned bytes, uint64_t value, void *user)
{
    struct bus *bus = user;
    uint32_t address = PERIPHERAL_BASE + (uint32_t)offset;
    const struct bus_block *block = find_block(bus, address);
    struct bus_write write = {.block = block,
                              .address = address,
                              .value = (uint32_t)value << 8U * (address & 3U),
                              .mask = lanes(address, bytes),
                              .at = bus->wires.cpu->at};
    const char *why = refuse_write(bus, block, address, bytes, write.value & write.mask);
    (void)engine;

    wait_for_apb(bus, address, false);
    clock_run(bus->wires.clock, bus->wires.clock->now);
    if (why != NULL) {
        complain_of(bus, "write to", address, why);
    } else if (is_apb(address)) {
        bus->write = write;
        clock_set(bus->wires.clock, EVENT_BUS, bus->apb_busy_until);
    } else {
        arrive(bus, &write);
    }
}

static uint64_t read_system(uc_engine *engine, uint64_t offset, unsigned bytes, void *user)
{
    struct bus *bus = user;
    uint32_t address = SYSTEM_BASE + (uint32_t)offset;
    const char *why = refuse_system(address, bytes);
    uint32_t value = 0;
    (void)engine;
    clock_run(bus->wires.clock, bus->wires.clock->now);
    if (why == NULL && !core_read(bus->wires.core, address & ~3U, &value)) {
        why = "no register of the core that is modelled";
    }
    if (why != NULL) {
        complain_of(bus, "read of", address, why);
    }
    return (value & lanes(address, bytes)) >> 8U * (address & 3U);
}

static void write_system(uc_engine *engine, uint64_t offset, unsigned bytes, uint64_t value, void *user)
{
    struct bus *bus = user;
    uint32_t address = SYSTEM_BASE + (uint32_t)offset;
    uint32_t word = (uint32_t)value << 8U * (address & 3U);
    uint32_t mask = lanes(address, bytes);
    const char *why = refuse_system(address, bytes);
    (void)engine;
    clock_run(bus->wires.clock, bus->wires.clock->now);
    if (why == NULL && (word & mask & reserved_bits(address)) != 0) {
        why = RESERVED_TEXT;
    }
    if (why == NULL && !core_write(bus->wires.core, address & ~3U, word, mask)) {
        why = "no register of the core that is modelled and can be written";
    }
    if (why != NULL) {
        complain_of(bus, "write to", address, why);
    }
}

bool bus_init(struct bus *bus, struct bus_wires wires)
{
    uc_engine *engine = wires.cpu->engine;
    bus->wires = wires;
    clock_attach(wires.clock, EVENT_BUS, on_bus_event, bus);
    return uc_mmio_map(engine, PERIPHERAL_BASE, PERIPHERAL_BYTES, read_peripheral, bus, write_peripheral, bus) ==
               UC_ERR_OK &&
           uc_mmio_map(engine, SYSTEM_BASE, SYSTEM_BYTES, read_system, bus, write_system, bus) == UC_ERR_OK;
}

void bus_attach(struct bus *bus, struct bus_block block)
{
    assert(bus->blocks < BUS_BLOCKS_MAX);
    bus->block[bus->blocks++] = block;
}
