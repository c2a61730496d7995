/*
 * The ports (RM0090 chapter 8): what level each pin has, from its mode, what drives it inside and what outside, and
 * what the program reads. Every change of a level is told, with its cycle, to whoever watches the pins.
 */
#ifndef GPIO_H
#define GPIO_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "exti.h"
#include "report.h"

enum {
    GPIO_PORTS = EXTI_PORTS, /* A to I */
    GPIO_PINS = EXTI_LINES,
    GPIO_FUNCTIONS = 16,
    GPIO_AF_TIM1_TO_2 = 1,
    GPIO_AF_TIM3_TO_5 = 2,
    GPIO_AF_USART1_TO_3 = 7,
};

struct pin {
    uint8_t port; /* GPIO_PORTS: no pin */
    uint8_t number;
};

/* Who is told of each edge at a pin; null: nobody. */
struct gpio_watcher {
    void (*note)(void *model, struct pin pin, bool level, uint64_t cycle);
    void *model;
};

struct gpio_wires {
    struct clock *clock;
    struct report *report;
    struct exti *exti;
    struct gpio_watcher watcher;
};

struct port {
    struct gpio_wires wires;
    unsigned number;
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

struct gpio {
    struct port port[GPIO_PORTS];
};

void gpio_init(struct gpio *gpio, struct gpio_wires wires);
void gpio_reset(struct gpio *gpio);
void gpio_reset_port(struct port *port);

/* Registers of a struct port. */
bool gpio_read(void *model, uint32_t offset, uint32_t *value);
bool gpio_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

/* A peripheral drives a pin, or lets it go, if that pin is switched to its function. */
void gpio_drive(struct gpio *gpio, struct pin pin, unsigned function, bool drives, bool level, uint64_t cycle);

/* Somebody outside drives a pin. */
void gpio_set_outside(struct gpio *gpio, struct pin pin, bool level, uint64_t cycle);

/* Nobody outside drives a pin any more. */
void gpio_let_go(struct gpio *gpio, struct pin pin, uint64_t cycle);

void gpio_set_stuck(struct gpio *gpio, struct pin pin, bool level);

bool gpio_level(const struct gpio *gpio, struct pin pin);

/* Whether a pin is switched to an alternate function. */
bool gpio_has_function(const struct gpio *gpio, struct pin pin, unsigned function);

#endif
