/*
 * The CRC of Modbus as an independent reader makes it: bit by bit, by 8005 from the high bit down, with bytes and rest
 * turned round.
 */
#ifndef FUZZ_CRC_H
#define FUZZ_CRC_H

#include <stdint.h>

uint32_t fuzz_crc(const uint8_t *bytes, uint32_t length);

#endif
