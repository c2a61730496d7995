/*
 * One stream of a DMA controller (RM0090 sections 10.3.5 to 10.3.13), from memory to a peripheral or the other way: its
 * registers, its FIFO, and what is counted. When something happens is for dma.c.
 */
#ifndef DMA_STREAM_H
#define DMA_STREAM_H

#include <stdbool.h>
#include <stdint.h>

enum {
    DMA_FIFO_BYTES = 16,
    DMA_FIFO_QUARTER = DMA_FIFO_BYTES / 4,
};

/* DMA_SxCR (section 10.5.5). */
enum {
    DMA_CR_EN = 1 << 0,
    DMA_CR_INTERRUPTS = 0x1E, /* DMEIE, TEIE, HTIE, TCIE */
    DMA_CR_PFCTRL = 1 << 5,
    DMA_CR_DIR_SHIFT = 6,
    DMA_CR_CIRC = 1 << 8,
    DMA_CR_PINC = 1 << 9,
    DMA_CR_MINC = 1 << 10,
    DMA_CR_PSIZE_SHIFT = 11,
    DMA_CR_MSIZE_SHIFT = 13,
    DMA_CR_PINCOS = 1 << 15,
    DMA_CR_PL_SHIFT = 16,
    DMA_CR_DBM = 1 << 18,
    DMA_CR_BURSTS = 0xF << 21, /* PBURST, MBURST */
    DMA_CR_CHSEL_SHIFT = 25,
};

/* DMA_SxFCR (section 10.5.10). */
enum {
    DMA_FCR_FTH = 3,
    DMA_FCR_DMDIS = 1 << 2,
    DMA_FCR_FS_SHIFT = 3,
    DMA_FCR_FEIE = 1 << 7,
    DMA_FCR_RESET = 0x21,
};

/* Flags, as they stand in the lowest bits of DMA_LISR (section 10.5.1). */
enum {
    DMA_FLAG_FIFO = 1 << 0,
    DMA_FLAG_TRANSFER_ERROR = 1 << 3,
    DMA_FLAG_HALF = 1 << 4,
    DMA_FLAG_COMPLETE = 1 << 5,
};

struct dma_stream {
    uint32_t cr;
    uint32_t ndtr;
    uint32_t ndtr_written; /* what is counted down from */
    uint32_t par;
    uint32_t m0ar;
    uint32_t m1ar;
    uint32_t fcr; /* without FS */
    uint32_t flags;
    bool cut_short;  /* it was stopped between two ends, and NDTR was not written since */
    bool stopping;   /* EN was written 0 and still reads 1 */
    bool filling;    /* FIFO mode: until the FIFO is full */
    uint32_t source; /* addresses of the next load and the next store */
    uint32_t target;
    uint32_t unread_bytes; /* to a peripheral: of this round that have not been loaded */
    uint32_t stored_flags; /* from a peripheral: flags that come with the next store */
    uint32_t level;        /* bytes in the FIFO */
    uint8_t fifo[DMA_FIFO_BYTES];
    uint32_t slow_cycles; /* that the next access to memory takes more */
    uint64_t load_due;    /* cycle at which data come from memory, or get there; NEVER: none are on their way */
    uint64_t stop_due;
    uint64_t enabled_cycle;
    uint64_t transfers; /* since reset */
    uint64_t wait_most; /* cycles from the request to the arrival at the peripheral */
};

/* Bytes of a transfer to the peripheral, and of one from memory. */
uint32_t dma_stream_item_bytes(const struct dma_stream *stream);
uint32_t dma_stream_load_bytes(const struct dma_stream *stream);

/* What the manual forbids, or the model has not, in the registers of a stream that is about to be enabled; null:
 * nothing.
 */
const char *dma_stream_refuse(const struct dma_stream *stream);

/* EN has been set: NDTR, the addresses and the FIFO stand at their beginning. */
void dma_stream_begin(struct dma_stream *stream);

/* Whether it takes data from memory now; and takes them. */
bool dma_stream_wants_load(struct dma_stream *stream);
void dma_stream_load(struct dma_stream *stream, const uint8_t *data);

bool dma_stream_has_item(const struct dma_stream *stream);

/* The oldest item leaves the FIFO. */
uint32_t dma_stream_take(struct dma_stream *stream);

/* Whether it carries from a peripheral to memory. */
bool dma_stream_from_peripheral(const struct dma_stream *stream);

/* Of such a stream: an item has been fetched from the peripheral, and is counted; and it gets to memory. True: that was
 * the last one, and the stream has disabled itself. */
void dma_stream_fetched(struct dma_stream *stream, uint32_t item);
bool dma_stream_store(struct dma_stream *stream, uint8_t *data);

/* It has arrived at the peripheral. True: that was the last one, and the stream has disabled itself. */
bool dma_stream_count(struct dma_stream *stream);

/* It is disabled, and what is in its FIFO is lost. */
void dma_stream_end(struct dma_stream *stream);

/* DMA_SxFCR with the level of the FIFO. */
uint32_t dma_stream_fcr(const struct dma_stream *stream);

#endif
