/*
 * USART1 to USART3 as asynchronous receivers and transmitters of 8 bits without parity (RM0090 chapter 30). Times of
 * bytes follow from BRR and the clock of the bus.
 */
#ifndef USART_H
#define USART_H

#include <stdbool.h>
#include <stdint.h>

#include "gpio.h"

struct board;

enum {
    USARTS = 3
};

enum usart_damage {
    USART_FRAMING = 1 << 1, /* bits of SR */
    USART_NOISE = 1 << 2,
};

struct usart {
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
    uint64_t sent;
    uint64_t taken;
    uint64_t overruns;
    uint64_t deaf; /* bytes that came while the receiver was off or its pin not connected */
};

void usarts_reset(struct board *board);
void usart_reset(struct board *board, unsigned instance);
bool usart_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool usart_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);
void usart1_event(struct board *board, uint64_t cycle);
void usart2_event(struct board *board, uint64_t cycle);
void usart3_event(struct board *board, uint64_t cycle);

/* The middle of the stop bit of a byte that came with this rate. `damage` is a set of enum usart_damage. */
void usart_receive(struct board *board, unsigned instance, uint8_t value, unsigned damage, uint64_t baud,
                   uint64_t cycle);

/* The rate in Bd that BRR gives, 0 if it is not set. */
uint64_t usart_baud(const struct board *board, unsigned instance);

#endif
