#include "base_crc32.h"

enum {
    NIBBLE_BITS = 4,
    NIBBLES = 16
};

/* The CRC of each value of four bits: EDB88320, the reflected polynomial, wherever a 1 is shifted out. */
static const uint32_t nibble_crc[NIBBLES] = {
    0x00000000U, 0x1DB71064U, 0x3B6E20C8U, 0x26D930ACU, 0x76DC4190U, 0x6B6B51F4U, 0x4DB26158U, 0x5005713CU,
    0xEDB88320U, 0xF00F9344U, 0xD6D6A3E8U, 0xCB61B38CU, 0x9B64C2B0U, 0x86D3D2D4U, 0xA00AE278U, 0xBDBDF21CU,
};

uint32_t crc32_append(uint32_t crc, const uint8_t *bytes, uint32_t length)
{
    crc = ~crc;
    for (uint32_t i = 0; i < length; i++) {
        crc ^= bytes[i];
        crc = (crc >> NIBBLE_BITS) ^ nibble_crc[crc % NIBBLES];
        crc = (crc >> NIBBLE_BITS) ^ nibble_crc[crc % NIBBLES];
    }
    return ~crc;
}
