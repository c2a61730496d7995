/*
 * The CRC of Modbus as an independent reader makes it: bit by bit, by 8005 from the high bit down, with bytes and rest
 * turned round.
 */
#ifndef RIG_CRC_H
#define RIG_CRC_H

#include <stdint.h>

static inline uint16_t rig_crc(const uint8_t *bytes, uint32_t length)
{
    uint32_t rest = 0xFFFF;
    uint32_t turned = 0;
    for (uint32_t bit = 0; bit < length * 8U; bit++) {
        uint32_t in = ((uint32_t)bytes[bit / 8U] >> (bit % 8U)) & 1U;
        uint32_t out = (rest >> 15U) ^ in;
        rest = ((rest << 1U) & 0xFFFFU) ^ (out * 0x8005U);
    }
    for (uint32_t bit = 0; bit < 16U; bit++) {
        turned |= ((rest >> bit) & 1U) << (15U - bit);
    }
    return (uint16_t)turned;
}

#endif
