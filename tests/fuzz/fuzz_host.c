#include "fuzz_host.h"

enum {
    EDGE_UNIT_US = 10,
};

#define DIGEST_PRIME UINT64_C(0x100000001B3)

uint64_t fuzz_epoch_tick(unsigned epoch)
{
    /* 0, a wrap of the 32-bit counter after 30 ms, one after 3 s, and some other time. */
    static const uint64_t ticks[FUZZ_EPOCHS] = {
        0,
        (UINT64_C(7) << 32U) - UINT64_C(30) * TICKS_PER_MS,
        (UINT64_C(1) << 32U) - UINT64_C(3) * TICK_HZ,
        UINT64_C(0x123456789ABCD),
    };
    return ticks[epoch % FUZZ_EPOCHS];
}

uint64_t fuzz_digest(uint64_t digest, uint64_t number)
{
    return (digest ^ number) * DIGEST_PRIME;
}

bool fuzz_order_flash_fault(struct host_machine *machine, unsigned operand)
{
    struct host_faults *faults = &machine->faults;
    uint32_t at = machine->flash_operations + 1U + operand / 4U;
    switch (operand % 4U) {
    case 0:
        faults->flash_fail_at = at;
        return true;
    case 1:
        faults->flash_silent_at = at;
        return true;
    case 2:
        faults->flash_cut_after = at;
        return true;
    default:
        return false;
    }
}

void fuzz_order_edge(struct host_machine *machine, struct host_input *edge, struct fuzz_stream *stream,
                     unsigned operand)
{
    uint64_t time = fuzz_take_byte(stream);
    *edge = (struct host_input){
        .tick = machine->now + time * time * EDGE_UNIT_US * TICKS_PER_US,
        .input = (uint8_t)(1U + operand % 8U),
        .level = operand / 8U % 2U != 0,
    };
    host_machine_set_script(machine, edge, 1);
}
