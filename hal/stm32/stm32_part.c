#include "stm32_private.h"

/* Where the part says how many kilobytes of flash it has (RM0090 39.2). A constant by itself, in no other file, so that
 * an emulator without that memory can be given another place. */
const uint32_t stm32_part_flash_kb_at = 0x1FFF7A22U;
