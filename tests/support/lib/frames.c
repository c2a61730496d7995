#include "frames.h"

enum {
    FLAG = 0x7E,
    ESCAPE = 0x7D,
    ESCAPED = 0x20,
    FCS_BYTES = 2,
    CONTENT_BYTES_MIN = 3
};

/* RFC 1662, bit by bit. */
static uint16_t fcs_after(uint16_t fcs, uint8_t byte)
{
    fcs ^= byte;
    for (int i = 0; i < 8; i++) {
        fcs = (uint16_t)((fcs & 1U) != 0 ? fcs >> 1U ^ 0x8408U : fcs >> 1U);
    }
    return fcs;
}

static uint32_t put(uint8_t *frame, uint32_t length, uint8_t byte)
{
    if (byte == FLAG || byte == ESCAPE) {
        frame[length++] = ESCAPE;
        byte ^= ESCAPED;
    }
    frame[length++] = byte;
    return length;
}

uint32_t frame_write(uint8_t *frame, uint8_t address, uint8_t number, const void *message, uint32_t length)
{
    const uint8_t *bytes = message;
    uint16_t fcs = fcs_after(fcs_after(0xFFFF, address), number);
    uint32_t end = 0;
    frame[end++] = FLAG;
    end = put(frame, end, address);
    end = put(frame, end, number);
    for (uint32_t i = 0; i < length; i++) {
        fcs = fcs_after(fcs, bytes[i]);
        end = put(frame, end, bytes[i]);
    }
    fcs ^= 0xFFFF;
    end = put(frame, end, (uint8_t)(fcs & 0xFFU));
    end = put(frame, end, (uint8_t)(fcs >> 8U));
    frame[end++] = FLAG;
    return end;
}

uint32_t frame_read(uint8_t *content, const uint8_t *frame, uint32_t length)
{
    uint32_t end = 0;
    uint16_t fcs = 0xFFFF;
    if (length < 2 || frame[0] != FLAG || frame[length - 1] != FLAG) {
        return 0;
    }
    for (uint32_t i = 1; i < length - 1; i++) {
        if (frame[i] == FLAG) {
            return 0;
        }
        uint8_t byte = frame[i] == ESCAPE ? frame[++i] ^ ESCAPED : frame[i];
        fcs = fcs_after(fcs, byte);
        content[end++] = byte;
    }
    return fcs == 0xF0B8 && end >= CONTENT_BYTES_MIN + FCS_BYTES ? end - FCS_BYTES : 0;
}
