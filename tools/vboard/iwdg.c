#include "iwdg.h"

enum {
    IWDG_KR = 0x00,
    IWDG_PR = 0x04,
    IWDG_RLR = 0x08,
    IWDG_SR = 0x0C,
    SR_PVU = 1 << 0,
    SR_RVU = 1 << 1,
    KEY_RELOAD = 0xAAAA,
    KEY_UNLOCK = 0x5555,
    KEY_START = 0xCCCC,
    RELOAD_RESET = 0xFFF,
    PRESCALER_LEAST = 4,
    PRESCALER_CODE_MOST = 6,
    UPDATE_PERIODS = 5, /* of the oscillator, until a new value is taken over */
};

static uint64_t period_ps(const struct iwdg *iwdg, uint64_t counts)
{
    return vtime_scale(counts, VTIME_PS_PER_SECOND, iwdg->wires.lsi_hz);
}

static uint64_t timeout_ps(const struct iwdg *iwdg)
{
    uint32_t code = iwdg->prescaler > PRESCALER_CODE_MOST ? PRESCALER_CODE_MOST : iwdg->prescaler;
    return period_ps(iwdg, ((uint64_t)PRESCALER_LEAST << code) * (iwdg->reload + 1U));
}

void iwdg_reset(struct iwdg *iwdg)
{
    *iwdg = (struct iwdg){.wires = iwdg->wires, .reload = RELOAD_RESET};
    clock_set(iwdg->wires.clock, EVENT_IWDG, VTIME_NEVER);
}

static void on_iwdg_event(void *model, uint64_t cycle)
{
    struct iwdg *iwdg = model;
    (void)cycle;
    reset_request(iwdg->wires.reset, RESET_WATCHDOG);
}

static void reload(struct iwdg *iwdg)
{
    uint64_t now = clock_now_ps(iwdg->wires.clock);
    uint64_t since = now - iwdg->refreshed_ps;
    if (iwdg->refreshes > 0 && since > iwdg->longest_ps) {
        iwdg->longest_ps = since;
    }
    iwdg->refreshed_ps = now;
    iwdg->refreshes++;
    if (iwdg->started) {
        clock_set_ps(iwdg->wires.clock, EVENT_IWDG, now + timeout_ps(iwdg));
    }
}

/* What was written while the watchdog stood is taken over once it runs. */
static void begin_update(const struct iwdg *iwdg, uint64_t *end_ps)
{
    if (*end_ps == VTIME_NEVER) {
        *end_ps = clock_now_ps(iwdg->wires.clock) + period_ps(iwdg, UPDATE_PERIODS);
    }
}

static void write_key(struct iwdg *iwdg, uint32_t value)
{
    iwdg->unlocked = value == KEY_UNLOCK;
    if (value == KEY_START) {
        iwdg->started = true;
        begin_update(iwdg, &iwdg->prescaler_end_ps);
        begin_update(iwdg, &iwdg->reload_end_ps);
        rcc_start_lsi(iwdg->wires.rcc);
        reload(iwdg);
    } else if (value == KEY_RELOAD) {
        reload(iwdg);
    } else if (value != KEY_UNLOCK) {
        report_fail(iwdg->wires.report, "IWDG_KR: %04x is no key (RM0090 21.4.1)", (unsigned)value);
    }
}

/* Sections 21.3.2 and 21.4: a setting needs the key, and that the one before has been taken over. */
static void write_setting(struct iwdg *iwdg, uint32_t *setting, uint64_t *end_ps, uint32_t value)
{
    uint64_t now = clock_now_ps(iwdg->wires.clock);
    if (!iwdg->unlocked) {
        report_fail(iwdg->wires.report, "IWDG: a setting is written without the key, and lost (RM0090 21.3.2)");
    } else if (now < *end_ps) {
        report_fail(iwdg->wires.report,
                    "IWDG: a setting is written while the one before is not taken over (RM0090 21.4.2, 21.4.3)");
    }
    *setting = value;
    *end_ps = VTIME_NEVER;
    if (iwdg->started) {
        begin_update(iwdg, end_ps);
    }
}

void iwdg_leave_slow(struct iwdg *iwdg)
{
    iwdg->prescaler = PRESCALER_CODE_MOST;
    iwdg->prescaler_end_ps = VTIME_NEVER;
}

bool iwdg_read(void *model, uint32_t offset, uint32_t *value)
{
    const struct iwdg *iwdg = model;
    switch (offset) {
    case IWDG_KR:
        *value = 0;
        return true;
    case IWDG_PR:
        *value = iwdg->prescaler;
        return true;
    case IWDG_RLR:
        *value = iwdg->reload;
        return true;
    case IWDG_SR:
        *value = (clock_now_ps(iwdg->wires.clock) < iwdg->prescaler_end_ps ? SR_PVU : 0U) |
                 (clock_now_ps(iwdg->wires.clock) < iwdg->reload_end_ps ? SR_RVU : 0U);
        return true;
    default:
        return false;
    }
}

bool iwdg_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct iwdg *iwdg = model;
    (void)mask;
    switch (offset) {
    case IWDG_KR:
        write_key(iwdg, value & 0xFFFFU);
        return true;
    case IWDG_PR:
        write_setting(iwdg, &iwdg->prescaler, &iwdg->prescaler_end_ps, value & 7U);
        return true;
    case IWDG_RLR:
        write_setting(iwdg, &iwdg->reload, &iwdg->reload_end_ps, value & 0xFFFU);
        return true;
    default:
        return false;
    }
}

void iwdg_init(struct iwdg *iwdg, struct iwdg_wires wires)
{
    iwdg->wires = wires;
    clock_attach(wires.clock, EVENT_IWDG, on_iwdg_event, iwdg);
}
