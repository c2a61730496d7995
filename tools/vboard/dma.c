#include "dma.h"

#include <stddef.h>

enum {
    LOAD_CYCLES = 4, /* arbitration, address, bus matrix, one of SRAM (AN4031 table 5) */
    STOP_CYCLES = 8, /* EN reads 1 for a while after it was cleared (section 10.3.14); how long is not said */
};

static const enum nvic_irq irqs[DMA_CONTROLLERS][DMA_STREAMS] = {
    {NVIC_IRQ_DMA1_STREAM0, NVIC_IRQ_DMA1_STREAM1, NVIC_IRQ_DMA1_STREAM2, NVIC_IRQ_DMA1_STREAM3, NVIC_IRQ_DMA1_STREAM4,
     NVIC_IRQ_DMA1_STREAM5, NVIC_IRQ_DMA1_STREAM6, NVIC_IRQ_DMA1_STREAM7},
    {NVIC_IRQ_DMA2_STREAM0, NVIC_IRQ_DMA2_STREAM1, NVIC_IRQ_DMA2_STREAM2, NVIC_IRQ_DMA2_STREAM3, NVIC_IRQ_DMA2_STREAM4,
     NVIC_IRQ_DMA2_STREAM5, NVIC_IRQ_DMA2_STREAM6, NVIC_IRQ_DMA2_STREAM7},
};

static enum event event_of(const struct dma *dma)
{
    return dma->wires.number == 0 ? EVENT_DMA1 : EVENT_DMA2;
}

/* The enables of CR stand one bit below their flags. */
void dma_update_interrupts(struct dma *dma)
{
    for (unsigned i = 0; i < DMA_STREAMS; i++) {
        const struct dma_stream *stream = &dma->stream[i];
        bool by_fifo = (stream->fcr & DMA_FCR_FEIE) != 0 && (stream->flags & DMA_FLAG_FIFO) != 0;
        bool by_others = (stream->flags >> 1 & stream->cr & DMA_CR_INTERRUPTS) != 0;
        nvic_set_line(dma->wires.nvic, irqs[dma->wires.number][i], by_fifo || by_others);
    }
}

static uint32_t lines_of(const struct dma *dma, unsigned number)
{
    return dma_map_lines(dma->wires.number, number, dma->stream[number].cr >> DMA_CR_CHSEL_SHIFT & 7U);
}

/* The requests that a stream would serve now. */
static uint32_t asking(const struct dma *dma, unsigned number)
{
    const struct dma_stream *stream = &dma->stream[number];
    bool serves = (stream->cr & DMA_CR_EN) != 0 && !stream->stopping && stream->ndtr > 0;
    return serves ? lines_of(dma, number) & dma->wires.requests->high : 0U;
}

/* Section 10.3.18: a bus error stops the stream. */
static void fail_transfer(struct dma_stream *stream)
{
    stream->flags |= DMA_FLAG_TRANSFER_ERROR;
    dma_stream_end(stream);
}

void dma_lead_astray(struct dma *dma, unsigned number)
{
    struct dma_stream *stream = &dma->stream[number];
    uint32_t *address = dma_stream_from_peripheral(stream) ? &stream->target : &stream->source;
    *address = 0;
}

void dma_slow_down(struct dma *dma, unsigned number, uint32_t cycles)
{
    dma->stream[number].slow_cycles = cycles;
}

static void take_memory(struct dma *dma, struct dma_stream *stream, uint64_t cycle)
{
    uint64_t begin = dma->memory_busy_until > cycle ? dma->memory_busy_until : cycle;
    dma->memory_busy_until = begin + LOAD_CYCLES;
    stream->load_due = dma->memory_busy_until + stream->slow_cycles;
    stream->slow_cycles = 0;
}

static void begin_load(struct dma *dma, struct dma_stream *stream, uint64_t cycle)
{
    if (!dma_stream_from_peripheral(stream) && !stream->stopping && stream->load_due == VTIME_NEVER &&
        dma_stream_wants_load(stream)) {
        take_memory(dma, stream, cycle);
    }
}

/* Section 2.1: the memory port reaches SRAM and flash; CCM RAM hangs on the processor alone. */
static const uint8_t *find_source(struct dma *dma, const struct dma_stream *stream)
{
    uint32_t bytes = dma_stream_load_bytes(stream);
    bool is_flash = stream->source - MEMORY_FLASH_BASE < dma->wires.memory->flash_bytes;
    bool is_sram = stream->source - MEMORY_SRAM_BASE < MEMORY_SRAM_BYTES;
    return is_flash || is_sram ? memory_find(dma->wires.memory, stream->source, bytes) : NULL;
}

