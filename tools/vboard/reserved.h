/*
 * The bits of registers that a program must leave as they are after reset, all of them 0: those that the manuals call
 * reserved, and those that this part has not implemented. Registers that are not listed may be written whole.
 */
#ifndef RESERVED_H
#define RESERVED_H

#include <stdint.h>

/* Ones for the bits of the word at an address that are reserved. RCC and PWR are not covered. */
uint32_t reserved_bits(uint32_t address);

#endif
