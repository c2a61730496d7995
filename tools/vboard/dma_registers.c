#include "dma_registers.h"

#include "dma.h"

enum {
    DMA_LISR = 0x00,
    DMA_HISR = 0x04,
    DMA_LIFCR = 0x08,
    DMA_HIFCR = 0x0C,
    DMA_S0CR = 0x10,
    DMA_STREAM_BYTES = 0x18,
    DMA_END = DMA_S0CR + DMA_STREAMS * DMA_STREAM_BYTES,
    STREAMS_PER_REGISTER = 4,
    STREAM_FLAGS = 0x3D,
};

/* Registers of a stream, from its CR on. */
enum {
    SX_CR = 0x00,
    SX_NDTR = 0x04,
    SX_PAR = 0x08,
    SX_M0AR = 0x0C,
    SX_M1AR = 0x10,
    SX_FCR = 0x14,
};

/* Where the flags of a stream stand in LISR or HISR. */
static unsigned flag_shift(unsigned stream)
{
    static const uint8_t shifts[STREAMS_PER_REGISTER] = {0, 6, 16, 22};
    return shifts[stream % STREAMS_PER_REGISTER];
}

static uint32_t read_flags(const struct dma *dma, unsigned first)
{
    uint32_t value = 0;
    for (unsigned i = first; i < first + STREAMS_PER_REGISTER; i++) {
        value |= dma->stream[i].flags << flag_shift(i);
    }
    return value;
}

static void clear_flags(struct dma *dma, unsigned first, uint32_t value)
{
    for (unsigned i = first; i < first + STREAMS_PER_REGISTER; i++) {
        dma->stream[i].flags &= ~(value >> flag_shift(i) & (uint32_t)STREAM_FLAGS);
    }
}

static bool read_stream(const struct dma_stream *stream, uint32_t offset, uint32_t *value)
{
    switch (offset) {
    case SX_CR:
        *value = stream->cr;
        return true;
    case SX_NDTR:
        *value = stream->ndtr;
        return true;
    case SX_PAR:
        *value = stream->par;
        return true;
    case SX_M0AR:
        *value = stream->m0ar;
        return true;
    case SX_M1AR:
        *value = stream->m1ar;
        return true;
    case SX_FCR:
        *value = dma_stream_fcr(stream);
        return true;
    default:
        return false;
    }
}

bool dma_read(void *model, uint32_t offset, uint32_t *value)
{
    const struct dma *dma = model;
    if (offset == DMA_LISR || offset == DMA_HISR) {
        *value = read_flags(dma, offset == DMA_LISR ? 0U : STREAMS_PER_REGISTER);
        return true;
    }
    if (offset < DMA_S0CR || offset >= DMA_END) {
        return false;
    }
    unsigned number = (offset - DMA_S0CR) / DMA_STREAM_BYTES;
    return read_stream(&dma->stream[number], (offset - DMA_S0CR) % DMA_STREAM_BYTES, value);
}

static void refuse(struct dma *dma, unsigned number, const char *what)
{
    report_fail(dma->wires.report, "DMA%u stream %u: %s", dma->wires.number + 1U, number, what);
}

static void write_cr(struct dma *dma, unsigned number, uint32_t value)
{
    struct dma_stream *stream = &dma->stream[number];
    uint32_t free_bits = DMA_CR_EN | DMA_CR_INTERRUPTS;
    bool enables = (value & DMA_CR_EN) != 0;
    if ((stream->cr & DMA_CR_EN) == 0) {
        stream->cr = value & ~(uint32_t)DMA_CR_EN;
        if (enables) {
            dma_enable(dma, number);
        }
    } else if (((stream->cr ^ value) & ~free_bits) != 0) {
        refuse(dma, number, "CR is configured while EN is 1 (RM0090 10.5.5)");
    } else if (enables && stream->stopping) {
        refuse(dma, number, "EN is set before it has been read as 0 (RM0090 10.3.17)");
    } else {
        stream->cr = (stream->cr & ~(uint32_t)DMA_CR_INTERRUPTS) | (value & DMA_CR_INTERRUPTS);
        if (!enables) {
            dma_disable(dma, number);
        }
    }
}

/* FS is read-only. */
static void write_fcr(struct dma *dma, unsigned number, uint32_t value)
{
    struct dma_stream *stream = &dma->stream[number];
    uint32_t set = value & ((uint32_t)DMA_FCR_FTH | DMA_FCR_DMDIS | DMA_FCR_FEIE);
    if ((stream->cr & DMA_CR_EN) != 0 && ((stream->fcr ^ set) & ~(uint32_t)DMA_FCR_FEIE) != 0) {
        refuse(dma, number, "FCR is configured while EN is 1 (RM0090 10.5.5)");
        return;
    }
    stream->fcr = set;
}

/* What can be written only while EN is 0. */
static bool write_protected(struct dma_stream *stream, uint32_t offset, uint32_t value)
{
    switch (offset) {
    case SX_NDTR:
        stream->ndtr = value;
        stream->ndtr_written = value;
        stream->cut_short = false;
        return true;
    case SX_PAR:
        stream->par = value;
        return true;
    case SX_M0AR:
        stream->m0ar = value;
        return true;
    case SX_M1AR:
        stream->m1ar = value;
        return true;
    default:
        return false;
    }
}

static bool write_stream(struct dma *dma, unsigned number, uint32_t offset, uint32_t value)
{
    struct dma_stream *stream = &dma->stream[number];
    if (offset == SX_CR) {
        write_cr(dma, number, value);
        return true;
    }
    if (offset == SX_FCR) {
        write_fcr(dma, number, value);
        return true;
    }
    if ((stream->cr & DMA_CR_EN) != 0) {
        refuse(dma, number, "NDTR or an address is written while EN is 1, and lost (RM0090 10.5.6 to 10.5.9)");
        return true;
    }
    return write_protected(stream, offset, value);
}

/* The registers are accessed by words, so that the mask is full. */
bool dma_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct dma *dma = model;
    bool known = false;
    (void)mask;
    if (offset == DMA_LIFCR || offset == DMA_HIFCR) {
        clear_flags(dma, offset == DMA_LIFCR ? 0U : STREAMS_PER_REGISTER, value);
        known = true;
    } else if (offset >= DMA_S0CR && offset < DMA_END) {
        unsigned number = (offset - DMA_S0CR) / DMA_STREAM_BYTES;
        known = write_stream(dma, number, (offset - DMA_S0CR) % DMA_STREAM_BYTES, value);
    }
    dma_update_interrupts(dma);
    return known;
}
