/*
 * Every instruction in every state of an axis, over the line: its result, the bits that one request sees that brings
 * it, where the axis comes to rest, and that the measure under way is made as if a refused instruction had not been.
 */
#include "pos_wire.h"

#define FEED (UINT32_C(1000) << 16U)
#define OTHER_FEED (UINT32_C(777) << 16U)

enum {
    ACCEL = 100,
    LEN = 10000,
    OTHER_LEN = -700,
    HERE = 4321,
    LIMIT_PLUS = 147,
    REFERENCE = 148,
    CAPTURE = 149,
    OUT = 600,
    IN = 640,
    PROG = 2,
    ERR = 4,
    POL = 0x800,
    JEDE = 0x100,
    SMER = 0x200,
};

enum situation {
    FREE,
    FREE_BRAKES,
    TAKEN,
    TAKEN_BRAKES,
    WAITING,
    READY,
    HELD,
    MOVING,
    HOLDING,
    REACHED,
    FAULT,
    FAULT_BRAKES,
    SITUATIONS
};

enum told {
    INIT,
    INIT_WRONG,
    MODE,
    MODE_ABS,
    HOME_HERE,
    HOME_POSITIVE,
    RESET,
    ARM,
    TOLD
};

static const uint16_t words[TOLD][5] = {
    [INIT] = {0x5001, 6, 0, 0, 0},
    [INIT_WRONG] = {0x5001, 7, 0, 0, 0},
    [MODE] = {0x5002, 0, 0xFFFF, (uint16_t)OTHER_LEN, ACCEL},
    [MODE_ABS] = {0x5004, 0, 0, HERE, ACCEL},
    [HOME_HERE] = {0x5005, 37, 0, HERE, 0},
    [HOME_POSITIVE] = {0x5005, 19, 0, HERE, ACCEL},
    [RESET] = {0x5003, 0, 0, 0, 0},
    [ARM] = {0x5006, 0, 0, 0, 0},
};

/* With which error it is refused; 0: taken. */
static const uint8_t results[SITUATIONS][TOLD] = {
    [FREE] = {0, 2, 3, 3, 3, 3, 0, 0},      [FREE_BRAKES] = {0, 2, 3, 3, 3, 3, 0, 0},
    [TAKEN] = {0, 2, 0, 0, 0, 0, 0, 0},     [TAKEN_BRAKES] = {0, 2, 0, 0, 0, 0, 0, 0},
    [WAITING] = {0, 2, 4, 4, 4, 4, 0, 0},   [READY] = {0, 2, 0, 0, 0, 0, 0, 0},
    [HELD] = {0, 2, 0, 0, 0, 0, 0, 0},      [MOVING] = {0, 2, 4, 4, 4, 4, 0, 0},
    [HOLDING] = {0, 2, 4, 4, 4, 4, 0, 0},   [REACHED] = {0, 2, 0, 0, 0, 0, 0, 0},
    [FAULT] = {0, 2, 15, 15, 15, 15, 0, 0}, [FAULT_BRAKES] = {0, 2, 15, 15, 15, 15, 0, 0},
};

/* STATUS but for SMER, and the bits of CONTROL. */
static const unsigned statuses[SITUATIONS] = {
    [FREE] = 0,        [FREE_BRAKES] = 0x0100,
    [TAKEN] = 1,       [TAKEN_BRAKES] = 0x0101,
    [WAITING] = 0x103, [READY] = 3,
    [HELD] = 3,        [MOVING] = 0x103,
    [HOLDING] = 0x103, [REACHED] = 0x803,
    [FAULT] = 5,       [FAULT_BRAKES] = 0x105,
};
static const unsigned controls[SITUATIONS] = {
    [FREE] = 0, [FREE_BRAKES] = 0, [TAKEN] = 1,   [TAKEN_BRAKES] = 1, [WAITING] = 5, [READY] = 9,
    [HELD] = 8, [MOVING] = 9,      [HOLDING] = 8, [REACHED] = 1,      [FAULT] = 1,   [FAULT_BRAKES] = 1,
};
static const uint32_t feeds[SITUATIONS] = {
    [HELD] = FEED,
    [MOVING] = FEED,
    [HOLDING] = FEED,
    [REACHED] = FEED,
};

/* STATUS when what was under way before has come to its end, with the feed as it is. */
static const unsigned ends[SITUATIONS] = {
    [FREE] = 0, [FREE_BRAKES] = 0, [TAKEN] = 1,   [TAKEN_BRAKES] = 1, [WAITING] = 3, [READY] = 3,
    [HELD] = 3, [MOVING] = 0x803,  [HOLDING] = 3, [REACHED] = 0x803,  [FAULT] = 5,   [FAULT_BRAKES] = 5,
};

static void set(uint32_t number, uint16_t value)
{
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, number, 1, &value));
}

void setUp(void)
{
}

void tearDown(void)
{
}

static void mode(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, LEN, ACCEL, 1));
}

static void control(uint32_t feed, int mp)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, feed, mp, 1));
}

static void move(uint64_t ms)
{
    mode();
    control(FEED, 1);
    rig_run_ms(ms);
}

