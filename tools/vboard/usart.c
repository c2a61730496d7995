#include "usart.h"

#include <stddef.h>

enum {
    USART_SR = 0x00,
    USART_DR = 0x04,
    USART_BRR = 0x08,
    USART_CR1 = 0x0C,
    USART_CR2 = 0x10,
    USART_CR3 = 0x14,
    USART_GTPR = 0x18,
    SR_PE = 1 << 0,
    SR_FE = 1 << 1,
    SR_NF = 1 << 2,
    SR_ORE = 1 << 3,
    SR_IDLE = 1 << 4,
    SR_RXNE = 1 << 5,
    SR_TC = 1 << 6,
    SR_TXE = 1 << 7,
    SR_RESET = SR_TXE | SR_TC,
    SR_WRITE_CLEARS = 0x360, /* CTS, LBD, TC, RXNE */
    CR1_RE = 1 << 2,
    CR1_TE = 1 << 3,
    CR1_IDLEIE = 1 << 4,
    CR1_RXNEIE = 1 << 5,
    CR1_TCIE = 1 << 6,
    CR1_TXEIE = 1 << 7,
    CR1_PEIE = 1 << 8,
    CR1_PS = 1 << 9,
    CR1_PCE = 1 << 10,
    CR1_M = 1 << 12,
    CR1_UE = 1 << 13,
    CR1_OVER8 = 1 << 15,
    CR1_MODELLED = 0xB7FC, /* no mute mode or break */
    CR2_STOP = 3 << 12,
    CR2_STOP_2 = 2 << 12,
    CR3_EIE = 1 << 0,
    CR3_DMAR = 1 << 6,
    CR3_MODELLED = 0x801,  /* error interrupt, one sample a bit; DMAR of USART1 besides */
    PARITY_BIT = 8,        /* of DR with M */
    TOLERANCE_PERCENT = 3, /* table 141: 3.33 % for 8 bits with a fraction in BRR; 3.03 % for 9 */
};

static const enum nvic_irq irqs[USARTS] = {NVIC_IRQ_USART1, NVIC_IRQ_USART2, NVIC_IRQ_USART3};

enum {
    PINS = 3,
    NO_PORT = 0xFF
};

#define NO_PIN {.port = NO_PORT}
#define PIN(letter, bit) {.port = (letter) - 'A', .number = (bit)}

static const struct pin receive_pins[USARTS][PINS] = {
    {PIN('A', 10), PIN('B', 7), NO_PIN}, {PIN('A', 3), PIN('D', 6), NO_PIN}, {PIN('B', 11), PIN('C', 11), PIN('D', 9)}};
static const struct pin transmit_pins[USARTS][PINS] = {
    {PIN('A', 9), PIN('B', 6), NO_PIN}, {PIN('A', 2), PIN('D', 5), NO_PIN}, {PIN('B', 10), PIN('C', 10), PIN('D', 8)}};

static bool is_connected(const struct usart *usart, const struct pin pins[PINS])
{
    for (unsigned i = 0; i < PINS; i++) {
        if (pins[i].port != NO_PORT && gpio_has_function(usart->wires.gpio, pins[i], GPIO_AF_USART1_TO_3)) {
            return true;
        }
    }
    return false;
}

void usart_set_level(struct usart *usart, bool level, uint64_t cycle)
{
    for (unsigned i = 0; i < PINS; i++) {
        struct pin pin = receive_pins[usart->wires.number][i];
        if (pin.port != NO_PORT && gpio_has_function(usart->wires.gpio, pin, GPIO_AF_USART1_TO_3)) {
            gpio_set_outside(usart->wires.gpio, pin, level, cycle);
        }
    }
}

static uint64_t pclk_divider(const struct usart *usart)
{
    return usart->wires.number == 0 ? usart->wires.conditions->pclk2_divider : usart->wires.conditions->pclk1_divider;
}

/* Clocks of the bus in one bit: USARTDIV times the oversampling (section 30.3.4). */
static uint32_t bit_clocks(const struct usart *usart)
{
    return (usart->cr1 & CR1_OVER8) != 0 ? (usart->brr >> 4) * 8U + (usart->brr & 7U) : usart->brr;
}

static uint64_t bit_cycles(const struct usart *usart)
{
    return bit_clocks(usart) * pclk_divider(usart);
}

uint64_t usart_baud(const struct usart *usart)
{
    uint64_t cycles = bit_cycles(usart);
    return cycles == 0 ? 0 : (usart->wires.clock->time.hclk_hz + cycles / 2U) / cycles;
}

