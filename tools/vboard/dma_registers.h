/*
 * What the program sees of a DMA controller (RM0090 section 10.5). The model is a struct dma.
 */
#ifndef DMA_REGISTERS_H
#define DMA_REGISTERS_H

#include <stdbool.h>
#include <stdint.h>

bool dma_read(void *model, uint32_t offset, uint32_t *value);
bool dma_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

#endif
