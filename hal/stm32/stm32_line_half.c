#include "stm32_edge.h"
#include "stm32_line_private.h"

enum {
    STALL_MS = 10, /* eight characters at 9600 Bd */
    LAST = IMAGE_LINE_LAST,

    /* The transmitter stays on, as its start would send an idle character first (RM0090 30.3.2). */
    LISTENING = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE,
    DRIVING = USART_CR1_UE | USART_CR1_TE | USART_CR1_TXEIE,
    LETTING_GO = USART_CR1_UE | USART_CR1_TE | USART_CR1_TCIE,
};

static struct {
    volatile bool driving;
    uint8_t stall_ms;
    uint32_t format;   /* bits of CR1 */
    uint32_t clock_hz; /* of the USART */
} bus;

static void receive(uint32_t status)
{
    uint32_t value = USART_DR(STM32_LINE_BASE) & UINT8_MAX; /* also ends the errors, RM0090 30.6.1 */
    bool broken = (status & (USART_SR_PE | USART_SR_FE | USART_SR_NF | USART_SR_ORE)) != 0;
    stm32_line.received_in = stm32_line_keep(stm32_line.received_in, TIM2_CNT, (uint8_t)value, broken);
    EXTI_PR = STM32_EDGE_START; /* last: hal_line_is_quiet looks the other way round */
    if (value == (uint32_t)LAST) {
        stm32_event = true;
    }
}

static void let_go(void)
{
    stm32_pin_write(STM32_PIN_LINE_DE, false);
    bus.driving = false;
    USART_CR1(STM32_LINE_BASE) = bus.format | LISTENING;
}

/* Gives the transmitter its next byte; after the last one it waits for the end of the stop bit. */
static void send_next(void)
{
    if (stm32_line.sending_out == stm32_line.sending_in) {
        USART_CR1(STM32_LINE_BASE) = bus.format | LETTING_GO;
        return;
    }
    bus.stall_ms = 0;
    USART_DR(STM32_LINE_BASE) = stm32_line.sending[stm32_line.sending_out % SENDING_MAX];
    stm32_line.sending_out++;
    USART_CR1(STM32_LINE_BASE) = bus.format | DRIVING;
}

/* The receiver is off while the unit sends: it does not hear itself. */
static void serve(void)
{
    uint32_t status = USART_SR(STM32_LINE_BASE);
    if (!bus.driving) {
        if ((status & (USART_SR_RXNE | USART_SR_ORE)) != 0) {
            receive(status);
        }
    } else if (stm32_line.sending_out != stm32_line.sending_in) {
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
    bool drove = bus.driving;
    serve();
    if (drove && !bus.driving) {
        stm32_event = true;
    }
}

bool hal_line_read(struct hal_line_byte *byte)
{
    return stm32_line_take(byte);
}

bool hal_line_read_run(struct hal_line_run *run, uint8_t last)
{
    return stm32_line_take_run(run, last);
}

/* A start bit that comes before the interrupt of the last byte is not seen, but its byte is complete long before a
 * silence matters. */
bool hal_line_is_quiet(void)
{
    bool begun = STM32_EDGE_START == 0U || (EXTI_PR & STM32_EDGE_START) != 0;
    return !begun && stm32_line.received_out == stm32_line.received_in;
}

/* Serves the transmitter too, so that a byte goes out where the transmitter raises no interrupts (an emulator). */
bool hal_line_write(uint8_t byte)
{
    if (stm32_line.sending_in - stm32_line.sending_out == (uint32_t)SENDING_MAX) {
        return false;
    }
    stm32_line.sending[stm32_line.sending_in % SENDING_MAX] = byte;
    uint32_t mask = stm32_mask();
    stm32_line.sending_in++;
    if (!bus.driving) {
        bus.driving = true;
        bus.stall_ms = 0;
        stm32_pin_write(STM32_PIN_LINE_DE, true);
        USART_CR1(STM32_LINE_BASE) = bus.format | DRIVING;
    }
    serve();
    stm32_unmask(mask);
    return true;
}

bool hal_line_is_idle(void)
{
    uint32_t mask = stm32_mask();
    if (bus.driving) {
        serve();
    }
    stm32_unmask(mask);
    return !bus.driving;
}

void stm32_line_tick(void)
{
    uint32_t mask = stm32_mask();
    if (bus.driving && ++bus.stall_ms > STALL_MS) {
        stm32_line.sending_out = stm32_line.sending_in;
        let_go();
    }
    stm32_unmask(mask);
}

void stm32_line_look(void)
{
    (void)hal_line_is_idle();
}

uint32_t stm32_line_look_ticks(void)
{
    return UINT32_MAX;
}

void stm32_line_start(const struct stm32_clock *clock)
{
    STM32_LINE_CLOCK_ENABLE();
    bus.clock_hz = STM32_LINE_CLOCK_HZ(clock);
    USART_BRR(STM32_LINE_BASE) = STM32_LINE_DIVIDER(bus.clock_hz, IMAGE_LINE_BD);
    USART_CR1(STM32_LINE_BASE) = bus.format | LISTENING;
}

/* The parity is the ninth bit (RM0090 30.3.6, table 145). The USART is off meanwhile, and sends an idle character as it
 * comes back, with the driver of the bus off. */
void hal_line_set(uint32_t rate_bd, enum hal_line_format format)
{
    static const uint16_t formats[] = {
        [HAL_LINE_8E1] = USART_CR1_M | USART_CR1_PCE,
        [HAL_LINE_8O1] = USART_CR1_M | USART_CR1_PCE | USART_CR1_PS,
        [HAL_LINE_8N1] = 0,
        [HAL_LINE_8N2] = 0,
    };
    uint32_t mask = stm32_mask();
    USART_CR1(STM32_LINE_BASE) = 0;
    bus.format = formats[format];
    USART_BRR(STM32_LINE_BASE) = STM32_LINE_DIVIDER(bus.clock_hz, rate_bd);
    USART_CR2(STM32_LINE_BASE) = format == HAL_LINE_8N2 ? 2U * USART_CR2_STOP : 0;
    USART_CR1(STM32_LINE_BASE) = bus.format | LISTENING;
    stm32_unmask(mask);
}
