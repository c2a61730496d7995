/*
 * The two DMA controllers (RM0090 chapter 10): eight streams each that carry data from memory to the peripherals, or
 * the other way, each when one of its requests comes. One transfer at a time is on the way to or from the peripherals;
 * the stream of the highest priority is next. Not modelled: double buffers, bursts, contention of the memory port with
 * the processor.
 */
#ifndef DMA_H
#define DMA_H

#include <stdbool.h>
#include <stdint.h>

#include "bus.h"
#include "clock.h"
#include "dma_map.h"
#include "dma_stream.h"
#include "memory.h"
#include "nvic.h"
#include "report.h"
#include "requests.h"

struct dma_wires {
    unsigned number; /* 0: DMA1 */
    struct clock *clock;
    struct report *report;
    struct nvic *nvic;
    struct memory *memory;
    struct bus *bus;
    struct requests *requests;
};

struct dma {
    struct dma_wires wires;
    struct dma_stream stream[DMA_STREAMS];
    unsigned carried; /* the stream whose transfer is on its way to or from the peripheral; DMA_STREAMS: none */
    uint32_t item;
    uint64_t arrives; /* cycle */
    uint64_t asked;   /* since when it was asked for */
    uint64_t memory_busy_until;
};

void dma_init(struct dma *dma, struct dma_wires wires);
void dma_reset(struct dma *dma);

/* For requests.h: a line has gone high. The model is a struct dma. */
void dma_note_request(void *model, uint64_t cycle);

/* For dma_registers.c: EN is set, or cleared by software; flags or enables have changed. */
void dma_enable(struct dma *dma, unsigned number);
void dma_disable(struct dma *dma, unsigned number);
void dma_update_interrupts(struct dma *dma);

/* The next load of a stream goes to an address where nothing is, as after an upset of the controller. */
void dma_lead_astray(struct dma *dma, unsigned number);

/* The next access of a stream to memory takes so much longer, as when another master holds the bus. */
void dma_slow_down(struct dma *dma, unsigned number, uint32_t cycles);

#endif
