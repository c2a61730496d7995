#include "iwdg.h"

#include "board.h"

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

static uint64_t period_ps(const struct board *board, uint64_t counts)
{
    return vtime_scale(counts, VTIME_PS_PER_SECOND, board->options->lsi_hz);
}

static uint64_t timeout_ps(const struct board *board)
{
    const struct iwdg *iwdg = &board->iwdg;
    uint32_t code = iwdg->prescaler > PRESCALER_CODE_MOST ? PRESCALER_CODE_MOST : iwdg->prescaler;
    return period_ps(board, ((uint64_t)PRESCALER_LEAST << code) * (iwdg->reload + 1U));
}

void iwdg_reset(struct board *board)
{
    board->iwdg = (struct iwdg){.reload = RELOAD_RESET};
    events_set(board, EVENT_IWDG, VTIME_NEVER);
}

void iwdg_event(struct board *board, uint64_t cycle)
{
    (void)cycle;
    board_request_reset(board, RESET_WATCHDOG);
}

static void reload(struct board *board)
{
    struct iwdg *iwdg = &board->iwdg;
    uint64_t now = board_now_ps(board);
    uint64_t since = now - iwdg->refreshed_ps;
    if (iwdg->refreshes > 0 && since > iwdg->longest_ps) {
        iwdg->longest_ps = since;
    }
    iwdg->refreshed_ps = now;
    iwdg->refreshes++;
    if (iwdg->started) {
        events_set_ps(board, EVENT_IWDG, now + timeout_ps(board));
    }
}

static void write_key(struct board *board, uint32_t value)
{
    struct iwdg *iwdg = &board->iwdg;
    iwdg->unlocked = value == KEY_UNLOCK;
    if (value == KEY_START) {
        iwdg->started = true;
        rcc_start_lsi(board);
        reload(board);
    } else if (value == KEY_RELOAD) {
        reload(board);
    } else if (value != KEY_UNLOCK) {
        board_fail(board, "IWDG_KR: %04x is no key (RM0090 21.4.1)", (unsigned)value);
    }
}

/* Sections 21.3.2 and 21.4: a setting needs the key, and that the one before has been taken over. */
static void write_setting(struct board *board, uint32_t *setting, uint64_t *end_ps, uint32_t value)
{
    uint64_t now = board_now_ps(board);
    if (!board->iwdg.unlocked) {
        board_fail(board, "IWDG: a setting is written without the key, and lost (RM0090 21.3.2)");
    } else if (now < *end_ps) {
        board_fail(board, "IWDG: a setting is written while the one before is not taken over (RM0090 21.4.2, 21.4.3)");
    }
    *setting = value;
    *end_ps = now + period_ps(board, UPDATE_PERIODS);
}

bool iwdg_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value)
{
    const struct iwdg *iwdg = &board->iwdg;
    (void)instance;
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
        *value = (board_now_ps(board) < iwdg->prescaler_end_ps ? SR_PVU : 0U) |
                 (board_now_ps(board) < iwdg->reload_end_ps ? SR_RVU : 0U);
        return true;
    default:
        return false;
    }
}

bool iwdg_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct iwdg *iwdg = &board->iwdg;
    (void)instance;
    (void)mask;
    switch (offset) {
    case IWDG_KR:
        write_key(board, value & 0xFFFFU);
        return true;
    case IWDG_PR:
        write_setting(board, &iwdg->prescaler, &iwdg->prescaler_end_ps, value & 7U);
        return true;
    case IWDG_RLR:
        write_setting(board, &iwdg->reload, &iwdg->reload_end_ps, value & 0xFFFU);
        return true;
    default:
        return false;
    }
}
