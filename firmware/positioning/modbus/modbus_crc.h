/*
 * The CRC-16 of Modbus RTU: polynomial A001 reflected, start FFFF, low byte first. "123456789" gives 4B37. It finds
 * every error of one, two or three bits in a frame. Pure.
 */
#ifndef MODBUS_CRC_H
#define MODBUS_CRC_H

#include <stdint.h>

/* The register before the first byte, and after the last one of a frame that is whole: its CRC included. */
#define MODBUS_CRC_START UINT16_C(0xFFFF)
#define MODBUS_CRC_GOOD UINT16_C(0)

/* The register after one more byte. */
uint16_t modbus_crc_append(uint16_t crc, uint8_t byte);

#endif
