/*
 * FCS-16 of RFC 1662, also known as CRC-16/X-25: polynomial 1021 reflected, start FFFF, the result inverted, low byte
 * first. "123456789" gives 906E. It finds every error of up to three bits in frames of up to 4095 bytes. Pure.
 */
#ifndef LINK_FCS_H
#define LINK_FCS_H

#include <stdint.h>

/* The register before the first byte, and after the last byte of a frame that is whole: its FCS included. */
#define LINK_FCS_START UINT16_C(0xFFFF)
#define LINK_FCS_GOOD UINT16_C(0xF0B8)

/* The register after one more byte. What is sent is the register inverted. */
uint16_t link_fcs_append(uint16_t fcs, uint8_t byte);

#endif
