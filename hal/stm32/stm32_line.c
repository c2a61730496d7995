#include "hal_line.h"

#include <stddef.h>

#include "base_tick.h"
#include "hal_time.h"
#include "stm32_line.h"
#include "stm32_pins.h"
#include "stm32_private.h"

enum {
    BAUD = 19200,
    RECEIVED_MAX = 128, /* powers of two; 66 ms of a full line */
    SENDING_MAX = 64,
    STALL_MS = 10, /* twenty characters */

    /* The transmitter stays on, as its start would send an idle character first (RM0090 30.3.2). */
    LISTENING = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE,
    DRIVING = USART_CR1_UE | USART_CR1_TE | USART_CR1_TXEIE,
    LETTING_GO = USART_CR1_UE | USART_CR1_TE | USART_CR1_TCIE,
};

struct received {
    uint32_t tick;
    uint8_t value;
    bool broken;
};

/* Rings whose counts wrap with 32 bits. Each count is written on one side only: of `received`, `in` by the interrupt
 * and `out` by main; of `sending` the other way round. */
static struct {
    struct received received[RECEIVED_MAX];
    uint8_t sending[SENDING_MAX];
    volatile uint32_t received_in;
    volatile uint32_t received_out;
    volatile uint32_t sending_in;
    volatile uint32_t sending_out;
    volatile bool driving;
    uint8_t stall_ms;
} line;

static void receive(uint32_t status)
{
    uint8_t value = (uint8_t)USART_DR(STM32_LINE_BASE); /* also ends the errors, RM0090 30.6.1 */
    bool broken = (status & (USART_SR_FE | USART_SR_NF | USART_SR_ORE)) != 0;
    if (line.received_in - line.received_out == (uint32_t)RECEIVED_MAX) {
        line.received[(line.received_in - 1U) % RECEIVED_MAX].broken = true; /* the byte after it is lost */
        return;
    }
    line.received[line.received_in % RECEIVED_MAX] =
        (struct received){.tick = TIM2_CNT, .value = value, .broken = broken};
    line.received_in++;
}

static void let_go(void)
{
    stm32_pin_write(STM32_PIN_LINE_DE, false);
    line.driving = false;
    USART_CR1(STM32_LINE_BASE) = LISTENING;
}

/* Gives the transmitter its next byte; after the last one it waits for the end of the stop bit. */
static void send_next(void)
{
    if (line.sending_out == line.sending_in) {
        USART_CR1(STM32_LINE_BASE) = LETTING_GO;
        return;
    }
    line.stall_ms = 0;
    USART_DR(STM32_LINE_BASE) = line.sending[line.sending_out % SENDING_MAX];
    line.sending_out++;
    USART_CR1(STM32_LINE_BASE) = DRIVING;
}

/* The receiver is off while the unit sends: it does not hear itself. */
static void serve(void)
{
    uint32_t status = USART_SR(STM32_LINE_BASE);
    if (!line.driving) {
        if ((status & (USART_SR_RXNE | USART_SR_ORE)) != 0) {
            receive(status);
        }
    } else if (line.sending_out != line.sending_in) {
        if ((status & USART_SR_TXE) != 0) {
            send_next();
        }
    } else if ((status & USART_SR_TC) != 0) {
        let_go();
    } else {
        send_next();
    }
}

void stm32_line_interrupt(void)
{
    serve();
    stm32_event = true;
}

bool hal_line_read(struct hal_line_byte *byte)
{
    if (line.received_out == line.received_in) {
        return false;
    }
    const struct received *received = &line.received[line.received_out % RECEIVED_MAX];
    *byte = (struct hal_line_byte){
        .tick = tick_extend(received->tick, hal_time_now()),
        .value = received->value,
        .broken = received->broken,
    };
    line.received_out++;
    return true;
}

/* Serves the transmitter too, so that a byte goes out where the transmitter raises no interrupts (an emulator). */
bool hal_line_write(uint8_t byte)
{
    if (line.sending_in - line.sending_out == (uint32_t)SENDING_MAX) {
        return false;
    }
    line.sending[line.sending_in % SENDING_MAX] = byte;
    uint32_t mask = stm32_mask();
    line.sending_in++;
    if (!line.driving) {
        line.driving = true;
        line.stall_ms = 0;
        stm32_pin_write(STM32_PIN_LINE_DE, true);
        USART_CR1(STM32_LINE_BASE) = DRIVING;
    }
    serve();
    stm32_unmask(mask);
    return true;
}

bool hal_line_is_idle(void)
{
    uint32_t mask = stm32_mask();
    if (line.driving) {
        serve();
    }
    stm32_unmask(mask);
    return !line.driving;
}

uint8_t hal_line_node(void)
{
    return stm32_io_node();
}

void stm32_line_tick(void)
{
    uint32_t mask = stm32_mask();
    if (line.driving && ++line.stall_ms > STALL_MS) {
        line.sending_out = line.sending_in;
        let_go();
    }
    stm32_unmask(mask);
}

void stm32_line_start(const struct stm32_clock *clock)
{
    STM32_LINE_CLOCK_ENABLE();
    USART_BRR(STM32_LINE_BASE) = (STM32_LINE_CLOCK_HZ(clock) + BAUD / 2) / BAUD; /* 16 samples a bit, RM0090 30.3.4 */
    USART_CR1(STM32_LINE_BASE) = LISTENING;
}