static void take(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
}

static void brake(enum situation situation)
{
    move(400);
    if (situation == FREE_BRAKES) {
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    } else if (situation == FAULT_BRAKES) {
        host_machine_set_input(&machine, 1, true);
    } else if (situation == HOLDING) {
        control(FEED, 0);
    } else {
        take();
    }
    if (situation == WAITING) {
        mode();
    }
    rig_run_ms(5);
}

static void come(enum situation situation)
{
    rig_set_up();
    rig_run_ms(10);
    set(LIMIT_PLUS, 1);
    set(REFERENCE, 2);
    set(CAPTURE, 3);
    if (situation != FREE) {
        take();
    }
    switch (situation) {
    case READY:
        mode();
        break;
    case HELD:
        move(400);
        control(FEED, 0);
        rig_run_until_rest(1, 1000);
        break;
    case MOVING:
        move(400);
        break;
    case REACHED:
        move(0);
        rig_run_ms(5000);
        break;
    case FAULT:
        move(400);
        host_machine_set_input(&machine, 1, true);
        rig_run_ms(1000);
        break;
    case FREE:
    case TAKEN:
    case SITUATIONS:
        break;
    case FREE_BRAKES:
    case TAKEN_BRAKES:
    case WAITING:
    case HOLDING:
    case FAULT_BRAKES:
        brake(situation);
        break;
    }
    rig_run_ms(5);
    host_machine_set_input(&machine, 1, false);
    TEST_ASSERT_EQUAL_HEX(statuses[situation], rig_status(1));
    TEST_ASSERT_EQUAL_HEX(controls[situation], rig_control(1));
    TEST_ASSERT_EQUAL_UINT32(feeds[situation], unit.axes[0].feed);
}

/* The instruction and its parameters, with what is read in the same request. */
static void tell(enum told told, uint32_t first, uint32_t count)
{
    struct wire_frame frame = {.bytes = {1, MODBUS_WRITE_AND_READ}, .length = 2};
    wire_word(&frame, first);
    wire_word(&frame, count);
    wire_word(&frame, OUT);
    wire_word(&frame, 5);
    frame.bytes[frame.length++] = 10;
    for (unsigned i = 0; i < 5; i++) {
        wire_word(&frame, words[told][i]);
    }
    TEST_ASSERT_EQUAL_UINT(0, wire_ask(&frame));
}

static bool is_measure(enum told told)
{
    return told == MODE || told == MODE_ABS || told == HOME_HERE || told == HOME_POSITIVE;
}

/* The bits of STATUS but JEDE, which stays, by the table of events. */
static unsigned status_after(enum situation situation, enum told told)
{
    unsigned before = statuses[situation];
    unsigned moves = before & (unsigned)JEDE;
    if (results[situation][told] != 0) {
        return before | (unsigned)ERR;
    }
    if (told == INIT) {
        return moves | 1U;
    }
    if (told == RESET) {
        return moves;
    }
    return is_measure(told) ? (before | (unsigned)PROG) & ~(unsigned)POL : before;
}

static unsigned control_after(enum situation situation, enum told told)
{
    unsigned before = controls[situation];
    if (results[situation][told] != 0 || told == ARM) {
        return before;
    }
    if (told == INIT || told == RESET) {
        return told == INIT ? 3 : 2;
    }
    return (before & 1U) | 4U;
}

static uint32_t feed_after(enum situation situation, enum told told)
{
    bool stays = results[situation][told] != 0 || told == ARM;
    return stays ? feeds[situation] : 0;
}

static unsigned end_after(enum situation situation, enum told told)
{
    if (results[situation][told] != 0) {
        return ends[situation] | (unsigned)ERR;
    }
    if (told == INIT || told == RESET) {
        return told == INIT ? 1 : 0;
    }
    if (!is_measure(told)) {
        return ends[situation];
    }
    return told == HOME_HERE ? 0x803 : 3;
}

/* One request brings the instruction and reads; what the pass in which it is executed shows. */
static void assert_seen(enum situation situation, enum told told, const char *message)
{
    come(situation);
    tell(told, IN, 8);
    TEST_ASSERT_EQUAL_HEX_MESSAGE(status_after(situation, told), rig_word(0) & ~(unsigned)SMER, message);
    TEST_ASSERT_EQUAL_HEX_MESSAGE(words[told][0], rig_word(2), message);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(results[situation][told], rig_word(3), message);
    bool faulty = situation == FAULT || situation == FAULT_BRAKES;
    bool cleared = told == INIT || told == RESET;
    unsigned error = faulty && !cleared ? POS_ERROR_LIMIT : results[situation][told];
    TEST_ASSERT_EQUAL_UINT_MESSAGE(error, rig_word(1), message);
    rig_run_ms(10000);
    TEST_ASSERT_EQUAL_HEX_MESSAGE(end_after(situation, told), rig_status(1) & ~(unsigned)SMER, message);
}

