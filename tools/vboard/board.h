/*
 * The whole virtual board: the part, what is wired to it, and how they are connected. Each model gets what it needs of
 * the others and knows nothing of the board.
 */
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stdint.h>

#include "adc.h"
#include "bus.h"
#include "clock.h"
#include "conditions.h"
#include "core.h"
#include "cpu.h"
#include "dma.h"
#include "exception.h"
#include "exti.h"
#include "faults.h"
#include "fetch.h"
#include "flash.h"
#include "gpio.h"
#include "image.h"
#include "inputs.h"
#include "lockstep.h"
#include "iwdg.h"
#include "memory.h"
#include "nvic.h"
#include "options.h"
#include "pins.h"
#include "profile.h"
#include "rcc.h"
#include "recorder.h"
#include "report.h"
#include "requests.h"
#include "reset.h"
#include "rs485.h"
#include "scb.h"
#include "stats.h"
#include "supply.h"
#include "syscfg.h"
#include "timer.h"
#include "tty.h"
#include "usart.h"
#include "wires.h"

struct board {
    const struct options *options;
    unsigned resets[RESET_CAUSES];
    uint64_t reset_ps;      /* of the last one; 0: power-on */
    unsigned reset_steps;   /* the STEP pins that were active just before it, one bit a motor */
    unsigned reset_outputs; /* and the outputs */
    uint64_t real_ns;       /* that the run took */

    struct clock clock;
    struct report report;
    struct reset reset;
    struct image image;
    struct memory memory;

    struct cpu cpu;
    struct nvic nvic;
    struct scb scb;
    struct core core;
    struct exceptions exceptions;
    struct fetch fetch;
    struct bus bus;

    struct conditions conditions;
    struct flash flash;
    struct supply supply;
    struct rcc rcc;
    struct iwdg iwdg;
    struct exti exti;
    struct syscfg syscfg;
    struct gpio gpio;
    struct requests requests;
    struct timer timer[TIMERS];
    struct usart usart[USARTS];
    struct dma dma[DMA_CONTROLLERS];
    struct adc adc;

    struct pins pins;
    struct rs485 line;
    struct tty tty;
    struct lockstep lockstep;
    struct inputs inputs;
    struct wires wires;
    struct recorder recorder;
    struct faults faults;
    struct stats stats;
    struct profile profile;
};

/* Builds a board with its program, ready to run from power-on. False after a complaint. */
bool board_init(struct board *board, const struct options *options);

/* Writes what is to be kept. False after a complaint. */
bool board_close(struct board *board);
void board_discard(struct board *board);

/* Resets the part, now. */
void board_reset(struct board *board, enum reset_cause cause);

/* For board_init: puts the models at their addresses; what a change of the clocks, or a reset by RCC, reaches. */
void board_attach_peripherals(struct board *board);
struct rcc_outlet board_clock_outlet(struct board *board);

#endif