enum usart_format usart_format(const struct usart *usart)
{
    if ((usart->cr1 & CR1_PCE) != 0) {
        return (usart->cr1 & CR1_PS) != 0 ? USART_8O1 : USART_8E1;
    }
    return (usart->cr2 & CR2_STOP) == CR2_STOP_2 ? USART_8N2 : USART_8N1;
}

static uint64_t frame_bits(const struct usart *usart)
{
    return usart_bits(usart_format(usart));
}

/* Section 30.3.13: RXNE asks for a transfer. */
static void update_request(struct usart *usart)
{
    struct requests *requests = usart->wires.requests;
    if (requests == NULL) {
        return;
    }
    bool asks = (usart->cr3 & CR3_DMAR) != 0 && (usart->sr & SR_RXNE) != 0;
    if (asks && !usart->asks) {
        requests_raise_receiver(requests, usart->wires.clock->moment);
    } else if (!asks) {
        requests_lower(requests, UINT32_C(1) << REQUEST_USART1_RX);
    }
    usart->asks = asks;
}

/* Section 30.4: what calls the interrupt. With EIE, errors do so only while DMAR is set. */
static const struct cause {
    uint32_t enable; /* bits of CR1, */
    uint32_t errors; /* or all of these bits of CR3 */
    uint32_t flags;  /* any of SR */
} causes[] = {
    {CR1_RXNEIE, 0, SR_RXNE | SR_ORE}, {CR1_TXEIE, 0, SR_TXE}, {CR1_TCIE, 0, SR_TC},
    {CR1_IDLEIE, 0, SR_IDLE},          {CR1_PEIE, 0, SR_PE},   {0, CR3_EIE | CR3_DMAR, SR_FE | SR_NF | SR_ORE},
};

static void update_interrupt(struct usart *usart)
{
    bool wanted = false;
    update_request(usart);
    for (unsigned i = 0; i < sizeof causes / sizeof causes[0]; i++) {
        const struct cause *cause = &causes[i];
        bool enabled =
            cause->errors != 0 ? (usart->cr3 & cause->errors) == cause->errors : (usart->cr1 & cause->enable) != 0;
        wanted = wanted || (enabled && (usart->sr & cause->flags) != 0);
    }
    nvic_set_line(usart->wires.nvic, irqs[usart->wires.number], wanted);
}

static void set_event(struct usart *usart)
{
    uint64_t due = usart->shift_due < usart->idle_due ? usart->shift_due : usart->idle_due;
    clock_set(usart->wires.clock, (enum event)(EVENT_USART1 + usart->wires.number), due);
}

static bool can_send(const struct usart *usart)
{
    return (usart->cr1 & (CR1_UE | CR1_TE)) == (CR1_UE | CR1_TE);
}

static void shift_out(struct usart *usart, bool idle_frame, uint64_t cycle)
{
    uint64_t cycles = bit_cycles(usart);
    if (cycles == 0) {
        report_fail(usart->wires.report, "USART%u is told to send and BRR is 0", usart->wires.number + 1U);
        return;
    }
    usart->shifting = true;
    usart->idle_frame = idle_frame;
    usart->shift_begin = cycle;
    usart->shift_due = cycle + frame_bits(usart) * cycles;
    if (!idle_frame) {
        usart->shifted = usart->to_send;
        usart->sr |= SR_TXE;
        if (usart->listener.begin != NULL) {
            usart->listener.begin(usart->listener.model);
        }
    }
    set_event(usart);
}

static void end_shift(struct usart *usart, uint64_t cycle)
{
    usart->shifting = false;
    usart->shift_due = VTIME_NEVER;
    if (!usart->idle_frame) {
        bool connected = is_connected(usart, transmit_pins[usart->wires.number]);
        usart->sent++;
        if (usart->listener.end != NULL) {
            usart->listener.end(usart->listener.model, (struct usart_sent){.value = usart->shifted,
                                                                           .connected = connected,
                                                                           .begin = usart->shift_begin,
                                                                           .end = cycle});
        }
    }
    if ((usart->sr & SR_TXE) == 0 && can_send(usart)) {
        shift_out(usart, false, cycle);
    } else if (!usart->idle_frame) {
        usart->sr |= SR_TC;
    }
}

