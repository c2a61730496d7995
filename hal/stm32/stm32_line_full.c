/*
 * Full duplex: receiver and transmitter are always on. A byte takes 10.85 us at 921 600 Bd and the step interrupt may
 * take ten times that, so a stream of DMA2 puts what comes into a ring of memory (RM0090 30.3.13, 10.3). No interrupt
 * comes with a byte: the tick interrupt fetches what is there every millisecond, and main more often.
 *
 * A byte with a framing error or noise goes the same way; what tells is a flag in SR that stays until somebody reads SR
 * and then DR (30.6.1), be it the stream. So SR is read in one place, after the look at how far the stream is: as long
 * as there is no error in it, all bytes up to there are good. After an error all that came since the last such look is
 * broken. An interrupt of its own makes that look soon.
 *
 * The stream is not held up by those of the steps, which are on DMA1. ES0182 warns of DMA2 when it serves AHB and APB
 * at a time; this stream is the only one.
 */
#include <stddef.h>

#include "base_tick.h"
#include "stm32_line_private.h"

static_assert(BOARD_USART == 1, "the streams of USART2 and USART3 are on DMA1, where those of the steps are");

enum {
    HEARD_MAX = 256, /* bytes, a power of two: 2.7 ms at 921 600 Bd */
    STREAM = 2,      /* USART1_RX, RM0090 table 43 */
    CHANNEL = 4,
    STREAM_FLAGS = 0x3D << 16, /* of stream 2 in LIFCR, 10.5.3 */
    HIGH = 2,                  /* priority, 10.5.5 */
    HALF_WORDS = 1,
    LISTENING = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE,
    SENDING = LISTENING | USART_CR1_TXEIE,
    ERRORS = USART_SR_FE | USART_SR_NF | USART_SR_ORE,
    STREAM_TURNS_MAX = 32, /* the stream takes a byte within a microsecond */
    BITS = 10,             /* of a byte on the line */
    PRIORITY_PLACE = 4,    /* four bits of priority, at the top of a byte; PM0214 4.3.7 */

    /* Main looks at the line so often; an answer begins a millisecond after its command at the latest. */
    LOOK_TICKS = 300 * TICKS_PER_US,
    ROUND_TICKS = HEARD_MAX * BITS * (TICK_HZ / IMAGE_LINE_BD),
};
static_assert(ROUND_TICKS > 2 * TICKS_PER_MS, "the ring has room for what comes between two ticks");

/* The bus of USART1 has half the clock of the processor. All six rates are within 0.2 %; without the crystal the
 * oscillator adds its own. */
enum {
    BUS_HZ = 84000000,
    RATE_ERROR_MAX = 500 /* one part of so many */
};
#define ACTUAL_BD(bd) ((uint32_t)BUS_HZ / STM32_LINE_DIVIDER((uint32_t)BUS_HZ, bd))
#define RATE_ERROR(bd) (ACTUAL_BD(bd) > (bd) ? ACTUAL_BD(bd) - (bd) : (bd) - ACTUAL_BD(bd))
#define RATE_FITS(bd) (RATE_ERROR(bd) * (uint32_t)RATE_ERROR_MAX <= (bd))
static_assert(RATE_FITS(38400U) && RATE_FITS(57600U) && RATE_FITS(115200U) && RATE_FITS(230400U) &&
                  RATE_FITS(460800U) && RATE_FITS(921600U),
              "a rate of the line is off");
static_assert(IMAGE_LINE_BD == 38400U || IMAGE_LINE_BD == 57600U || IMAGE_LINE_BD == 115200U ||
                  IMAGE_LINE_BD == 230400U || IMAGE_LINE_BD == 460800U || IMAGE_LINE_BD == 921600U,
              "the line has one of six rates");

/* The count of the stream is that of a round, and so is `fetched`. */
static struct {
    uint16_t heard[HEARD_MAX]; /* DR is read by half-words, 30.6 */
    uint32_t fetched;
    uint32_t fetched_tick;
    bool looked;           /* main has had what was there */
    bool lost;             /* bytes before the next one are missing */
    bool out;              /* what main gave is known to have been sent: no more looks at the transmitter */
    volatile bool refused; /* main waits for room */
} full;

/* Holds off the interrupts of line and tick, not that of the steps. */
static uint32_t hold(void)
{
    uint32_t before;
    __asm__ volatile("mrs %0, basepri\n\tmsr basepri_max, %1\n\tisb"
                     : "=&r"(before)
                     : "r"((uint32_t)STM32_PRIORITY_LINE << PRIORITY_PLACE)
                     : "memory");
    return before;
}

static void release(uint32_t before)
{
    __asm__ volatile("msr basepri, %0" ::"r"(before) : "memory");
}

static uint32_t count_arrived(void)
{
    return ((uint32_t)HEARD_MAX - DMA_NDTR(DMA2_STREAM(STREAM))) % HEARD_MAX;
}

static void wait_for_stream(void)
{
    for (unsigned turns = 0; turns < (unsigned)STREAM_TURNS_MAX; turns++) {
        if ((USART_SR(STM32_LINE_BASE) & USART_SR_RXNE) == 0) {
            return;
        }
    }
}

/* The read of DR may take a byte that comes at that very moment away from the stream; then it is another one than the
 * stream's last. */
static void end_errors(void)
{
    const volatile uint16_t *heard = full.heard;
    wait_for_stream();
    uint32_t end = count_arrived();
    (void)USART_SR(STM32_LINE_BASE);
    uint8_t value = (uint8_t)USART_DR(STM32_LINE_BASE);
    bool taken = value != (uint8_t)heard[(end - 1U) % HEARD_MAX];
    wait_for_stream();
    full.lost = full.lost || taken || count_arrived() == full.fetched;
}

