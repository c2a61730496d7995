/*
 * The ports (RM0090 chapter 8): what level each pin has, from its mode, what drives it inside and what outside, and
 * what the program reads. Every change of a level is told to the recorder with its cycle.
 */
#ifndef GPIO_H
#define GPIO_H

#include <stdbool.h>
#include <stdint.h>

struct board;

enum {
    GPIO_PORTS = 9, /* A to I */
    GPIO_PINS = 16,
    GPIO_FUNCTIONS = 16,
    GPIO_AF_TIM2 = 1,
    GPIO_AF_TIM3_TO_5 = 2,
    GPIO_AF_USART1_TO_3 = 7,
};

struct pin {
    uint8_t port; /* GPIO_PORTS: no pin */
    uint8_t number;
};

struct port {
    uint32_t moder;
    uint32_t otyper;
    uint32_t ospeedr;
    uint32_t pupdr;
    uint16_t odr;
    uint64_t afr;
    uint16_t level;   /* of the pins, as anybody can measure them */
    uint16_t driven;  /* pins that something outside drives */
    uint16_t outside; /* and to which level */
    uint16_t stuck;   /* pins that are stuck, whatever drives them */
    uint16_t stuck_level;
    uint16_t output; /* from MODER: general purpose outputs, alternate functions, analog */
    uint16_t alternate;
    uint16_t analog;
    uint16_t function[GPIO_FUNCTIONS];        /* pins that have this alternate function selected and are in its mode */
    uint16_t function_level[GPIO_FUNCTIONS];  /* what the peripherals drive there */
    uint16_t function_drives[GPIO_FUNCTIONS]; /* and which pins they drive at all */
};

void gpio_reset(struct board *board);
void gpio_reset_port(struct board *board, unsigned number);

bool gpio_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool gpio_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);

/* A peripheral drives a pin, or lets it go, if that pin is switched to its function. */
void gpio_drive(struct board *board, struct pin pin, unsigned function, bool drives, bool level, uint64_t cycle);

/* Somebody outside drives a pin. */
void gpio_set_outside(struct board *board, struct pin pin, bool level, uint64_t cycle);

void gpio_set_stuck(struct board *board, struct pin pin, bool level);

bool gpio_level(const struct board *board, struct pin pin);

/* Whether a pin is switched to an alternate function. */
bool gpio_has_function(const struct board *board, struct pin pin, unsigned function);

#endif
