#include "gve_player.h"

#include <assert.h>
#include <string.h>

#include "base_tick.h"
#include "units.h"

enum {
    INTERPOLATOR = '0',
    SPINDLE = '7',
    CODE = 7, /* of an answer's digit, without INTA */
    SUM_CHARACTERS = 3,
};

/* After code 1, where bytes take no time; else they take it. */
#define REPEAT_TICKS ((uint64_t)TICKS_PER_MS)

/* So long a unit may need after a reset. */
#define RESET_TICKS ((uint64_t)100 * TICKS_PER_MS)

static const char hex_digits[] = "0123456789ABCDEF";

/* ---- lines out ------------------------------------------------------------------------------------------------- */

struct draft {
    uint8_t bytes[GVE_PLAYER_BYTES_MAX];
    uint32_t length;
};

static void put(struct draft *draft, uint8_t byte)
{
    draft->bytes[draft->length++] = byte;
}

/* The sum of all characters up to the comma before it, that included. */
static void put_sum(struct draft *draft)
{
    unsigned sum = 0;
    put(draft, ',');
    for (uint32_t i = 0; i < draft->length; i++) {
        sum += draft->bytes[i];
    }
    put(draft, (uint8_t)hex_digits[sum >> 4U & 0xFU]);
    put(draft, (uint8_t)hex_digits[sum & 0xFU]);
}

static struct draft write_line(const struct gve_player *player, const struct gve_file_line *line)
{
    struct draft draft = {.length = 0};
    put(&draft, '!');
    put(&draft, line->address == GVE_ADDRESS_SPINDLE ? SPINDLE : INTERPOLATOR);
    for (uint32_t i = 0; i < line->length; i++) {
        put(&draft, line->text[i]);
    }
    if (player->sums) {
        put_sum(&draft);
    }
    put(&draft, '\r');
    return draft;
}

/* Puts a line on its way; the tick at which the unit has all of it. */
static uint64_t send(struct gve_player *player, const struct gve_file_line *line)
{
    struct draft draft = write_line(player, line);
    uint64_t tick = player->machine->now;
    for (uint32_t i = 0; i < draft.length; i++) {
        tick += player->byte_ticks != 0 ? player->byte_ticks : 1U; /* else they would overrun main */
        player->bytes[i] = (struct host_line_byte){.tick = tick, .value = draft.bytes[i]};
    }
    host_machine_set_line(player->machine, player->bytes, draft.length);
    return tick;
}

static bool is_on_its_way(const struct gve_player *player)
{
    return player->machine->line.script_next < player->machine->line.script_length;
}

/* ---- lines that wait ------------------------------------------------------------------------------------------- */

static bool stands_alone(uint8_t opcode)
{
    return opcode == GVE_RESET || opcode == GVE_SUMS_ON || opcode == GVE_SUMS_OFF;
}

static void await(struct gve_player *player, const struct gve_script_line *line, bool timed, uint64_t heard_tick)
{
    uint32_t at = (player->waiting_first + player->waiting_count) % GVE_PLAYER_WAITING_MAX;
    assert(player->waiting_count < GVE_PLAYER_WAITING_MAX);
    player->waiting[at] = (struct gve_player_waiting){.line = *line, .timed = timed, .heard_tick = heard_tick};
    player->waiting_count++;
    player->alone = stands_alone(line->opcode);
}

static struct gve_player_waiting *first_waiting(struct gve_player *player)
{
    return &player->waiting[player->waiting_first];
}

static struct gve_player_waiting take_waiting(struct gve_player *player)
{
    struct gve_player_waiting waiting = *first_waiting(player);
    player->waiting_first = (player->waiting_first + 1U) % GVE_PLAYER_WAITING_MAX;
    player->waiting_count--;
    player->alone = player->alone && player->waiting_count > 0;
    return waiting;
}

/* ---- the lines that follow each other -------------------------------------------------------------------------- */

