#include "dma_stream.h"

#include <stddef.h>
#include <string.h>

#include "vtime.h"

enum {
    FROM_PERIPHERAL,
    TO_PERIPHERAL,
    FROM_MEMORY_TO_MEMORY,
    SIZE_RESERVED = 3,
    WORD_BYTES = 4,
    FIFO_EMPTY = 4, /* FS */
    FIFO_FULL = 5,
};

static bool is_direct(const struct dma_stream *stream)
{
    return (stream->fcr & DMA_FCR_DMDIS) == 0;
}

static unsigned peripheral_size(const struct dma_stream *stream)
{
    return stream->cr >> DMA_CR_PSIZE_SHIFT & 3U;
}

static unsigned memory_size(const struct dma_stream *stream)
{
    return stream->cr >> DMA_CR_MSIZE_SHIFT & 3U;
}

uint32_t dma_stream_item_bytes(const struct dma_stream *stream)
{
    return UINT32_C(1) << peripheral_size(stream);
}

uint32_t dma_stream_load_bytes(const struct dma_stream *stream)
{
    return UINT32_C(1) << memory_size(stream);
}

static const char *refuse_direction(const struct dma_stream *stream)
{
    switch (stream->cr >> DMA_CR_DIR_SHIFT & 3U) {
    case FROM_PERIPHERAL:
        return is_direct(stream) ? NULL : "from peripheral to memory only direct mode is modelled";
    case TO_PERIPHERAL:
        return NULL;
    case FROM_MEMORY_TO_MEMORY:
        return "from memory to memory only DMA2 can carry (RM0090 10.3.6), and it is not modelled";
    default:
        return "DIR is reserved (RM0090 10.5.5)";
    }
}

static const char *refuse_mode(const struct dma_stream *stream)
{
    if ((stream->cr & DMA_CR_PFCTRL) != 0) {
        return "only SDIO can be the flow controller (RM0090 10.3.15), and it is not modelled";
    }
    if ((stream->cr & DMA_CR_DBM) != 0) {
        return "double buffers are not modelled";
    }
    return !is_direct(stream) && (stream->cr & DMA_CR_BURSTS) != 0 ? "bursts are not modelled" : NULL;
}

/* In direct mode MSIZE is not looked at. */
static const char *refuse_sizes(const struct dma_stream *stream)
{
    unsigned memory = is_direct(stream) ? peripheral_size(stream) : memory_size(stream);
    if (peripheral_size(stream) == SIZE_RESERVED || memory == SIZE_RESERVED) {
        return "a size is reserved (RM0090 10.5.5)";
    }
    if (stream->m0ar % (1U << memory) != 0 || stream->par % dma_stream_item_bytes(stream) != 0) {
        return "an address is not aligned to the size of its data (RM0090 10.3.6)";
    }
    if (stream->ndtr_written * dma_stream_item_bytes(stream) % (1U << memory) != 0) {
        return "the last transfer would be incomplete (RM0090 10.3.10)";
    }
    return NULL;
}

const char *dma_stream_refuse(const struct dma_stream *stream)
{
    const char *why = refuse_direction(stream);
    why = why == NULL ? refuse_mode(stream) : why;
    why = why == NULL ? refuse_sizes(stream) : why;
    if (why == NULL && stream->flags != 0) {
        return "its flags must be cleared before EN is set (RM0090 10.5.5)";
    }
    if (why == NULL && stream->cut_short) {
        return "it was stopped before its end and NDTR not written since; the manual does not say what it counts from "
               "(RM0090 10.3.14)";
    }
    return why;
}

/* A round: as many items as NDTR was written with. */
static void begin_round(struct dma_stream *stream)
{
    stream->source = stream->m0ar;
    stream->unread_bytes = stream->ndtr_written * dma_stream_item_bytes(stream);
}

/* Section 10.5.5: in direct mode the hardware clears MBURST, PBURST and PINCOS, and MSIZE becomes as PSIZE. */
static void force_direct(struct dma_stream *stream)
{
    stream->cr &= ~((uint32_t)DMA_CR_BURSTS | DMA_CR_PINCOS | 3U << DMA_CR_MSIZE_SHIFT);
    stream->cr |= peripheral_size(stream) << DMA_CR_MSIZE_SHIFT;
}

void dma_stream_begin(struct dma_stream *stream)
{
    stream->cr |= DMA_CR_EN;
    if (is_direct(stream)) {
        force_direct(stream);
    }
    stream->ndtr = stream->ndtr_written;
    stream->target = stream->par;
    stream->level = 0;
    stream->filling = true;
    stream->stored_flags = 0;
    if (dma_stream_from_peripheral(stream)) {
        stream->source = stream->par;
        stream->target = stream->m0ar;
        return;
    }
    begin_round(stream);
}

bool dma_stream_from_peripheral(const struct dma_stream *stream)
{
    return (stream->cr >> DMA_CR_DIR_SHIFT & 3U) == FROM_PERIPHERAL;
}