static void on_event(void *model, uint64_t cycle)
{
    struct usart *usart = model;
    if (usart->shift_due <= cycle) {
        end_shift(usart, cycle);
    }
    if (usart->idle_due <= cycle) {
        usart->idle_due = VTIME_NEVER;
        usart->sr |= SR_IDLE;
    }
    set_event(usart);
    update_interrupt(usart);
}

static bool rates_fit(uint64_t baud, uint64_t line_baud)
{
    uint64_t difference = baud > line_baud ? baud - line_baud : line_baud - baud;
    return difference * 100U <= line_baud * TOLERANCE_PERCENT;
}

static bool is_odd(uint8_t value)
{
    bool odd = false;
    for (unsigned bits = value; bits != 0; bits &= bits - 1U) {
        odd = !odd;
    }
    return odd;
}

/* The level of the first bit after the eight in a format: parity, or a stop bit. */
bool usart_ninth_bit(enum usart_format format, uint8_t value)
{
    if (format == USART_8E1 || format == USART_8O1) {
        return is_odd(value) == (format == USART_8E1);
    }
    return true;
}

/* What a byte in another format is taken for: its ninth bit for the parity or the stop bit that is awaited. Where the
 * parity is awaited and there is none, the next start bit may come where the stop bit should be. */
static unsigned misread(enum usart_format own, enum usart_format format, uint8_t value)
{
    bool ninth = usart_ninth_bit(format, value);
    if (own == USART_8E1 || own == USART_8O1) {
        unsigned damage = ninth != usart_ninth_bit(own, value) ? USART_PARITY : 0U;
        return format == USART_8N1 ? damage | USART_FRAMING : damage;
    }
    return ninth ? 0U : USART_FRAMING;
}

/* Section 30.3.3: an overrun keeps what is in RDR and loses the new byte, and all that come until ORE has been ended.
 */
void usart_receive(struct usart *usart, uint8_t value, unsigned damage, uint64_t baud, enum usart_format format,
                   uint64_t cycle)
{
    if ((usart->cr1 & (CR1_UE | CR1_RE)) != (CR1_UE | CR1_RE) ||
        !is_connected(usart, receive_pins[usart->wires.number])) {
        usart->deaf++;
        return;
    }
    if (!rates_fit(usart_baud(usart), baud)) {
        damage |= USART_FRAMING;
        value = (uint8_t)~value;
    }
    damage |= misread(usart_format(usart), format, value);
    if ((usart->cr1 & CR1_PCE) == 0) {
        damage &= ~(unsigned)USART_PARITY;
    }
    usart->idle_due = cycle + (frame_bits(usart) + 1U) * bit_cycles(usart);
    if ((usart->sr & (SR_RXNE | SR_ORE)) != 0) {
        usart->sr |= SR_ORE;
        usart->overruns++;
    } else {
        usart->sr |= SR_RXNE | damage;
        usart->received = value;
        usart->taken++;
    }
    set_event(usart);
    update_interrupt(usart);
}

void usart_reset(struct usart *usart)
{
    *usart = (struct usart){.wires = usart->wires,
                            .listener = usart->listener,
                            .sr = SR_RESET,
                            .shift_due = VTIME_NEVER,
                            .idle_due = VTIME_NEVER,
                            .sent = usart->sent,
                            .taken = usart->taken,
                            .overruns = usart->overruns,
                            .deaf = usart->deaf};
    set_event(usart);
    update_interrupt(usart);
}

/* A read of SR, then one of DR, clears the errors and IDLE; the latter clears RXNE on its own. */
static uint32_t read_data(struct usart *usart)
{
    usart->sr &= ~(usart->status_read & (SR_PE | SR_FE | SR_NF | SR_ORE | SR_IDLE));
    usart->sr &= ~(uint32_t)SR_RXNE;
    usart->status_read &= SR_TC;
    bool parity = (usart->cr1 & CR1_M) != 0 && usart_ninth_bit(usart_format(usart), usart->received);
    return usart->received | (uint32_t)parity << PARITY_BIT;
}

bool usart_read(void *model, uint32_t offset, uint32_t *value)
{
    struct usart *usart = model;
    switch (offset) {
    case USART_SR:
        *value = usart->sr;
        usart->status_read = usart->sr;
        return true;
    case USART_DR:
        *value = read_data(usart);
        update_interrupt(usart);
        return true;
    case USART_BRR:
        *value = usart->brr;
        return true;
    case USART_CR1:
        *value = usart->cr1;
        return true;
    case USART_CR2:
        *value = usart->cr2;
        return true;
    case USART_CR3:
        *value = usart->cr3;
        return true;
    case USART_GTPR:
        *value = 0;
        return true;
    default:
        return false;
    }
}