/* The next command of a probing is sent as if it stood in the file, in its line. */
static void send_probing(struct gve_player *player, uint64_t wait_ticks)
{
    struct gve_file_line *line = &player->next.line;
    line->address = GVE_ADDRESS_INTERPOLATOR;
    line->text = (const uint8_t *)player->probing.text;
    line->length = (uint32_t)strlen(player->probing.text);
    player->next.opcode = gve_command_read(line->text, line->length, GVE_ADDRESS_INTERPOLATOR).command.opcode;
    player->next_waits = false;
    player->next_tick = player->machine->now + wait_ticks;
}

static void begin_probing(struct gve_player *player)
{
    if (player->next.line.probes) {
        gve_probing_begin(&player->probing);
        send_probing(player, 0);
    }
    if (player->next.opcode == GVE_LINE && gve_script_probes_next(&player->script)) {
        player->approach = player->next;
        gve_probing_approach(&player->probing, player->next.line.text, player->next.line.length);
        send_probing(player, player->next_tick - player->machine->now);
    }
}

static void go_on(struct gve_player *player)
{
    struct gve_script_place before = player->script.place;
    player->next_waits = false;
    player->next_tick = player->machine->now;
    player->has_next = gve_script_next(&player->script, &player->next);
    if (player->has_next) {
        player->next_tick += units_ticks_of_ns(player->next.line.wait_ns);
        begin_probing(player);
    }
    if (player->has_next && player->next.opcode == GVE_PACKET_BEGIN) {
        player->packet_before = before;
    }
}

static void repeat_packet(struct gve_player *player)
{
    player->commands -= player->packet_commands;
    player->script.place = player->packet_before;
    go_on(player);
}

/* What has no answer is done when it has been sent. */
static void go_on_in_packet(struct gve_player *player, uint8_t opcode)
{
    if (opcode == GVE_PACKET_BEGIN) {
        player->packet = true;
        player->packet_commands = 0;
        player->packet_vectors = 0;
    }
    player->packet_commands++;
    player->packet_vectors += opcode == GVE_CONTINUE ? 1U : 0U;
    player->commands++;
    go_on(player);
}

static void send_next(struct gve_player *player)
{
    uint8_t opcode = player->next.opcode;
    uint64_t heard_tick = send(player, &player->next.line);
    bool ends_packet = gve_row(opcode)->packet == GVE_PACKET_ENDS;
    if (opcode == GVE_PACKET_BEGIN || (player->packet && !ends_packet)) {
        go_on_in_packet(player, opcode);
        return;
    }
    player->packet = false;
    player->next_waits = true;
    await(player, &player->next, false, heard_tick);
}

/* ---- answers --------------------------------------------------------------------------------------------------- */

static bool read_digit(char byte, unsigned *digit)
{
    const char *at = byte == '\0' ? NULL : strchr(hex_digits, byte);
    *digit = at == NULL ? 0U : (unsigned)(at - hex_digits);
    return at != NULL;
}

/* Takes the sum away. False: it is missing or wrong. */
static bool take_sum(struct gve_told_text *text)
{
    struct draft draft = {.length = 0};
    if (text->length <= SUM_CHARACTERS) {
        return false;
    }
    text->length -= SUM_CHARACTERS;
    for (uint32_t i = 0; i < text->length; i++) {
        put(&draft, (uint8_t)text->bytes[i]);
    }
    put_sum(&draft);
    return memcmp(&draft.bytes[text->length], &text->bytes[text->length], SUM_CHARACTERS) == 0;
}

/* Whether the answer to a command has a sum, and those after it. */
static bool has_sum(struct gve_player *player, uint8_t opcode)
{
    bool sum = opcode == GVE_SUMS_ON || (player->sums && opcode != GVE_SUMS_OFF);
    player->sums = sum && opcode != GVE_RESET;
    return sum;
}

static void count_vectors(struct gve_player *player, uint8_t opcode)
{
    if (opcode == GVE_LINE || opcode == GVE_CONTINUE) {
        player->vectors++;
    } else if (opcode == GVE_PACKET_END) {
        player->vectors += player->packet_vectors;
    } else {
        /* is none */
    }
}

static void repeat(struct gve_player *player, const struct gve_player_waiting *answered)
{
    uint64_t tick = player->machine->now + (player->byte_ticks != 0 ? 0 : REPEAT_TICKS);
    player->repeats++;
    if (answered->timed) {
        struct gve_script_line line = answered->line;
        line.tick = tick;
        line.repeated = true;
        gve_script_put_back(&player->script, &line);
        return;
    }
    player->next_waits = false;
    player->next_repeats++;
    if (answered->line.opcode == GVE_PACKET_END) {
        repeat_packet(player);
    }
    player->next_tick = tick;
}

