/*
 * The seam to the memory that keeps its content without power: two areas that are erased as a whole, bytes FF when
 * erased, written in 32-bit words, each word once between erases. Main only; the calls may take seconds, and the
 * backend keeps all interrupts running meanwhile.
 */
#ifndef HAL_FLASH_H
#define HAL_FLASH_H

#include <stdbool.h>
#include <stdint.h>

enum {
    HAL_FLASH_AREAS = 2,
    HAL_FLASH_AREA_BYTES = 128 * 1024, /* one large sector of an STM32F405 */
    HAL_FLASH_WORD_BYTES = 4,
};

/* Whether the part has the areas. Where it has not, nothing may be read, and writing and erasing fail. */
bool hal_flash_is_there(void);

/* Copies `length` bytes at `offset` of an area; all must lie inside it. */
void hal_flash_read(unsigned area, uint32_t offset, uint8_t *bytes, uint32_t length);

/* Writes one word: four bytes in the order given, at an offset that is a multiple of four. False: the memory reports
 * an error; what the word holds then is not defined. */
bool hal_flash_write_word(unsigned area, uint32_t offset, const uint8_t bytes[HAL_FLASH_WORD_BYTES]);

/* Erases an area. False: the memory reports an error. */
bool hal_flash_erase(unsigned area);

#endif
