#include "soak_master.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "base_tick.h"
#include "soak_chance.h"
#include "soak_line.h"

enum {
    MOTOR_STREAMED = 4, /* its program comes in parts, for ever */
    PROGRAMMED = 3,     /* motors whose programs never end */
    SETS = 3,
    FLAG_GOOD = 1U << 0U | 1U << 3U, /* or: the memory is full, a warning */
    STATUS_STATES = 6,
    STATUS_ERRORS = 10,
    STATUS_POSITIONS = 14,
    STATUS_LATE = 46,
    STATUS_COUNTS = 50,
    STAND_MS_MAX = 60000,
};

/* The line is in use for a third of the time. */
#define PAUSE_TICKS_MAX (TICK_HZ / 4U)

/* Sets of programs: moves with pauses as a machine has them. None sets the position counter, so positions can be held
 * against the pulses at the pins. */
static const char *const programs[SETS][PROGRAMMED] = {
    {"\\S100V1000A2000@1F800RW2500B800RW4000J1", "\\S300V2000A8000@1F1000RT80Z80W2000J1",
     "\\S300V1600A6000@1O80B700RC80W500J1"},
    {"\\S200V3000A9000@1L3F1500RW1200B1500RW800ET01W3000C01J1",
     "\\S100A4000T55@1V500F300YV1500F900YV400F200YRW5000DRDW7000C05J1",
     "\\S100V4000A10000X08@1M03F6000RW1000U)05W700B3000RW2000HW3000J1"},
    {"\\S100V1000A2000[@1I05H10F500'3J1@10B500'3J1@3RW1600.", "\\S50V16000A60000[@1G30000W6000HW9000J1",
     "\\S400V2500A3000[@1N02G+W2500M04G-W2500U(06W2000J1"},
};

static bool coin(struct soak_master *master, uint32_t of)
{
    return chance_below(&master->chance, of) == 0;
}

static void send_program(struct soak_master *master, unsigned motor, unsigned set)
{
    char text[SOAK_TEXT_MAX];
    /* Alone, nobody else would release it. */
    (void)snprintf(text, sizeof text, "%s%s", programs[set][motor - 1U], set == SETS - 1 ? "]" : "");
    soak_send(master, motor, text, FLAG_GOOD);
    master->tally.programs++;
}

/* A set of programs for the three motors; now and then a new beginning of the fourth's stream, whose memory is full
 * long before. */
static void do_programs(struct soak_master *master)
{
    unsigned set = chance_below(&master->chance, SETS);
    for (unsigned motor = 1; motor <= PROGRAMMED; motor++) {
        soak_send(master, motor, programs[set][motor - 1U], FLAG_GOOD);
    }
    if (coin(master, 20)) {
        soak_send(master, MOTOR_STREAMED, "\\S100V2000A4000", FLAG_GOOD);
    }
    soak_send(master, 0, "]", FLAG_GOOD);
    master->tally.programs += PROGRAMMED;
}

static void do_stream(struct soak_master *master)
{
    char text[SOAK_TEXT_MAX];
    (void)snprintf(text, sizeof text, "G%" PRIu32 "W%" PRIu32 "%s", 1 + chance_below(&master->chance, 8000),
                   1 + chance_below(&master->chance, 3000), coin(master, 3) ? "H" : "");
    soak_send(master, MOTOR_STREAMED, text, FLAG_GOOD);
}

/* The motors that have come to an end, by X or an error or because a text was overwritten, get programs again. */
static void do_look(struct soak_master *master)
{
    uint8_t states[UNIT_MOTORS];
    soak_ask_status(master);
    memcpy(states, master->content + 2 + STATUS_STATES, sizeof states);
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        uint8_t state = states[motor - 1U];
        bool over = (state & (INTERPRETER_STATUS_FAILED | INTERPRETER_STATUS_ENDED)) != 0;
        if ((state & INTERPRETER_STATUS_STOPPED) != 0) {
            soak_send(master, motor, "C75", FLAG_GOOD);
        } else if (motor == MOTOR_STREAMED && over) {
            soak_send(master, motor, "\\S100V2000A4000", FLAG_GOOD);
        } else if (motor != MOTOR_STREAMED && (over || (state & INTERPRETER_STATUS_RUNNING) == 0)) {
            send_program(master, motor, chance_below(&master->chance, SETS));
        }
    }
}

static void do_question(struct soak_master *master)
{
    static const uint8_t numbers[] = {MESSAGES_VERSION, MESSAGES_GET_POSITION, MESSAGES_GET_TABLE,
                                      MESSAGES_GET_PROGRESS, MESSAGES_GET_STATUS};
    uint8_t motor = (uint8_t)('1' + chance_below(&master->chance, UNIT_MOTORS));
    const uint8_t message[2] = {numbers[chance_below(&master->chance, sizeof numbers)], motor};
    soak_request(master, message, sizeof message);
}

