#include "gpio.h"

#include <stddef.h>

enum {
    GPIO_MODER = 0x00,
    GPIO_OTYPER = 0x04,
    GPIO_OSPEEDR = 0x08,
    GPIO_PUPDR = 0x0C,
    GPIO_IDR = 0x10,
    GPIO_ODR = 0x14,
    GPIO_BSRR = 0x18,
    GPIO_AFRL = 0x20,
    GPIO_AFRH = 0x24,
    MODE_OUTPUT = 1,
    MODE_ALTERNATE = 2,
    MODE_ANALOG = 3,
    PULL_UP = 1,
};

static uint16_t bit(unsigned pin)
{
    return (uint16_t)(1U << pin);
}

/* The level of all pins of a port: outputs and functions drive theirs, unless open-drain and high; then comes what is
 * outside, then the pull resistor. A pin that floats reads 0. */
static uint16_t find_levels(const struct port *port)
{
    uint16_t inside = port->output;
    uint16_t level = port->odr & port->output;
    for (unsigned i = 0; i < GPIO_FUNCTIONS; i++) {
        uint16_t drives = port->function[i] & port->function_drives[i];
        inside |= drives;
        level |= drives & port->function_level[i];
    }
    inside &= (uint16_t)~(port->otyper & level);
    uint16_t pulled = 0;
    for (unsigned i = 0; i < GPIO_PINS; i++) {
        pulled |= (port->pupdr >> 2U * i & 3U) == PULL_UP ? bit(i) : 0;
    }
    uint16_t outside = port->driven & (uint16_t)~inside;
    uint16_t rest = (uint16_t)~(inside | port->driven);
    uint16_t levels = (uint16_t)((level & inside) | (port->outside & outside) | (pulled & rest));
    return (uint16_t)((levels & ~port->stuck) | (port->stuck_level & port->stuck));
}

static void tell_edge(const struct port *port, unsigned pin, uint64_t cycle)
{
    const struct gpio_watcher *watcher = &port->wires.watcher;
    if (watcher->note != NULL) {
        struct pin which = {.port = (uint8_t)port->number, .number = (uint8_t)pin};
        watcher->note(watcher->model, which, (port->level >> pin & 1) != 0, cycle);
    }
}

static void update(struct port *port, uint64_t cycle)
{
    uint16_t before = port->level;
    port->level = find_levels(port);
    uint16_t changed = before ^ port->level;
    exti_follow(port->wires.exti, port->number, port->level & (uint16_t)~port->analog);
    for (unsigned i = 0; changed >> i != 0; i++) {
        if ((changed >> i & 1) != 0) {
            tell_edge(port, i, cycle);
        }
    }
}

/* What follows from MODER and AFR. */
static void update_modes(struct port *port)
{
    port->output = 0;
    port->alternate = 0;
    port->analog = 0;
    for (unsigned i = 0; i < GPIO_FUNCTIONS; i++) {
        port->function[i] = 0;
    }
    for (unsigned i = 0; i < GPIO_PINS; i++) {
        unsigned mode = port->moder >> 2U * i & 3U;
        port->output |= mode == MODE_OUTPUT ? bit(i) : 0;
        port->alternate |= mode == MODE_ALTERNATE ? bit(i) : 0;
        port->analog |= mode == MODE_ANALOG ? bit(i) : 0;
        if (mode == MODE_ALTERNATE) {
            port->function[port->afr >> 4U * i & 15U] |= bit(i);
        }
    }
}

/* Section 8.4: ports A and B have the pins of the debug port in use. */
void gpio_reset_port(struct port *port)
{
    static const uint32_t modes[GPIO_PORTS] = {0xA8000000, 0x00000280};
    static const uint32_t pulls[GPIO_PORTS] = {0x64000000, 0x00000100};
    static const uint32_t speeds[GPIO_PORTS] = {0x0C000000, 0x000000C0};
    port->moder = modes[port->number];
    port->pupdr = pulls[port->number];
    port->ospeedr = speeds[port->number];
    port->otyper = 0;
    port->odr = 0;
    port->afr = 0;
    update_modes(port);
    update(port, port->wires.clock->now);
}

void gpio_init(struct gpio *gpio, struct gpio_wires wires)
{
    for (unsigned i = 0; i < GPIO_PORTS; i++) {
        gpio->port[i].wires = wires;
        gpio->port[i].number = i;
    }
}

void gpio_reset(struct gpio *gpio)
{
    for (unsigned i = 0; i < GPIO_PORTS; i++) {
        gpio_reset_port(&gpio->port[i]);
    }
}

