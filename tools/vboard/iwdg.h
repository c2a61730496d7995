/*
 * The independent watchdog (RM0090 chapter 21), on the low-speed oscillator.
 */
#ifndef IWDG_H
#define IWDG_H

#include <stdbool.h>
#include <stdint.h>

struct board;

struct iwdg {
    bool started;
    bool unlocked;
    uint32_t prescaler;        /* PR */
    uint32_t reload;           /* RLR */
    uint64_t prescaler_end_ps; /* PVU is set until then */
    uint64_t reload_end_ps;    /* and RVU */
    uint64_t refreshes;
    uint64_t refreshed_ps;
    uint64_t longest_ps; /* between two refreshes */
};

void iwdg_reset(struct board *board);
bool iwdg_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool iwdg_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);
void iwdg_event(struct board *board, uint64_t cycle);

#endif
