/*
 * What an operation of the flash leaves in the memory: all of it, or what is left of one that fails or is cut.
 */
#ifndef FLASH_OUTCOME_H
#define FLASH_OUTCOME_H

#include <stdint.h>

#include "flash.h"

/* A byte of the operation in progress, counted from its address, that was `before`. */
uint8_t flash_after(const struct flash *flash, uint32_t index, uint8_t before);

/* So many bytes change as they should; of the bits that were to change some have and some have not; all but one. */
void flash_change(struct flash *flash, uint32_t bytes);
void flash_change_some(struct flash *flash, uint32_t seed);
void flash_change_all_but_one_bit(struct flash *flash);

#endif