static void do_listing(struct soak_master *master)
{
    const uint8_t message[2] = {MESSAGES_GET_COMMAND, (uint8_t)('1' + chance_below(&master->chance, UNIT_MOTORS))};
    soak_request(master, message, sizeof message);
}

static void do_store(struct soak_master *master)
{
    const uint8_t message[2] = {MESSAGES_STORE_FLASH, (uint8_t)('1' + chance_below(&master->chance, PROGRAMMED))};
    soak_request(master, message, sizeof message);
    soak_require(master, master->content_length == 5 && master->content[4] == STORE_OK, "Store Flash stores");
}

static void do_order(struct soak_master *master)
{
    char text[SOAK_TEXT_MAX];
    unsigned motor = 1 + chance_below(&master->chance, UNIT_MOTORS);
    (void)snprintf(text, sizeof text, "V%" PRIu32, 50 + chance_below(&master->chance, 6000));
    soak_send(master, motor, coin(master, 4) ? "K" : coin(master, 4) ? "C75" : text, FLAG_GOOD);
}

static void do_wrong_text(struct soak_master *master)
{
    static const struct {
        const char *text;
        unsigned flag;
    } wrong[] = {{"V16001", 1}, {"\\F100RW0", 1}, {"F5R#", 2}, {"F5Rk", 2}, {"\\{", 2}, {"T59", 1}, {"G2000000001", 1}};
    uint32_t which = chance_below(&master->chance, sizeof wrong / sizeof wrong[0]);
    soak_send(master, chance_below(&master->chance, UNIT_MOTORS + 1U), wrong[which].text, 1U << wrong[which].flag);
}

static void do_repeat(struct soak_master *master)
{
    if (master->known) {
        soak_repeat(master);
    }
}

static void do_broadcast(struct soak_master *master)
{
    static const uint8_t texts[][4] = {{2, '4', 'T', '9'}, {2, '1', 'V', '8'}, {2, '0', 'V', '9'}, {4, '0', 0, 0}};
    uint8_t message[6] = {0};
    memcpy(message, texts[chance_below(&master->chance, 4)], 4);
    message[4] = (uint8_t)('0' + chance_below(&master->chance, 6));
    message[5] = '0';
    soak_broadcast(master, message, message[2] == 'V' ? sizeof message : sizeof message - 1U);
}

/* Requests to other units, and their answers. */
static void do_foreign(struct soak_master *master)
{
    uint8_t frame[SOAK_FRAME_MAX];
    const uint8_t message[] = {MESSAGES_SET_COMMAND, '0', 'K'};
    uint8_t address = (uint8_t)(2 + chance_below(&master->chance, 15) + (coin(master, 2) ? 0x80U : 0U));
    soak_hear(master, frame, frame_write(frame, address, 7, message, sizeof message), 0);
    master->tally.foreign++;
    soak_require(master, master->soak->sent_count == 0, "a frame for others has no answer");
}

static bool is_special(uint8_t byte)
{
    return byte == 0x7E || byte == 0x7D;
}

/* One bit of a frame turned, where it makes no flag and no escape and destroys none: what the FCS is sure to find. */
static void turn_bit(struct soak_master *master, uint8_t *frame, uint32_t length)
{
    for (;;) {
        uint32_t at = 1 + chance_below(&master->chance, length - 2U);
        uint8_t turned = (uint8_t)(frame[at] ^ 1U << chance_below(&master->chance, 8));
        if (!is_special(frame[at]) && !is_special(turned) && frame[at - 1U] != 0x7D) {
            frame[at] = turned;
            return;
        }
    }
}

static void do_damaged(struct soak_master *master)
{
    static const uint8_t message[] = {MESSAGES_SET_COMMAND, '0', '\\', 'F', '5', 'R'};
    uint8_t right[SOAK_FRAME_MAX];
    uint8_t frame[SOAK_FRAME_MAX];
    uint32_t length = frame_write(right, SOAK_NODE, (uint8_t)chance_next(&master->chance), message, sizeof message);
    memcpy(frame, right, length);
    for (uint32_t bits = 1 + chance_below(&master->chance, 3); bits > 0; bits--) {
        turn_bit(master, frame, length);
    }
    if (memcmp(frame, right, length) == 0) { /* a bit turned and turned back */
        turn_bit(master, frame, length);
    }
    soak_hear(master, frame, length, 0);
    master->tally.damaged++;
    soak_require(master, master->soak->sent_count == 0, "a damaged frame has no answer");
}

