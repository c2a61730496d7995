#include "bringup.h"
#include "hal_board.h"
#include "stm32_private.h"
#include "stm32f4.h"

enum {
    ID_WORDS = 3,
    DEVICE_MASK = 0xFFF,
    REVISION_PLACE = 16,
};

/* The unique number of the part (RM0090 39.1). */
static const uint32_t id_at = 0x1FFF7A10U;

static uint32_t reset_flags;

void bringup_part_take_reset(void)
{
    reset_flags = RCC_CSR;
}

static void tell_hex(const char *name, uint32_t value, unsigned digits)
{
    say_name(name);
    say_hex(value, digits);
    say_line_end();
}

static void tell_id(void)
{
    say_name("id");
    for (uint32_t i = 0; i < ID_WORDS; i++) {
        say_hex(STM32_REGISTER(id_at + 4U * i), 8);
    }
    say_line_end();
}

static void tell_flash(void)
{
    say_name("flash_kb");
    say_decimal(*(const volatile uint16_t *)(uintptr_t)stm32_part_flash_kb_at);
    say_line_end();
}

static const char *cause_text(void)
{
    switch (hal_board_start_cause()) {
    case HAL_BOARD_CAUSE_POWER:
        return "power";
    case HAL_BOARD_CAUSE_RESET:
        return "reset";
    case HAL_BOARD_CAUSE_WATCHDOG:
        return "watchdog";
    case HAL_BOARD_CAUSE_FAULT:
    default:
        return "fault";
    }
}

/* What the handler of faults has kept since power came. */
static void tell_fault(void)
{
    const struct stm32_fault *fault = &stm32_fault_record;
    say_name("cause");
    say_word(cause_text());
    say_line_end();
    say_name("faults");
    say_decimal(fault->count);
    say_decimal(fault->exception);
    say_hex(fault->status, 8);
    say_hex(fault->hard, 8);
    say_hex(fault->address, 8);
    say_hex(fault->pc, 8);
    say_line_end();
}

void bringup_part_tell(void)
{
    uint32_t identity = DBG_IDCODE;
    tell_hex("device", identity & (uint32_t)DEVICE_MASK, 3);
    tell_hex("revision", identity >> REVISION_PLACE, 4);
    tell_flash();
    tell_id();
    tell_hex("option_bytes", FLASH_OPTCR, 8);
    tell_hex("reset_flags", reset_flags, 8);
    tell_fault();
}
