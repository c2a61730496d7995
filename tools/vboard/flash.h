/*
 * The flash memory interface (RM0090 chapter 3): keys, programming and erasing with their times, errors, and the bus
 * that waits while an operation runs. With faults on request: an operation that fails, and power cut in the middle.
 */
#ifndef FLASH_H
#define FLASH_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "conditions.h"
#include "cost.h"
#include "memory.h"
#include "nvic.h"
#include "report.h"
#include "reset.h"
#include "stale.h"

enum {
    FLASH_CUTS_MAX = 4
};

enum flash_operation {
    FLASH_IDLE,
    FLASH_PROGRAM,
    FLASH_ERASE,
    FLASH_OPTIONS,
};

/* OPTCR of a part as it is delivered: no brown-out reset, no protection (RM0090 section 3.9.8). */
#define FLASH_OPTIONS_DELIVERED UINT32_C(0x0FFFAAED)

/* What a cut of power leaves of an operation: nothing of it, all, the first half; or, from SEED on, of the bits that
 * were to change some have and some have not. */
enum {
    FLASH_CUT_NOTHING,
    FLASH_CUT_ALL,
    FLASH_CUT_HALF,
    FLASH_CUT_SEED
};

struct flash_cut {
    uint64_t operation; /* from 1 */
    uint32_t leaves;
};

/* The part that is on the board, and what goes wrong with it on request. */
struct flash_settings {
    uint64_t kb;           /* that the part has */
    uint64_t erase_us;     /* 0: as the data sheet says */
    bool slow;             /* times of the worst case */
    uint32_t option_bytes; /* OPTCR at the start */
    uint64_t fail;         /* the operation that fails, from 1; 0: none */
    uint32_t error;        /* what SR tells then */
    bool bit;              /* one bit of it alone is not written */
    struct flash_cut cut[FLASH_CUTS_MAX];
    unsigned cuts;
    bool power_back; /* after a cut, at once */
};

struct flash_wires {
    struct clock *clock;
    struct report *report;
    struct reset *reset;
    struct nvic *nvic;
    struct conditions *conditions;
    struct memory *memory;
    const struct cost_table *costs; /* tell what has been executed */
    const struct flash_settings *settings;
    int wait_states;     /* as modelled; -1: those of ACR */
    bool prefetch_works; /* it does not in all revisions of the part */
};

struct flash {
    struct flash_wires wires;
    uint32_t wait_states; /* as modelled */
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
    uint32_t value;      /* to be programmed */
    bool read_protected; /* reads are watched, as the bus has to wait, or the data cache may have what was erased */
    struct stale stale;
    bool code_changed; /* what was executed before has been rewritten */
    bool fails;        /* the operation in progress */
    bool weak;         /* likewise: the supply was too low for it */
    uint32_t needs_mv; /* of supply */
    unsigned weakened;
    const struct flash_cut *cut; /* of power, in the middle of it; null: none */
    uint64_t operations;
    uint64_t programs;
    uint64_t erases;
    uint64_t stalls; /* how often the processor had to wait */
};

void flash_init(struct flash *flash, struct flash_wires wires);
void flash_reset(struct flash *flash);

/* A store of 1, 2 or 4 bytes to an address in the flash. */
void flash_write(struct flash *flash, uint32_t address, unsigned bytes, uint32_t value);

bool flash_read_register(void *model, uint32_t offset, uint32_t *value);
bool flash_write_register(void *model, uint32_t offset, uint32_t value, uint32_t mask);

/* Power goes: what is in progress stays half done. */
void flash_cut(struct flash *flash);

/* BOR_LEV of the option bytes: 0 is level 3, 3 is off (RM0090 3.9.8). */
unsigned flash_brown_out_level(const struct flash *flash);

/* The supply has changed. */
void flash_watch_supply(struct flash *flash);

/* As a boot loader leaves it: wait states and caches; errors in SR, both locks open. */
void flash_set_wait_states(struct flash *flash, uint32_t states);
void flash_leave_unlocked(struct flash *flash);

/* Waits until the flash is done, if `address` lies in it. */
void flash_stall(struct flash *flash, uint32_t address);

/* A read of data, after that. */
void flash_check_read(struct flash *flash, uint32_t address);

static inline bool flash_is_busy(const struct flash *flash)
{
    return flash->operation != FLASH_IDLE;
}

/* Whether reads have to be looked at. */
static inline bool flash_watches_reads(const struct flash *flash)
{
    return flash_is_busy(flash) || flash->stale.bytes != 0;
}

bool flash_instruction_cache_is_on(const struct flash *flash);
bool flash_data_cache_is_on(const struct flash *flash);
bool flash_prefetch_is_on(const struct flash *flash);

/* Reads the content from a file if there is one, and writes it back. False after a complaint. */
bool flash_load(struct flash *flash, const char *path);
bool flash_save(struct flash *flash, const char *path);

/* flash_outcome.c: what an operation leaves in the memory, all of it, or what is left of one that fails or is cut. */

/* A byte of the operation in progress, counted from its address, that was `before`. */
uint8_t flash_after(const struct flash *flash, uint32_t index, uint8_t before);

/* So many bytes change as they should; of the bits that were to change some have and some have not; all but one. */
void flash_change(struct flash *flash, uint32_t bytes);
void flash_change_some(struct flash *flash, uint32_t seed);
void flash_change_all_but_one_bit(struct flash *flash);

#endif
