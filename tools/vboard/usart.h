/*
 * USART1 to USART3 as asynchronous receivers and transmitters of 8 bits, with or without parity, with one or two stop
 * bits (RM0090 chapter 30). Times of bytes follow from BRR and the clock of the bus. USART1 asks DMA2 for what it has
 * received to be fetched (DMAR).
 */
#ifndef USART_H
#define USART_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "conditions.h"
#include "gpio.h"
#include "nvic.h"
#include "report.h"
#include "requests.h"

enum {
    USARTS = 3
};

enum usart_damage {
    USART_PARITY = 1 << 0,
    USART_FRAMING = 1 << 1, /* bits of SR */
    USART_NOISE = 1 << 2,
};

/* Parity and stop bits. */
enum usart_format {
    USART_8E1,
    USART_8O1,
    USART_8N1,
    USART_8N2,
};

/* Bits of a byte with its start and stop bits. */
static inline unsigned usart_bits(enum usart_format format)
{
    return format == USART_8N1 ? 10U : 11U;
}

/* A byte that was sent. */
struct usart_sent {
    uint8_t value;
    bool connected; /* whether the pin was the USART's */
    uint64_t begin; /* cycle */
    uint64_t end;
};

/* What is connected to the pin of the transmitter; null: nothing. */
struct usart_listener {
    void *model;
    void (*begin)(void *model);
    void (*low)(void *model); /* the transmitter comes on, and its pin was low until then */
    void (*end)(void *model, struct usart_sent sent);
};

struct usart_wires {
    unsigned number; /* 0: USART1 */
    struct clock *clock;
    struct report *report;
    struct nvic *nvic;
    const struct conditions *conditions;
    struct gpio *gpio;
    struct requests *requests; /* null: none that is modelled */
};

struct usart {
    struct usart_wires wires;
    struct usart_listener listener;
    uint32_t sr;
    uint32_t cr1;
    uint32_t cr2;
    uint32_t cr3;
    uint32_t brr;
    uint8_t received; /* RDR */
    uint8_t to_send;  /* TDR */
    bool shifting;    /* a byte, or the idle frame after TE, is on its way */
    bool idle_frame;
    uint8_t shifted;
    uint64_t shift_begin; /* cycle */
    uint64_t shift_due;
    uint64_t idle_due;    /* the line has been quiet for a byte then */
    uint32_t status_read; /* flags that were seen by a read of SR: a read of DR clears them */
    bool asks;            /* the line to DMA2 was raised for the byte in RDR */
    uint64_t sent;
    uint64_t taken;
    uint64_t overruns;
    uint64_t deaf; /* bytes that came while the receiver was off or its pin not connected */
};

void usart_init(struct usart *usart, struct usart_wires wires);
void usart_reset(struct usart *usart);
bool usart_read(void *model, uint32_t offset, uint32_t *value);
bool usart_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

/* The level at the pins that the receiver is connected to; for who looks at the pins, as the receiver itself is told
 * whole bytes. */
void usart_set_level(struct usart *usart, bool level, uint64_t cycle);

/* The ninth bit of a byte after the start bit: the parity, or a stop bit. */
bool usart_ninth_bit(enum usart_format format, uint8_t value);

/* The middle of the first stop bit of a byte that came with this rate and format. `damage` is a set of enum
 * usart_damage. */
void usart_receive(struct usart *usart, uint8_t value, unsigned damage, uint64_t baud, enum usart_format format,
                   uint64_t cycle);

/* The rate in Bd that BRR gives, 0 if it is not set. */
uint64_t usart_baud(const struct usart *usart);

/* The format that CR1 and CR2 give. */
enum usart_format usart_format(const struct usart *usart);

#endif
