#include "gve_receiver.h"

#include <assert.h>

#include "base_tick.h"

enum receiver_state {
    STATE_OUTSIDE,  /* between CR and ! */
    STATE_INSIDE,   /* after ! */
    STATE_SKIPPING, /* the rest of a damaged line of a packet, up to CR or ! */
    STATE_THROWING, /* all, up to a silence */
};

enum {
    CHARACTER_BEGIN = '!',
    CHARACTER_END = GVE_LINE_END,
    CHARACTER_IGNORED = '\n',
    SUM_CHARACTERS = 3, /* comma and two digits */
    ADDRESS_CHARACTERS = 1,
    HEX_BITS = 4,
    NO_DIGIT = 16,
    ADDRESS_DIGIT_MAX = 7,
};

static_assert((uint32_t)GVE_LINE_CHARACTERS_MAX - (uint32_t)ADDRESS_CHARACTERS == (uint32_t)GVE_TEXT_BYTES_MAX,
              "the parser takes what a line can hold");

/* How long nothing comes before what was damaged is over, and before a command or packet under way is damaged. */
#define SILENCE_TICKS ((uint64_t)100 * TICKS_PER_MS)
#define GAP_TICKS ((uint64_t)1000 * TICKS_PER_MS)

void gve_receiver_init(struct gve_receiver *receiver, unsigned interpolator, unsigned spindle)
{
    assert(interpolator <= ADDRESS_DIGIT_MAX && spindle <= ADDRESS_DIGIT_MAX && interpolator != spindle);
    *receiver = (struct gve_receiver){
        .digits = {(uint8_t)('0' + interpolator), (uint8_t)('0' + spindle)},
        .state = STATE_OUTSIDE,
    };
}

static void begin_line(struct gve_receiver *receiver)
{
    receiver->state = STATE_INSIDE;
    receiver->address = 0;
    receiver->count = 0;
    receiver->sum = CHARACTER_BEGIN;
    receiver->too_long = false;
}

/* Damage does not concern the commands of other units while there is no sum to tell them by. */
static bool is_watched(const struct gve_receiver *receiver)
{
    return receiver->sums || receiver->address != 0 || receiver->count == 0;
}

/* A damaged line, or what stands where there is no line. In a packet what comes next is read all the same. */
static enum gve_received damage(struct gve_receiver *receiver, bool is_ours)
{
    if (receiver->packet) {
        receiver->state = STATE_SKIPPING;
        return GVE_RECEIVED_BAD_LINE;
    }
    receiver->state = STATE_THROWING;
    receiver->owes = is_ours;
    return GVE_RECEIVED_NOTHING;
}

static bool is_of_us(const struct gve_receiver *receiver)
{
    return receiver->state == STATE_INSIDE && receiver->address != 0;
}

void gve_receiver_refuse(struct gve_receiver *receiver)
{
    receiver->state = STATE_THROWING;
    receiver->owes = true;
}

static enum gve_received end_silence(struct gve_receiver *receiver)
{
    bool owes = receiver->packet || is_of_us(receiver) || (receiver->state == STATE_THROWING && receiver->owes);
    receiver->state = STATE_OUTSIDE;
    receiver->packet = false;
    return owes ? GVE_RECEIVED_DAMAGE : GVE_RECEIVED_NOTHING;
}

uint64_t gve_receiver_wake(const struct gve_receiver *receiver)
{
    if (receiver->state == STATE_THROWING) {
        return receiver->tick + SILENCE_TICKS;
    }
    return receiver->packet || receiver->state == STATE_INSIDE ? receiver->tick + GAP_TICKS : TICK_NEVER;
}

enum gve_received gve_receiver_poll(struct gve_receiver *receiver, uint64_t now_ticks)
{
    return now_ticks < gve_receiver_wake(receiver) ? GVE_RECEIVED_NOTHING : end_silence(receiver);
}

static void take_character(struct gve_receiver *receiver, uint8_t value)
{
    if (receiver->count == GVE_LINE_CHARACTERS_MAX) {
        receiver->too_long = true;
        return;
    }
    if (receiver->count == 0) {
        uint8_t spindle = value == receiver->digits[1] ? GVE_ADDRESS_SPINDLE : 0;
        receiver->address = value == receiver->digits[0] ? (uint8_t)GVE_ADDRESS_INTERPOLATOR : spindle;
    }
    receiver->line[receiver->count] = value;
    receiver->sum = (uint8_t)(receiver->sum + value);
    receiver->count++;
}

static uint32_t hex_digit(uint8_t character)
{
    if (character >= '0' && character <= '9') {
        return (uint32_t)character - '0';
    }
    uint8_t letter = character & (uint8_t)~('a' ^ 'A');
    return letter >= 'A' && letter <= 'F' ? (uint32_t)letter - 'A' + 10U : (uint32_t)NO_DIGIT;
}

/* Whether the line ends with a comma and the sum of all up to it. */
static bool has_right_sum(const struct gve_receiver *receiver)
{
    if (receiver->too_long || receiver->count < SUM_CHARACTERS) {
        return false;
    }
    const uint8_t *end = &receiver->line[receiver->count - SUM_CHARACTERS];
    uint32_t sum = (uint32_t)receiver->sum - end[1] - end[2];
    uint32_t high = hex_digit(end[1]);
    uint32_t low = hex_digit(end[2]);
    return *end == ',' && high != NO_DIGIT && low != NO_DIGIT && ((high << HEX_BITS) | low) == (sum & UINT8_MAX);
}