static void assert_control_seen(enum situation situation, enum told told, const char *message)
{
    come(situation);
    tell(told, OUT + 5, 3);
    TEST_ASSERT_EQUAL_HEX_MESSAGE(control_after(situation, told), rig_word(0), message);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(feed_after(situation, told), rig_word(1) << 16U | rig_word(2), message);
    TEST_ASSERT_EQUAL_INT_MESSAGE(told == ARM, unit.axes[0].watch.armed, message);
}

/* With feed and permission, the measure that was under way, or the one that was taken, is made exactly. */
static void assert_made(enum situation situation, enum told told, const char *message)
{
    come(situation);
    bool old = results[situation][told] != 0 || told == ARM;
    bool has_old = (statuses[situation] & (unsigned)PROG) != 0;
    bool from_new_stand = situation == WAITING;
    tell(told, IN, 8);
    for (unsigned ms = 0; ms < 1000 && pos_axis_is_busy(&unit.axes[0]) && situation != MOVING; ms++) {
        rig_run_ms(1);
    }
    if (!old && is_measure(told)) {
        rig_run_ms(1000);
    }
    int64_t stand = rig_position[0];
    if (told != HOME_POSITIVE || old) {
        control(FEED, 1);
        rig_run_ms(5000);
    }
    int64_t wanted = stand;
    if (old && has_old) {
        wanted = from_new_stand ? stand + LEN / 10 : LEN / 10;
    } else if (!old && told == MODE) {
        wanted = stand + OTHER_LEN / 10;
    } else if (!old && told == MODE_ABS) {
        wanted = (HERE + 5) / 10;
    }
    if (old || is_measure(told)) {
        TEST_ASSERT_EQUAL_INT64_MESSAGE(wanted, rig_position[0], message);
    }
}

void test_every_instruction_in_every_state_does_what_the_tables_say(void)
{
    for (unsigned situation = 0; situation < (unsigned)SITUATIONS; situation++) {
        for (unsigned told = 0; told < (unsigned)TOLD; told++) {
            char message[40];
            (void)snprintf(message, sizeof message, "state %u, instruction %u", situation, told);
            assert_seen((enum situation)situation, (enum told)told, message);
            assert_control_seen((enum situation)situation, (enum told)told, message);
            assert_made((enum situation)situation, (enum told)told, message);
        }
    }
}

/* The same word once more, after all is over, is answered and does nothing. */
void test_no_instruction_is_executed_twice_in_any_state(void)
{
    for (unsigned situation = 0; situation < (unsigned)SITUATIONS; situation++) {
        for (unsigned told = 0; told < (unsigned)TOLD; told++) {
            come((enum situation)situation);
            tell((enum told)told, IN, 8);
            rig_run_ms(10000);
            wire_keep();
            tell((enum told)told, IN, 8);
            rig_run_ms(1000);
            wire_assert_same();
        }
    }
}

/* CONTROL and FEED: MP and feed, MP alone, or nothing. */
void test_control_and_feed_in_every_state_take_what_the_table_says(void)
{
    for (unsigned situation = 0; situation < (unsigned)SITUATIONS; situation++) {
        come((enum situation)situation);
        unsigned before = rig_control(1);
        unsigned free = (unsigned)(situation == FREE || situation == FREE_BRAKES);
        unsigned alone = (unsigned)(situation == TAKEN || situation == TAKEN_BRAKES || situation == FAULT ||
                                    situation == FAULT_BRAKES);
        for (unsigned mp = 0; mp < 2; mp++) {
            struct wire_frame frame = {.bytes = {1, MODBUS_WRITE, 0, 105, 0, 3, 6, 0, (uint8_t)mp}, .length = 9};
            wire_word(&frame, OTHER_FEED >> 16U);
            wire_word(&frame, 0);
            TEST_ASSERT_EQUAL_UINT(0, wire_ask(&frame));
            TEST_ASSERT_EQUAL_UINT((free != 0 ? before : mp) & 1U, rig_control(1) & 1U);
            TEST_ASSERT_EQUAL_HEX32(free != 0 || alone != 0 ? 0 : OTHER_FEED, unit.axes[0].feed);
            unsigned err = (statuses[situation] & (unsigned)ERR);
            TEST_ASSERT_EQUAL_HEX(err, rig_status(1) & (unsigned)ERR);
        }
    }
}

/* Its own settings, those of the unit and STORE: exception 6 while the axis is taken or moves. Those of another axis
 * are taken. */
void test_settings_are_refused_in_every_state_but_a_free_stand(void)
{
    static const struct {
        uint32_t number;
        uint32_t value;
        bool other;
    } writes[] = {{134, 1, false}, {30, 10, false}, {40, 1, false}, {40, 2, false}, {234, 1, true}};
    for (unsigned situation = 0; situation < (unsigned)SITUATIONS; situation++) {
        for (unsigned i = 0; i < sizeof writes / sizeof writes[0]; i++) {
            come((enum situation)situation);
            uint32_t operations = machine.flash_operations;
            unsigned exception = wire_write(MODBUS_WRITE_ONE, writes[i].number, writes[i].value, false);
            TEST_ASSERT_EQUAL_UINT(situation == FREE || writes[i].other ? 0 : 6, exception);
            TEST_ASSERT_TRUE(exception == 0 || operations == machine.flash_operations);
        }
    }
}