/* Direct mode: one item, as soon as the FIFO is empty. FIFO mode: from the threshold on until it is full. */
bool dma_stream_wants_load(struct dma_stream *stream)
{
    if (stream->unread_bytes == 0 && (stream->cr & DMA_CR_CIRC) != 0) {
        begin_round(stream);
    }
    if (is_direct(stream)) {
        return stream->unread_bytes > 0 && stream->level == 0;
    }
    uint32_t threshold = ((stream->fcr & DMA_FCR_FTH) + 1U) * DMA_FIFO_QUARTER;
    bool has_room = stream->level + dma_stream_load_bytes(stream) <= DMA_FIFO_BYTES;
    stream->filling = has_room && (stream->filling || stream->level <= threshold);
    return stream->unread_bytes > 0 && stream->filling;
}

void dma_stream_load(struct dma_stream *stream, const uint8_t *data)
{
    uint32_t bytes = dma_stream_load_bytes(stream);
    memcpy(stream->fifo + stream->level, data, bytes);
    stream->level += bytes;
    stream->unread_bytes -= bytes;
    stream->source += (stream->cr & DMA_CR_MINC) != 0 ? bytes : 0U;
}

bool dma_stream_has_item(const struct dma_stream *stream)
{
    return stream->level >= dma_stream_item_bytes(stream);
}

uint32_t dma_stream_take(struct dma_stream *stream)
{
    uint32_t bytes = dma_stream_item_bytes(stream);
    uint32_t item = 0;
    for (uint32_t i = bytes; i > 0; i--) {
        item = item << 8 | stream->fifo[i - 1U];
    }
    stream->level -= bytes;
    memmove(stream->fifo, stream->fifo + bytes, stream->level);
    return item;
}

/* Section 10.3.17: half of the data has been transferred; of an odd number, more than half. */
static bool is_half(const struct dma_stream *stream)
{
    return stream->ndtr == stream->ndtr_written / 2U;
}

bool dma_stream_count(struct dma_stream *stream)
{
    bool steps = (stream->cr & DMA_CR_PINC) != 0;
    uint32_t step = (stream->cr & DMA_CR_PINCOS) != 0 ? WORD_BYTES : dma_stream_item_bytes(stream);
    stream->target += steps ? step : 0U;
    stream->transfers++;
    stream->ndtr--;
    stream->flags |= is_half(stream) ? DMA_FLAG_HALF : 0U;
    if (stream->ndtr > 0) {
        return false;
    }
    stream->flags |= DMA_FLAG_COMPLETE;
    if ((stream->cr & DMA_CR_CIRC) == 0) {
        dma_stream_end(stream);
        return true;
    }
    stream->ndtr = stream->ndtr_written;
    stream->target = stream->par;
    return false;
}

/* Section 10.5.6: the number counts transfers at the peripheral. The flags tell of those that are complete. */
void dma_stream_fetched(struct dma_stream *stream, uint32_t item)
{
    uint32_t bytes = dma_stream_item_bytes(stream);
    bool steps = (stream->cr & DMA_CR_PINC) != 0;
    for (uint32_t i = 0; i < bytes; i++) {
        stream->fifo[i] = (uint8_t)(item >> 8U * i);
    }
    stream->level = bytes;
    stream->source += steps ? bytes : 0U;
    stream->transfers++;
    stream->ndtr--;
    stream->stored_flags |= is_half(stream) ? DMA_FLAG_HALF : 0U;
    if (stream->ndtr == 0) {
        stream->stored_flags |= DMA_FLAG_COMPLETE;
        bool circular = (stream->cr & DMA_CR_CIRC) != 0;
        stream->ndtr = circular ? stream->ndtr_written : 0U;
        stream->source = circular ? stream->par : stream->source;
    }
}

bool dma_stream_store(struct dma_stream *stream, uint8_t *data)
{
    uint32_t flags = stream->stored_flags;
    memcpy(data, stream->fifo, stream->level);
    stream->target += (stream->cr & DMA_CR_MINC) != 0 ? stream->level : 0U;
    stream->level = 0;
    stream->flags |= flags;
    stream->stored_flags = 0;
    if ((flags & DMA_FLAG_COMPLETE) == 0) {
        return false;
    }
    stream->target = stream->m0ar;
    if ((stream->cr & DMA_CR_CIRC) != 0) {
        return false;
    }
    dma_stream_end(stream);
    return true;
}

void dma_stream_end(struct dma_stream *stream)
{
    stream->cr &= ~(uint32_t)DMA_CR_EN;
    stream->stopping = false;
    stream->level = 0;
    stream->load_due = VTIME_NEVER;
    stream->stop_due = VTIME_NEVER;
    stream->cut_short = stream->ndtr != 0 && stream->ndtr != stream->ndtr_written;
}

uint32_t dma_stream_fcr(const struct dma_stream *stream)
{
    uint32_t status = stream->level / DMA_FIFO_QUARTER;
    if (stream->level == 0) {
        status = FIFO_EMPTY;
    } else if (stream->level == DMA_FIFO_BYTES) {
        status = FIFO_FULL;
    }
    return stream->fcr | status << DMA_FCR_FS_SHIFT;
}
