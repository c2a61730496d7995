#include "dma_map.h"

#include "requests.h"

#define LINE(timer, source) (UINT32_C(1) << (((timer) - 2U) * REQUEST_SOURCES + (source)))
#define RECEIVER (UINT32_C(1) << REQUEST_USART1_RX)
#define UP REQUEST_UPDATE
#define CH1 REQUEST_CHANNEL_1
#define CH2 REQUEST_CHANNEL_2
#define CH3 REQUEST_CHANNEL_3
#define CH4 REQUEST_CHANNEL_4

/* RM0090, tables "DMA1 request mapping", the rows of TIM2 to TIM5, and "DMA2 request mapping", the receiver of USART1:
 * streams, then channels. */
static const uint32_t lines[DMA_CONTROLLERS][DMA_STREAMS][DMA_CHANNELS] = {
    {
        {[2] = LINE(4, CH1), [6] = LINE(5, CH3) | LINE(5, UP)},
        {[3] = LINE(2, UP) | LINE(2, CH3), [6] = LINE(5, CH4)},
        {[5] = LINE(3, CH4) | LINE(3, UP), [6] = LINE(5, CH1)},
        {[2] = LINE(4, CH2), [6] = LINE(5, CH4)},
        {[5] = LINE(3, CH1), [6] = LINE(5, CH2)},
        {[3] = LINE(2, CH1), [5] = LINE(3, CH2)},
        {[2] = LINE(4, UP), [3] = LINE(2, CH2) | LINE(2, CH4), [6] = LINE(5, UP)},
        {[2] = LINE(4, CH3), [3] = LINE(2, UP) | LINE(2, CH4), [5] = LINE(3, CH3)},
    },
    {[2] = {[4] = RECEIVER}, [5] = {[4] = RECEIVER}},
};

uint32_t dma_map_lines(unsigned controller, unsigned stream, unsigned channel)
{
    return lines[controller][stream][channel];
}