/* Whether the line that ends here is a command for this unit. */
static enum gve_received end_line(struct gve_receiver *receiver)
{
    if (receiver->sums && !has_right_sum(receiver)) {
        enum gve_received received = damage(receiver, is_of_us(receiver));
        receiver->state = receiver->packet ? STATE_OUTSIDE : STATE_THROWING;
        return received;
    }
    receiver->state = STATE_OUTSIDE;
    if (receiver->address == 0) {
        return GVE_RECEIVED_NOTHING;
    }
    uint8_t extra = receiver->sums ? ADDRESS_CHARACTERS + SUM_CHARACTERS : ADDRESS_CHARACTERS;
    receiver->length = (uint8_t)(receiver->count - extra);
    return GVE_RECEIVED_LINE;
}

static enum gve_received take_inside(struct gve_receiver *receiver, uint8_t value)
{
    if (value == CHARACTER_END) {
        return end_line(receiver);
    }
    if (value != CHARACTER_BEGIN) {
        take_character(receiver, value);
        return GVE_RECEIVED_NOTHING;
    }
    enum gve_received received = GVE_RECEIVED_NOTHING;
    if (is_watched(receiver)) {
        received = damage(receiver, is_of_us(receiver));
    }
    if (receiver->state != STATE_THROWING) {
        begin_line(receiver);
    }
    return received;
}

static enum gve_received take_outside(struct gve_receiver *receiver, uint8_t value)
{
    if (value == CHARACTER_BEGIN) {
        begin_line(receiver);
    } else if (receiver->sums && value != CHARACTER_END) {
        return damage(receiver, false);
    } else {
        /* nothing counts between the lines */
    }
    return GVE_RECEIVED_NOTHING;
}

static enum gve_received take_skipping(struct gve_receiver *receiver, uint8_t value)
{
    if (value == CHARACTER_BEGIN) {
        begin_line(receiver);
    } else if (value == CHARACTER_END) {
        receiver->state = STATE_OUTSIDE;
    } else {
        /* belongs to what was damaged */
    }
    return GVE_RECEIVED_NOTHING;
}

static enum gve_received take_broken(struct gve_receiver *receiver)
{
    bool hurts = (receiver->state == STATE_OUTSIDE && receiver->sums) ||
                 (receiver->state == STATE_INSIDE && is_watched(receiver));
    return hurts ? damage(receiver, is_of_us(receiver)) : GVE_RECEIVED_NOTHING;
}

static enum gve_received take_value(struct gve_receiver *receiver, uint8_t value)
{
    if (value == CHARACTER_IGNORED) {
        return GVE_RECEIVED_NOTHING;
    }
    switch ((enum receiver_state)receiver->state) {
    case STATE_OUTSIDE:
        return take_outside(receiver, value);
    case STATE_INSIDE:
        return take_inside(receiver, value);
    case STATE_SKIPPING:
        return take_skipping(receiver, value);
    case STATE_THROWING:
        break;
    }
    return GVE_RECEIVED_NOTHING;
}

enum gve_received gve_receiver_take(struct gve_receiver *receiver, const struct hal_line_byte *byte)
{
    receiver->tick = byte->tick;
    return byte->broken ? take_broken(receiver) : take_value(receiver, byte->value);
}

/* All that is more than the begin of a line is no control character either. */
static_assert((unsigned)CHARACTER_END < (unsigned)CHARACTER_BEGIN && (unsigned)CHARACTER_IGNORED < CHARACTER_BEGIN,
              "a compare tells plain characters");

/* Takes what does nothing but go on with a line of which the address is known. Returns what comes after it. */
static const uint8_t *take_plain(struct gve_receiver *receiver, const uint8_t *next, const uint8_t *end)
{
    const uint8_t *room_end = &receiver->line[GVE_LINE_CHARACTERS_MAX];
    uint8_t *place = &receiver->line[receiver->count];
    uint32_t sum = receiver->sum;
    if (receiver->state != (uint8_t)STATE_INSIDE || receiver->count == 0) {
        return next;
    }
    while (next != end && *next > (uint8_t)CHARACTER_BEGIN && place != room_end) {
        sum += *next;
        *place++ = *next++;
    }
    receiver->count = (uint8_t)(place - receiver->line);
    receiver->sum = (uint8_t)sum;
    return next;
}

enum gve_received gve_receiver_take_run(struct gve_receiver *receiver, const uint8_t **next, const uint8_t *end,
                                        uint64_t tick_ticks)
{
    enum gve_received received = GVE_RECEIVED_NOTHING;
    receiver->tick = tick_ticks;
    while (received == GVE_RECEIVED_NOTHING && *next != end) {
        *next = take_plain(receiver, *next, end);
        if (*next != end) {
            received = take_value(receiver, *(*next)++);
        }
    }
    return received;
}

const uint8_t *gve_receiver_text(const struct gve_receiver *receiver)
{
    return &receiver->line[ADDRESS_CHARACTERS];
}
