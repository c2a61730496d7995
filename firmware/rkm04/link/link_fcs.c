#include "link_fcs.h"

/* Eight steps of the shift register at once: the taps 8408 (1021 reflected) feed the byte's bits back 0, 5 and 12
 * places on, and the first of these sums once more. */
uint16_t link_fcs_append(uint16_t fcs, uint8_t byte)
{
    unsigned sum = (fcs ^ byte) & 0xFFU;
    sum = (sum ^ sum << 4U) & 0xFFU;
    return (uint16_t)((unsigned)fcs >> 8U ^ sum << 8U ^ sum << 3U ^ sum >> 4U);
}
