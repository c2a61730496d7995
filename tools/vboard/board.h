/*
 * The whole virtual board: the part, what is wired to it, and the run. All models get a pointer to it.
 */
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stdint.h>

#include "art.h"
#include "bus.h"
#include "core.h"
#include "cpu.h"
#include "events.h"
#include "exception.h"
#include "exti.h"
#include "faults.h"
#include "flash.h"
#include "gpio.h"
#include "image.h"
#include "inputs.h"
#include "iwdg.h"
#include "loader.h"
#include "memory.h"
#include "nvic.h"
#include "options.h"
#include "pins.h"
#include "plain.h"
#include "profile.h"
#include "rcc.h"
#include "recorder.h"
#include "rs485.h"
#include "scb.h"
#include "stats.h"
#include "supply.h"
#include "timer.h"
#include "tty.h"
#include "usart.h"
#include "vtime.h"

enum board_end {
    BOARD_RUNS,
    BOARD_TIME,    /* --for is over */
    BOARD_REACHED, /* --end-at was reached */
    BOARD_POWER_CUT,
    BOARD_FAILED, /* the program did what the part does not do, or the model not */
};

enum {
    BOARD_TEXT_BYTES_MAX = 512,
    BOARD_WARNINGS_SHOWN = 20
};

struct board {
    const struct options *options;
    struct vtime time;
    struct events events;
    uint64_t event_cycle; /* of the event that runs, or of the last access to a peripheral */
    enum board_end end;
    char text[BOARD_TEXT_BYTES_MAX]; /* of BOARD_FAILED */
    enum reset_cause wanted_reset;
    unsigned resets[RESET_CAUSES];
    uint64_t reset_ps;      /* of the last one; 0: power-on */
    unsigned reset_steps;   /* the STEP pins that were active just before it, one bit a motor */
    unsigned reset_outputs; /* and the outputs */
    unsigned lockups;
    unsigned warnings;
    uint64_t real_ns; /* that the run took */

    struct image image;
    struct pins pins;
    struct memory memory;
    struct cpu cpu;
    struct bus bus;
    struct nvic nvic;
    struct scb scb;
    struct core core;
    struct rcc rcc;
    struct plain plain;
    struct supply supply;
    struct flash flash;
    struct iwdg iwdg;
    struct exti exti;
    struct port port[GPIO_PORTS];
    struct timer timer[TIMERS];
    struct usart usart[USARTS];
    struct rs485 line;
    struct tty tty;
    struct inputs inputs;
    struct faults faults;
    struct recorder recorder;
    struct stats stats;
    struct profile profile;
};

/* Builds a board with its program, ready to run from power-on. False after a complaint. */
bool board_init(struct board *board, const struct options *options);

/* Writes what is to be kept. False after a complaint. */
bool board_close(struct board *board);
void board_discard(struct board *board);

uint64_t board_now_ps(const struct board *board);

/* Ends the run. The first end counts. */
void board_finish(struct board *board, enum board_end end, const char *text);

/* Ends the run because of what the program does at present, with its place. */
__attribute__((format(printf, 2, 3))) void board_fail(struct board *board, const char *format, ...);

/* Tells of something that is surely not meant, with its place. */
__attribute__((format(printf, 2, 3))) void board_warn(struct board *board, const char *format, ...);

/* Resets the part at the next boundary, or now. */
void board_request_reset(struct board *board, enum reset_cause cause);
void board_reset(struct board *board, enum reset_cause cause);

/* The reset registers of RCC: the peripherals whose bits are set. */
void board_reset_peripherals(struct board *board, uint32_t offset, uint32_t bits);

/* The processor cannot go on without a reset: a fault inside the handler of faults, or no clock. */
void board_lock_up(struct board *board);
void board_stop_clock(struct board *board);

/* Lets time pass until something wakes the processor. */
void board_sleep(struct board *board);

/* Whether emulation must stop at the next boundary for something other than an exception. */
static inline bool board_wants_stop(const struct board *board)
{
    return board->end != BOARD_RUNS || board->wanted_reset != RESET_NONE || board->faults.due > 0 ||
           board->flash.code_changed || flash_is_busy(&board->flash) != board->flash.read_protected;
}

void board_measure_event(struct board *board, uint64_t cycle);
void board_end_event(struct board *board, uint64_t cycle);

#endif
