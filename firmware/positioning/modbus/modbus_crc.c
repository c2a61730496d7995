#include "modbus_crc.h"

#define POLYNOMIAL 0xA001U

enum {
    BYTE_BITS = 8,
};

uint16_t modbus_crc_append(uint16_t crc, uint8_t byte)
{
    uint32_t shifted = (uint32_t)crc ^ byte;
    for (unsigned bit = 0; bit < (unsigned)BYTE_BITS; bit++) {
        uint32_t low = shifted & 1U;
        shifted = (shifted >> 1U) ^ (low * POLYNOMIAL);
    }
    return (uint16_t)shifted;
}