/* The memory port writes to SRAM. */
static void store(struct dma *dma, struct dma_stream *stream)
{
    bool is_sram = stream->target - MEMORY_SRAM_BASE < MEMORY_SRAM_BYTES;
    uint8_t *data = is_sram ? memory_find(dma->wires.memory, stream->target, stream->level) : NULL;
    stream->load_due = VTIME_NEVER;
    if (data == NULL) {
        fail_transfer(stream);
    } else {
        (void)dma_stream_store(stream, data);
    }
}

static void load(struct dma *dma, struct dma_stream *stream, uint64_t cycle)
{
    const uint8_t *data = find_source(dma, stream);
    stream->load_due = VTIME_NEVER;
    if (data == NULL) {
        fail_transfer(stream);
        return;
    }
    dma_stream_load(stream, data);
    begin_load(dma, stream, cycle);
}

static void deliver(struct dma *dma, uint64_t cycle)
{
    struct dma_stream *stream = &dma->stream[dma->carried];
    uint64_t wait = cycle - dma->asked;
    stream->wait_most = wait > stream->wait_most ? wait : stream->wait_most;
    dma->carried = DMA_STREAMS;
    dma->arrives = VTIME_NEVER;
    if (dma_stream_from_peripheral(stream)) {
        uint32_t bytes = dma_stream_item_bytes(stream);
        dma_stream_fetched(stream, bus_fetch(dma->wires.bus, stream->source, bytes, cycle));
        take_memory(dma, stream, cycle);
        return;
    }
    bus_deliver(dma->wires.bus, stream->target, dma_stream_item_bytes(stream), dma->item, cycle);
    bool is_on = (stream->cr & DMA_CR_EN) != 0; /* a load may have failed meanwhile */
    if (is_on && !dma_stream_count(stream)) {
        begin_load(dma, stream, cycle);
    }
}

/* Section 10.3.14: what is going on ends first; then the stream tells by TCIF that it has stopped. */
static void stop(struct dma *dma, unsigned number)
{
    struct dma_stream *stream = &dma->stream[number];
    if (dma->carried == number) {
        stream->stop_due = dma->arrives;
    } else if (stream->load_due != VTIME_NEVER) {
        stream->stop_due = stream->load_due;
    } else {
        stream->flags |= DMA_FLAG_COMPLETE;
        dma_stream_end(stream);
    }
}

/* A request that two streams hear: the manual does not say which of them serves it. */
static void check_requests(struct dma *dma)
{
    uint32_t heard = 0;
    uint32_t twice = 0;
    unsigned last = 0;
    for (unsigned i = 0; i < DMA_STREAMS; i++) {
        uint32_t lines = asking(dma, i);
        last = (heard & lines) != 0 ? i : last;
        twice |= heard & lines;
        heard |= lines;
    }
    if (twice != 0) {
        report_fail(dma->wires.report,
                    "DMA%u: a request reaches stream %u and one before it, both enabled; which serves it is not said "
                    "(RM0090 10.3.3)",
                    dma->wires.number + 1U, last);
        requests_lower(dma->wires.requests, twice);
    }
}

/* Section 10.3.4: the higher PL, then the lower number. A stream whose data have not come yet has an underrun, and one
 * whose data have not gone yet an overrun (section 10.3.18); its request waits. */
static unsigned find_next(struct dma *dma)
{
    unsigned best = DMA_STREAMS;
    uint32_t best_level = 0;
    for (unsigned i = 0; i < DMA_STREAMS; i++) {
        struct dma_stream *stream = &dma->stream[i];
        uint32_t level = (stream->cr >> DMA_CR_PL_SHIFT & 3U) + 1U;
        if (asking(dma, i) == 0) {
            continue;
        }
        if (dma_stream_from_peripheral(stream) ? stream->level != 0 : !dma_stream_has_item(stream)) {
            stream->flags |= DMA_FLAG_FIFO;
        } else if (level > best_level) {
            best = i;
            best_level = level;
        }
    }
    return best;
}

/* Section 10.3.1: the peripheral port of DMA1 reaches APB1 alone, that of DMA2 all buses, of which APB1 and APB2 are
 * modelled. */
