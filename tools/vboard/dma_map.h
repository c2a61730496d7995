/*
 * Which requests a stream of a controller serves (RM0090 section 10.3.3).
 */
#ifndef DMA_MAP_H
#define DMA_MAP_H

#include <stdint.h>

enum {
    DMA_CONTROLLERS = 2,
    DMA_STREAMS = 8,
    DMA_CHANNELS = 8
};

/* The lines of requests.h that a stream hears with a channel (CHSEL), ORed; 0: none that is modelled. */
uint32_t dma_map_lines(unsigned controller, unsigned stream, unsigned channel);

#endif