bool gpio_read(void *model, uint32_t offset, uint32_t *value)
{
    struct port *port = model;
    switch (offset) {
    case GPIO_MODER:
        *value = port->moder;
        return true;
    case GPIO_OTYPER:
        *value = port->otyper;
        return true;
    case GPIO_OSPEEDR:
        *value = port->ospeedr;
        return true;
    case GPIO_PUPDR:
        *value = port->pupdr;
        return true;
    case GPIO_IDR:
        *value = port->level & (uint16_t)~port->analog;
        return true;
    case GPIO_ODR:
        *value = port->odr;
        return true;
    case GPIO_BSRR:
        *value = 0;
        return true;
    case GPIO_AFRL:
        *value = (uint32_t)port->afr;
        return true;
    case GPIO_AFRH:
        *value = (uint32_t)(port->afr >> 32);
        return true;
    default:
        return false;
    }
}

static void replace(uint32_t *word, uint32_t value, uint32_t mask)
{
    *word = (*word & ~mask) | (value & mask);
}

static void replace_functions(struct port *port, unsigned shift, uint32_t value, uint32_t mask)
{
    uint64_t wide_mask = (uint64_t)mask << shift;
    port->afr = (port->afr & ~wide_mask) | ((uint64_t)value << shift & wide_mask);
}

/* BSRR: set wins over reset. */
static void set_and_reset(struct port *port, uint32_t bits)
{
    uint32_t odr = (port->odr & ~(bits >> 16)) | (bits & 0xFFFFU);
    port->odr = (uint16_t)odr;
}

bool gpio_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct port *port = model;
    uint32_t odr = port->odr;
    switch (offset) {
    case GPIO_MODER:
        replace(&port->moder, value, mask);
        break;
    case GPIO_OTYPER:
        replace(&port->otyper, value & 0xFFFFU, mask);
        break;
    case GPIO_OSPEEDR:
        replace(&port->ospeedr, value, mask);
        return true;
    case GPIO_PUPDR:
        replace(&port->pupdr, value, mask);
        if ((port->pupdr & port->pupdr >> 1 & 0x55555555U) != 0) {
            report_fail(port->wires.report, "GPIO%c_PUPDR: 3 is no pull (RM0090 8.4.4)", 'A' + (int)port->number);
        }
        break;
    case GPIO_ODR:
        replace(&odr, value, mask);
        port->odr = (uint16_t)odr;
        break;
    case GPIO_BSRR:
        set_and_reset(port, value & mask);
        break;
    case GPIO_AFRL:
        replace_functions(port, 0, value, mask);
        break;
    case GPIO_AFRH:
        replace_functions(port, 32, value, mask);
        break;
    default:
        return false;
    }
    if (offset == GPIO_MODER || offset == GPIO_AFRL || offset == GPIO_AFRH) {
        update_modes(port);
    }
    update(port, port->wires.clock->now);
    return true;
}

static void replace_bit(uint16_t *bits, unsigned pin, bool value)
{
    *bits = (uint16_t)(value ? *bits | bit(pin) : *bits & ~bit(pin));
}

void gpio_drive(struct gpio *gpio, struct pin pin, unsigned function, bool drives, bool level, uint64_t cycle)
{
    struct port *port = &gpio->port[pin.port];
    replace_bit(&port->function_drives[function], pin.number, drives);
    replace_bit(&port->function_level[function], pin.number, level);
    update(port, cycle);
}

void gpio_set_outside(struct gpio *gpio, struct pin pin, bool level, uint64_t cycle)
{
    struct port *port = &gpio->port[pin.port];
    replace_bit(&port->driven, pin.number, true);
    replace_bit(&port->outside, pin.number, level);
    update(port, cycle);
}

void gpio_let_go(struct gpio *gpio, struct pin pin, uint64_t cycle)
{
    struct port *port = &gpio->port[pin.port];
    replace_bit(&port->driven, pin.number, false);
    update(port, cycle);
}

void gpio_set_stuck(struct gpio *gpio, struct pin pin, bool level)
{
    struct port *port = &gpio->port[pin.port];
    replace_bit(&port->stuck, pin.number, true);
    replace_bit(&port->stuck_level, pin.number, level);
    update(port, port->wires.clock->now);
}

bool gpio_level(const struct gpio *gpio, struct pin pin)
{
    return (gpio->port[pin.port].level >> pin.number & 1) != 0;
}

bool gpio_has_function(const struct gpio *gpio, struct pin pin, unsigned function)
{
    return (gpio->port[pin.port].function[function] >> pin.number & 1) != 0;
}