/* The number behind the code of a packet is no value. */
static bool has_values(uint8_t opcode, const struct gve_told_text *text)
{
    return text->length > 1 && opcode != GVE_PACKET_END;
}

enum verdict {
    VERDICT_DONE,
    VERDICT_NO_ROOM,
    VERDICT_WRONG, /* a refusal, or no answer as answers are */
};

static enum verdict judge(struct gve_player *player, uint8_t opcode, struct gve_told_text *text)
{
    unsigned digit = 0;
    bool good = !has_sum(player, opcode) || take_sum(text);
    if (!good || text->length == 0 || !read_digit(text->bytes[0], &digit)) {
        return VERDICT_WRONG;
    }
    if ((digit & CODE) == GVE_NO_ROOM && opcode != GVE_REPEAT) {
        return VERDICT_NO_ROOM;
    }
    return (digit & CODE) == GVE_DONE ? VERDICT_DONE : VERDICT_WRONG;
}

static void tell(struct gve_player *player, const struct gve_player_waiting *answered, enum verdict verdict,
                 const struct gve_told_text *text)
{
    bool wrong = verdict == VERDICT_WRONG;
    if (wrong || has_values(answered->line.opcode, text)) {
        gve_told_add(&player->told,
                     &(struct gve_told_answer){
                         .line = answered->line.line, .wrong = wrong, .reason = player->probing.reason, .text = *text});
    }
}

/* The answer to a command of a probing. What does not end well is told, and is the end of the file. */
static void finish_probing(struct gve_player *player, const struct gve_player_waiting *answered, enum verdict verdict,
                           const struct gve_told_text *text)
{
    enum gve_probing_result result = GVE_PROBING_FAILS;
    if (verdict == VERDICT_DONE) {
        result = gve_probing_take(&player->probing, text->bytes, text->length);
    }
    player->commands += result == GVE_PROBING_ASKS ? 0U : 1U;
    player->repeats += result == GVE_PROBING_ASKS ? 1U : 0U;
    switch (result) {
    case GVE_PROBING_SENDS:
        send_probing(player, 0);
        break;
    case GVE_PROBING_ASKS:
        send_probing(player, REPEAT_TICKS);
        break;
    case GVE_PROBING_READY:
        player->next = player->approach;
        player->next_waits = false;
        player->next_tick = player->machine->now;
        break;
    case GVE_PROBING_DONE:
        go_on(player);
        break;
    case GVE_PROBING_FAILS:
    default:
        player->probing.phase = GVE_PROBING_NONE;
        tell(player, answered, VERDICT_WRONG, text);
        player->probing.reason = NULL;
        player->has_next = false;
        break;
    }
}

static void finish(struct gve_player *player, const struct gve_player_waiting *answered, struct gve_told_text *text)
{
    enum verdict verdict = judge(player, answered->line.opcode, text);
    if (verdict == VERDICT_NO_ROOM) {
        repeat(player, answered);
        return;
    }
    if (verdict == VERDICT_DONE) {
        count_vectors(player, answered->line.opcode);
    }
    if (!answered->timed && player->probing.phase != GVE_PROBING_NONE) {
        finish_probing(player, answered, verdict, text);
        return;
    }
    player->commands++;
    tell(player, answered, verdict, text);
    if (!answered->timed) {
        player->next_repeats = 0;
        go_on(player);
    }
}

/* What waits before J has had no answer and will have none. */
static void finish_reset(struct gve_player *player)
{
    while (player->waiting_count > 1) {
        struct gve_player_waiting unanswered = take_waiting(player);
        player->silent++;
        if (!unanswered.timed) {
            player->probing.phase = GVE_PROBING_NONE;
            go_on(player);
        }
    }
    struct gve_player_waiting reset = take_waiting(player);
    struct gve_told_text text = player->held;
    player->held.length = 0;
    finish(player, &reset, &text);
}