static void write_data(struct usart *usart, uint32_t value)
{
    if (!can_send(usart)) {
        report_warn(usart->wires.report, "USART%u: a byte is given to a transmitter that is off, and lost",
                    usart->wires.number + 1U);
        return;
    }
    if ((usart->sr & SR_TXE) == 0) {
        report_warn(usart->wires.report, "USART%u: a byte is given before the one in DR has left, which is lost",
                    usart->wires.number + 1U);
    }
    usart->to_send = (uint8_t)value;
    usart->sr &= ~(uint32_t)SR_TXE;
    if ((usart->status_read & SR_TC) != 0) {
        usart->sr &= ~(uint32_t)SR_TC;
    }
    if (!usart->shifting) {
        shift_out(usart, false, usart->wires.clock->now);
    }
}

/* A rate of less than one sample, or a fraction that eight samples a bit do not have. */
static void write_brr(struct usart *usart, uint32_t value)
{
    bool by_8 = (usart->cr1 & CR1_OVER8) != 0;
    if (usart->shifting && value != usart->brr) {
        report_fail(usart->wires.report, "USART%u: BRR is changed while a character is sent (RM0090 30.3.4)",
                    usart->wires.number + 1U);
    } else if (value >> 4 == 0 || (by_8 && (value & 8U) != 0)) {
        report_fail(usart->wires.report, "USART%u: BRR %04x is no rate (RM0090 30.3.4, 30.6.3)",
                    usart->wires.number + 1U, value);
    }
    usart->brr = value;
}

static void check_cr1(const struct usart *usart, uint32_t value)
{
    if ((value & 0xFFFFU & ~(uint32_t)CR1_MODELLED) != 0) {
        report_fail(usart->wires.report, "USART%u: CR1 %04x asks for what is not modelled", usart->wires.number + 1U,
                    value);
    }
    if (((value & CR1_PCE) != 0) != ((value & CR1_M) != 0)) {
        report_fail(usart->wires.report, "USART%u: CR1 %04x: 7 or 9 bits of data are not modelled",
                    usart->wires.number + 1U, value);
    }
    if (usart->shifting && !usart->idle_frame && (value & (CR1_UE | CR1_TE)) != (CR1_UE | CR1_TE)) {
        report_fail(usart->wires.report, "USART%u: the transmitter is switched off in a character (RM0090 30.3.2)",
                    usart->wires.number + 1U);
    }
}

static void write_cr1(struct usart *usart, uint32_t value)
{
    check_cr1(usart, value);
    bool could = can_send(usart);
    usart->cr1 = value;
    if (!can_send(usart) || could) {
        return;
    }
    if (usart->listener.low != NULL && is_connected(usart, transmit_pins[usart->wires.number])) {
        usart->listener.low(usart->listener.model);
    }
    if (!usart->shifting) {
        shift_out(usart, true, usart->wires.clock->now); /* section 30.3.2: an idle frame comes first */
    }
}

static bool write_register(void *model, uint32_t offset, uint32_t value)
{
    struct usart *usart = model;
    switch (offset) {
    case USART_SR:
        usart->sr &= value | ~(uint32_t)SR_WRITE_CLEARS;
        return true;
    case USART_DR:
        write_data(usart, value);
        return true;
    case USART_BRR:
        write_brr(usart, value);
        return true;
    case USART_CR1:
        write_cr1(usart, value);
        return true;
    case USART_CR2: /* the length of the stop bit is all that is asked of it */
        usart->cr2 = value;
        return (value & 0x5F60U) == 0;
    case USART_CR3:
        usart->cr3 = value;
        return (value & ~(uint32_t)(CR3_MODELLED | (usart->wires.requests != NULL ? CR3_DMAR : 0))) == 0;
    case USART_GTPR:
        return value == 0;
    default:
        return false;
    }
}

bool usart_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct usart *usart = model;
    uint32_t kept = offset == USART_SR ? UINT32_MAX : 0;
    bool known = write_register(usart, offset, (value & mask) | (kept & ~mask));
    update_interrupt(usart);
    return known;
}

void usart_init(struct usart *usart, struct usart_wires wires)
{
    usart->wires = wires;
    clock_attach(wires.clock, (enum event)(EVENT_USART1 + wires.number), on_event, usart);
}
