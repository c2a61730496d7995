/*
 * The flash memory interface (RM0090 chapter 3): keys, programming and erasing with their times, errors, and the bus
 * that waits while an operation runs. With faults on request: an operation that fails, and power cut in the middle.
 */
#ifndef FLASH_H
#define FLASH_H

#include <stdbool.h>
#include <stdint.h>

struct board;
struct options_cut;

enum flash_operation {
    FLASH_IDLE,
    FLASH_PROGRAM,
    FLASH_ERASE,
    FLASH_OPTIONS,
};

/* OPTCR of a part as it is delivered: no brown-out reset, no protection (RM0090 section 3.9.8). */
#define FLASH_OPTIONS_DELIVERED UINT32_C(0x0FFFAAED)

struct flash {
    uint32_t acr;
    uint32_t sr;
    uint32_t cr;
    uint32_t optcr;
    uint32_t options; /* what is kept of OPTCR; a reset brings it back */
    unsigned option_keys;
    uint64_t option_writes;
    unsigned keys;   /* how many of the two keys have come */
    bool locked_out; /* a wrong key: locked until the next reset */
    enum flash_operation operation;
    uint32_t address; /* of the operation in progress, offset in the memory */
    uint32_t bytes;
    uint32_t value; /* to be programmed */
    uint64_t done_cycle;
    bool read_protected; /* reads are watched, as the bus has to wait */
    bool code_changed;   /* what was executed before has been rewritten */
    bool fails;          /* the operation in progress */
    bool weak;           /* likewise: the supply was too low for it */
    uint32_t needs_mv;   /* of supply */
    unsigned weakened;
    const struct options_cut *cut; /* of power, in the middle of it; null: none */
    uint64_t operations;
    uint64_t programs;
    uint64_t erases;
    uint64_t stalls; /* how often the processor had to wait */
};

void flash_reset(struct board *board);

/* A store of 1, 2 or 4 bytes to an address in the flash. */
void flash_write(struct board *board, uint32_t address, unsigned bytes, uint32_t value);

bool flash_read_register(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool flash_write_register(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);
/* Power goes: what is in progress stays half done. */
void flash_cut(struct board *board);

void flash_event(struct board *board, uint64_t cycle);

/* BOR_LEV of the option bytes: 0 is level 3, 3 is off (RM0090 3.9.8). */
unsigned flash_brown_out_level(const struct flash *flash);

/* The supply has changed. */
void flash_watch_supply(struct board *board);

/* As a boot loader leaves it: wait states and caches; errors in SR, both locks open. */
void flash_set_wait_states(struct board *board, uint32_t states);
void flash_leave_unlocked(struct board *board);

/* Makes Unicorn report reads of the flash while it is busy; called while emulation stands. */
void flash_update_protection(struct board *board);

static inline bool flash_is_busy(const struct flash *flash)
{
    return flash->operation != FLASH_IDLE;
}

uint64_t flash_done_cycle(const struct board *board);
unsigned flash_latency(const struct flash *flash);
bool flash_instruction_cache_is_on(const struct flash *flash);
bool flash_data_cache_is_on(const struct flash *flash);
bool flash_prefetch_is_on(const struct flash *flash);

/* Reads the content from a file if there is one, and writes it back. False after a complaint. */
bool flash_load(struct board *board, const char *path);
bool flash_save(struct board *board, const char *path);

#endif