static bool port_reaches(const struct dma *dma, uint32_t address)
{
    return bus_is_apb1(address) || (dma->wires.number == 1 && bus_is_apb2(address));
}

static void begin_transfer(struct dma *dma, unsigned number, uint64_t cycle)
{
    struct dma_stream *stream = &dma->stream[number];
    uint32_t lines = asking(dma, number);
    uint64_t since = requests_since(dma->wires.requests, lines);
    requests_lower(dma->wires.requests, lines);
    bool fetches = dma_stream_from_peripheral(stream);
    uint32_t address = fetches ? stream->source : stream->target;
    if (!port_reaches(dma, address)) {
        fail_transfer(stream);
        return;
    }
    dma->item = fetches ? 0U : dma_stream_take(stream);
    dma->asked = since > stream->enabled_cycle ? since : stream->enabled_cycle;
    dma->carried = number;
    dma->arrives = bus_take_apb(dma->wires.bus, address, cycle);
}

static void serve(struct dma *dma, uint64_t cycle)
{
    check_requests(dma);
    unsigned next = dma->carried == DMA_STREAMS ? find_next(dma) : DMA_STREAMS;
    while (next != DMA_STREAMS) {
        begin_transfer(dma, next, cycle);
        next = dma->carried == DMA_STREAMS ? find_next(dma) : DMA_STREAMS;
    }
}

static void set_event(struct dma *dma)
{
    uint64_t due = dma->arrives;
    for (unsigned i = 0; i < DMA_STREAMS; i++) {
        const struct dma_stream *stream = &dma->stream[i];
        due = stream->load_due < due ? stream->load_due : due;
        due = stream->stop_due < due ? stream->stop_due : due;
    }
    clock_set(dma->wires.clock, event_of(dma), due);
}

static void on_event(void *model, uint64_t cycle)
{
    struct dma *dma = model;
    for (unsigned i = 0; i < DMA_STREAMS; i++) {
        struct dma_stream *stream = &dma->stream[i];
        if (stream->load_due <= cycle && dma_stream_from_peripheral(stream)) {
            store(dma, stream);
        } else if (stream->load_due <= cycle) {
            load(dma, stream, cycle);
        }
    }
    if (dma->arrives <= cycle) {
        deliver(dma, cycle);
    }
    for (unsigned i = 0; i < DMA_STREAMS; i++) {
        if (dma->stream[i].stop_due <= cycle) {
            stop(dma, i);
        }
    }
    serve(dma, cycle);
    set_event(dma);
    dma_update_interrupts(dma);
}

/* All that ask on the same cycle are heard before one is served. */
void dma_note_request(void *model, uint64_t cycle)
{
    struct dma *dma = model;
    clock_set(dma->wires.clock, event_of(dma), cycle);
}

void dma_enable(struct dma *dma, unsigned number)
{
    struct dma_stream *stream = &dma->stream[number];
    uint64_t now = dma->wires.clock->now;
    const char *why = dma_stream_refuse(stream);
    if (why == NULL && lines_of(dma, number) == 0) {
        why = "no request of this channel is modelled (RM0090 10.3.3)";
    }
    if (why != NULL) {
        report_fail(dma->wires.report, "DMA%u stream %u: %s", dma->wires.number + 1U, number, why);
        return;
    }
    dma_stream_begin(stream);
    stream->enabled_cycle = now;
    begin_load(dma, stream, now);
    clock_set(dma->wires.clock, event_of(dma), now); /* a request may be waiting */
}

void dma_disable(struct dma *dma, unsigned number)
{
    struct dma_stream *stream = &dma->stream[number];
    if (!stream->stopping) {
        stream->stopping = true;
        stream->stop_due = dma->wires.clock->now + STOP_CYCLES;
        set_event(dma);
    }
}

void dma_reset(struct dma *dma)
{
    *dma = (struct dma){.wires = dma->wires, .carried = DMA_STREAMS, .arrives = VTIME_NEVER};
    for (unsigned i = 0; i < DMA_STREAMS; i++) {
        dma->stream[i].fcr = DMA_FCR_RESET & ~(UINT32_C(7) << DMA_FCR_FS_SHIFT);
        dma->stream[i].load_due = VTIME_NEVER;
        dma->stream[i].stop_due = VTIME_NEVER;
    }
    set_event(dma);
    dma_update_interrupts(dma);
}

void dma_init(struct dma *dma, struct dma_wires wires)
{
    dma->wires = wires;
    clock_attach(wires.clock, event_of(dma), on_event, dma);
}