static void start_stream(void)
{
    uintptr_t stream = DMA2_STREAM(STREAM);
    DMA2_LIFCR = STREAM_FLAGS;
    DMA_PAR(stream) = (uint32_t)(uintptr_t)&USART_DR(STM32_LINE_BASE);
    DMA_M0AR(stream) = (uint32_t)(uintptr_t)full.heard;
    DMA_NDTR(stream) = HEARD_MAX;
    DMA_FCR(stream) = 0;
    DMA_CR(stream) = DMA_CR_CHSEL((uint32_t)CHANNEL) | DMA_CR_PL((uint32_t)HIGH) | DMA_CR_MINC | DMA_CR_CIRC |
                     DMA_CR_PSIZE((uint32_t)HALF_WORDS) | DMA_CR_MSIZE((uint32_t)HALF_WORDS);
    DMA_CR(stream) |= DMA_CR_EN;
    full.fetched = 0;
}

static void keep(uint32_t end, uint32_t tick, bool broken)
{
    const volatile uint16_t *heard = full.heard;
    uint32_t next = full.fetched;
    uint32_t in = stm32_line.received_in;
    while (next != end) {
        in = stm32_line_keep(in, tick, (uint8_t)heard[next], broken || full.lost);
        full.lost = false;
        next = (next + 1U) % HEARD_MAX;
    }
    full.fetched = next;
    stm32_line.received_in = in;
}

/* Fetches what has come; tells what SR was. The stream counts a byte some cycles before it is in memory, so a look at a
 * timer comes in between. Bytes that went round are not known: all are broken then. */
static uint32_t fetch(void)
{
    uint32_t before = hold();
    uint32_t end = count_arrived();
    uint32_t status = USART_SR(STM32_LINE_BASE);
    bool broken = (status & (uint32_t)ERRORS) != 0;
    if (broken) {
        end_errors();
        end = count_arrived();
    }
    uint32_t now = TIM2_CNT;
    keep(end, now, broken || now - full.fetched_tick >= (uint32_t)ROUND_TICKS);
    full.fetched_tick = now;
    if ((DMA_CR(DMA2_STREAM(STREAM)) & DMA_CR_EN) == 0) {
        start_stream();
        full.lost = true;
    }
    release(before);
    return status;
}

/* Where nothing is left to be sent, the transmitter asks no more. */
static void send_next(void)
{
    if (stm32_line.sending_out == stm32_line.sending_in) {
        USART_CR1(STM32_LINE_BASE) = LISTENING;
        return;
    }
    USART_DR(STM32_LINE_BASE) = stm32_line.sending[stm32_line.sending_out % SENDING_MAX];
    stm32_line.sending_out++;
}

void stm32_line_interrupt(void)
{
    uint32_t status = fetch();
    if ((status & USART_SR_TXE) != 0) {
        send_next();
    }
    bool room = stm32_line.sending_in - stm32_line.sending_out <= (uint32_t)SENDING_MAX / 2U;
    if ((status & (uint32_t)ERRORS) != 0 || (full.refused && room)) {
        full.refused = false;
        stm32_event = true;
    }
}

bool hal_line_read(struct hal_line_byte *byte)
{
    if (stm32_line.received_out == stm32_line.received_in) {
        (void)fetch();
    }
    return stm32_line_take(byte);
}

/* One look at the stream serves all that main takes in a pass: each byte that it waited for would cost as much. */
bool hal_line_read_run(struct hal_line_run *run, uint8_t last)
{
    if (stm32_line.received_out == stm32_line.received_in) {
        full.looked = !full.looked;
        if (!full.looked) {
            return false;
        }
        (void)fetch();
    }
    return stm32_line_take_run(run, last);
}

bool hal_line_write(uint8_t byte)
{
    if (stm32_line.sending_in - stm32_line.sending_out == (uint32_t)SENDING_MAX) {
        full.refused = true;
        return false;
    }
    stm32_line.sending[stm32_line.sending_in % SENDING_MAX] = byte;
    full.out = false;
    uint32_t before = hold();
    stm32_line.sending_in++;
    USART_CR1(STM32_LINE_BASE) = SENDING;
    release(before);
    return true;
}

bool hal_line_is_idle(void)
{
    full.out = full.out || (stm32_line.sending_out == stm32_line.sending_in && (fetch() & USART_SR_TC) != 0);
    return full.out;
}

void stm32_line_tick(void)
{
    (void)fetch();
}

void stm32_line_look(void)
{
}

uint32_t stm32_line_look_ticks(void)
{
    return LOOK_TICKS;
}

/* A board with a driver that can be switched drives its line for ever. */
void stm32_line_start(const struct stm32_clock *clock)
{
    STM32_LINE_CLOCK_ENABLE();
    stm32_enable_clock(&RCC_AHB1ENR, RCC_AHB1ENR_DMA2EN);
    start_stream();
    full.fetched_tick = TIM2_CNT;
    USART_BRR(STM32_LINE_BASE) = STM32_LINE_DIVIDER(STM32_LINE_CLOCK_HZ(clock), IMAGE_LINE_BD);
    USART_CR3(STM32_LINE_BASE) = USART_CR3_DMAR | USART_CR3_EIE;
    USART_CR1(STM32_LINE_BASE) = LISTENING;
    stm32_pins_start_sender();
    stm32_pin_write(STM32_PIN_LINE_DE, true);
}
