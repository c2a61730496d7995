/*
 * CRC-32 as in IEEE 802.3: polynomial 04C11DB7, bits reflected, start and result inverted. "123456789" gives CBF43926.
 *
 * It finds every error of up to three bits in the lengths that the unit keeps. Pure; may be called from anywhere.
 */
#ifndef BASE_CRC32_H
#define BASE_CRC32_H

#include <stdint.h>

/* The CRC of everything so far, `crc` (0 at the start), carried on over more bytes. */
uint32_t crc32_append(uint32_t crc, const uint8_t *bytes, uint32_t length);

#endif