static bool is_resetting(struct gve_player *player, uint64_t tick)
{
    uint32_t last = (player->waiting_first + player->waiting_count - 1U) % GVE_PLAYER_WAITING_MAX;
    const struct gve_player_waiting *waiting = &player->waiting[last];
    return player->waiting_count > 0 && waiting->line.opcode == GVE_RESET && tick >= waiting->heard_tick;
}

static void take_answer(struct gve_player *player, struct gve_told_text *text)
{
    uint32_t left = 0; /* what must go on waiting */
    if (is_resetting(player, text->tick)) {
        struct gve_told_text before = player->held;
        player->held = *text;
        player->quiet_tick = text->tick + RESET_TICKS;
        if (before.length == 0) {
            return;
        }
        *text = before;
        left = 1;
    }
    if (player->waiting_count == left) {
        gve_told_add(&player->told, &(struct gve_told_answer){.wrong = true, .text = *text});
        return;
    }
    struct gve_player_waiting answered = take_waiting(player);
    finish(player, &answered, text);
}

void gve_player_hear(void *context, uint64_t tick, uint8_t value)
{
    struct gve_player *player = context;
    struct gve_told_text *text = &player->text;
    text->tick = tick;
    if (value != '\r' && text->length < GVE_TOLD_TEXT_BYTES) {
        text->bytes[text->length++] = (char)value;
    }
    if (value == '\r') {
        take_answer(player, text);
        text->length = 0;
        host_machine_wake(player->machine, tick);
    }
}

/* ---- the course of it ------------------------------------------------------------------------------------------ */

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t next_tick(const struct gve_player *player)
{
    return player->has_next && !player->next_waits ? player->next_tick : TICK_NEVER;
}

static uint64_t timed_tick(const struct gve_player *player)
{
    return player->packet ? TICK_NEVER : gve_script_timed_tick(&player->script);
}

/* When there is something to do, if no answer comes before. */
static uint64_t due_tick(const struct gve_player *player)
{
    if (player->alone) {
        return player->held.length > 0 ? player->quiet_tick : TICK_NEVER;
    }
    if (player->waiting_count == GVE_PLAYER_WAITING_MAX) {
        return TICK_NEVER;
    }
    uint64_t due = earlier(next_tick(player), timed_tick(player));
    return due < player->quiet_tick ? player->quiet_tick : due;
}

static void send_due(struct gve_player *player)
{
    if (timed_tick(player) > player->machine->now) {
        send_next(player);
        return;
    }
    struct gve_script_line line;
    gve_script_take_timed(&player->script, &line);
    await(player, &line, true, send(player, &line.line));
}

/* The bytes of a line on its way wake main themselves. */
uint64_t gve_player_pass(void *context)
{
    struct gve_player *player = context;
    if (is_on_its_way(player)) {
        return TICK_NEVER;
    }
    uint64_t due = due_tick(player);
    if (due > player->machine->now) {
        return due;
    }
    if (player->alone) {
        finish_reset(player);
        due = due_tick(player);
    }
    if (due <= player->machine->now) {
        send_due(player);
        due = TICK_NEVER;
    }
    return due;
}

bool gve_player_is_over(const void *context)
{
    const struct gve_player *player = context;
    return gve_player_stuck_at(player) == NULL && !is_on_its_way(player);
}

const struct gve_script_line *gve_player_stuck_at(const struct gve_player *player)
{
    if (player->waiting_count > 0) {
        return &player->waiting[player->waiting_first].line;
    }
    if (player->has_next) {
        return &player->next;
    }
    return gve_script_timed_tick(&player->script) != TICK_NEVER ? &player->script.timed[player->script.timed_taken]
                                                                : NULL;
}

bool gve_player_begin(struct gve_player *player, struct host_machine *machine, const struct infile *file,
                      uint32_t byte_ticks)
{
    *player = (struct gve_player){.machine = machine, .byte_ticks = byte_ticks, .told = gve_told_none()};
    if (!gve_script_begin(&player->script, file)) {
        return false;
    }
    go_on(player);
    return true;
}

void gve_player_discard(struct gve_player *player)
{
    gve_script_discard(&player->script);
    gve_told_discard(&player->told);
}
