#include "base_limits.h"
#include "bringup.h"
#include "hal_io.h"
#include "hal_line.h"

/* Written by the tick interrupt; counts wrap. */
static struct {
    volatile uint8_t levels;
    volatile uint32_t rises[UNIT_INPUTS];
    volatile uint32_t falls[UNIT_INPUTS];
    volatile uint8_t beside[UNIT_INPUTS]; /* others that were 1 when this one got 1 */
    bool begun;
} inputs;

static void note_edge(unsigned input, uint8_t levels)
{
    uint8_t own = (uint8_t)(1U << input);
    if ((levels & own) != 0) {
        inputs.rises[input]++;
        inputs.beside[input] = (uint8_t)(inputs.beside[input] | (levels & ~own));
    } else {
        inputs.falls[input]++;
    }
}

void bringup_inputs_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
    uint8_t levels = hal_io_read_inputs();
    unsigned changed = inputs.begun ? (unsigned)(levels ^ inputs.levels) : 0U;
    inputs.begun = true;
    inputs.levels = levels;
    for (unsigned i = 0; i < UNIT_INPUTS; i++) {
        if ((changed >> i & 1U) != 0) {
            note_edge(i, levels);
        }
    }
}

/* An edge that comes meanwhile is lost or counted. */
void bringup_inputs_forget(void)
{
    for (unsigned i = 0; i < UNIT_INPUTS; i++) {
        inputs.rises[i] = 0;
        inputs.falls[i] = 0;
        inputs.beside[i] = 0;
    }
}

static void tell_counts(const char *name, const volatile uint32_t counts[UNIT_INPUTS])
{
    say_name(name);
    for (unsigned i = 0; i < UNIT_INPUTS; i++) {
        say_decimal(counts[i]);
    }
    say_line_end();
}

void bringup_inputs_tell(void)
{
    say_name("inputs");
    say_hex(inputs.levels, 2);
    say_line_end();
    tell_counts("rises", inputs.rises);
    tell_counts("falls", inputs.falls);
    say_name("beside");
    for (unsigned i = 0; i < UNIT_INPUTS; i++) {
        say_hex(inputs.beside[i], 2);
    }
    say_line_end();
    say_name("node");
    say_decimal(hal_line_node());
    say_line_end();
}