static void do_noise(struct soak_master *master)
{
    uint8_t bytes[64];
    uint32_t length = 1 + chance_below(&master->chance, sizeof bytes);
    for (uint32_t i = 0; i < length; i++) {
        bytes[i] = (uint8_t)chance_next(&master->chance);
    }
    soak_hear(master, bytes, length,
              chance_next(&master->chance) & chance_next(&master->chance) & chance_next(&master->chance));
    master->tally.noise++;
    soak_require(master, master->soak->sent_count == 0, "noise has no answer");
}

static void do_edge(struct soak_master *master)
{
    unsigned input = chance_below(&master->chance, 8);
    master->inputs ^= (uint8_t)(1U << input);
    host_machine_set_input(&master->soak->machine, input + 1U, (master->inputs >> input & 1U) != 0);
    master->tally.edges++;
}

/* What there is to do, and how often of a thousand times. */
static const struct {
    uint32_t share;
    void (*act)(struct soak_master *master);
} acts[] = {
    {210, do_question}, {270, do_edge},   {90, do_stream},  {90, do_damaged}, {60, do_noise},
    {60, do_look},      {50, do_repeat},  {50, do_order},   {40, do_foreign}, {30, do_wrong_text},
    {30, do_broadcast}, {15, do_listing}, {4, do_programs}, {1, do_store},
};

static void do_version(struct soak_master *master)
{
    const uint8_t message[] = {MESSAGES_VERSION};
    soak_request(master, message, sizeof message);
}

void soak_master_begin(struct soak_master *master, struct soak_unit *soak, uint64_t seed)
{
    memset(master, 0, sizeof *master);
    master->soak = soak;
    master->chance = seed;
    do_version(master);
    do_programs(master);
}

void soak_master_act(struct soak_master *master)
{
    uint32_t chosen = chance_below(&master->chance, 1000);
    for (size_t i = 0; i < sizeof acts / sizeof acts[0]; i++) {
        if (chosen < acts[i].share) {
            acts[i].act(master);
            break;
        }
        chosen -= acts[i].share;
    }
    soak_unit_run(master->soak, 1U + chance_below(&master->chance, PAUSE_TICKS_MAX));
}

/* The counters of the link against what was sent. Noise may hold frames for others, and what is dropped for more than
 * one reason. */
static void compare_counters(struct soak_master *master)
{
    const struct soak_tally *tally = &master->tally;
    uint32_t counts[LINK_COUNTS_TOTAL];
    for (unsigned i = 0; i < LINK_COUNTS_TOTAL; i++) {
        counts[i] = soak_status_number(master, STATUS_COUNTS + 4U * i);
    }
    uint64_t others = counts[LINK_COUNT_FOREIGN] - tally->foreign;
    soak_require(master, counts[LINK_COUNT_FRAMES] == tally->requests + tally->broadcasts,
                 "good frames are counted, and nothing else is executed");
    soak_require(master, counts[LINK_COUNT_REPEATS] == tally->repeats, "repeats are counted");
    soak_require(master, others <= tally->noise / 100U, "frames for others are counted");
    soak_require(master, counts[LINK_COUNT_BROKEN] == tally->broken, "broken bytes are counted");
    soak_require(master, counts[LINK_COUNT_FCS] >= tally->damaged, "damaged frames are counted");
    soak_require(master, counts[LINK_COUNT_FCS] <= tally->damaged + 10U * tally->noise, "and not more of them");
    soak_require(master, counts[LINK_COUNT_UNSENT] == 0, "no answer stays unsent");
    soak_require(master, soak_status_number(master, STATUS_LATE) == 0, "no pulse is late");
}

static void compare_positions(struct soak_master *master)
{
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        uint64_t low = soak_status_number(master, STATUS_POSITIONS + 8U * i);
        uint64_t high = soak_status_number(master, STATUS_POSITIONS + 8U * i + 4U);
        soak_require(master, (int64_t)(high << 32U | low) == master->soak->position[i],
                     "positions are the pulses at the pins");
    }
}

void soak_master_end(struct soak_master *master)
{
    soak_send(master, 0, "\\", FLAG_GOOD);
    for (unsigned i = 0; i < STAND_MS_MAX && !rkm04_is_idle(&master->soak->unit); i++) {
        soak_unit_run(master->soak, TICKS_PER_MS);
    }
    soak_require(master, rkm04_is_idle(&master->soak->unit), "all motors stand after a reset");
    soak_ask_status(master);
    compare_counters(master);
    compare_positions(master);
}
