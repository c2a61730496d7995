/*
 * The whole unit: bytes and input edges in, the judge on the pulses. Every good frame has one answer, which an
 * independent reader finds whole, a broadcast has none, a repeat is not executed again, and noise is never answered
 * unless the receiver has found a good frame in it. Time, flash faults and restarts come in between. A run begins with
 * an open session; after a restart every request but Version is refused until there is one.
 *
 * Input: a head (low 2 bits: epoch; bit 7: the run is made once more at another epoch and must be the same but for the
 * shift) | operations, a byte each with its operands after:
 *   low 3 bits 0, 1  a request to this unit: the message up to a 0; the frame and its FCS are made here
 *   2  a broadcast likewise       3  the last frame once more, with one bit flipped if there is one (5 high bits)
 *   4  noise: bytes up to a 0     5  an input edge: high bits are input and level, at the next time
 *   6  time: one byte, squared, in units of 20 us        7  a flash fault, a power cut, or off and on
 */
#include <string.h>

#include "base_tick.h"
#include "frames.h"
#include "fuzz_commands.h"
#include "fuzz_host.h"
#include "fuzz_stream.h"
#include "fuzz_unit_bench.h"

enum {
    OPERATIONS_MAX = 64,
    NODE = 1,
    MESSAGE_MAX = 600,
    FRAME_MAX = FRAME_BYTES_MAX(MESSAGE_MAX),
    BYTE_TICKS = 800,
    TIME_UNIT_US = 20,
    WAIT_MS_MAX = 200,
};

struct talk {
    struct fuzz_unit *fuzz;
    uint8_t frame[FRAME_MAX];
    uint32_t frame_length;
    uint8_t number;
    bool broadcast; /* the last frame was one */
    bool opens;     /* its message was Version */
    bool open;      /* a session is */
    bool answered;  /* the last frame was a request and has been answered, and nothing came since */
    struct host_line_byte script[FRAME_MAX];
    uint8_t content[FUZZ_SENT_MAX];
};

static struct talk talk;

/* The bytes come in one after the other. */
static void hear(struct talk *t, const uint8_t *bytes, uint32_t length)
{
    struct host_machine *machine = &t->fuzz->machine;
    for (uint32_t i = 0; i < length; i++) {
        t->script[i] = (struct host_line_byte){.tick = machine->now + (i + 1U) * BYTE_TICKS, .value = bytes[i]};
    }
    t->fuzz->sent_count = 0;
    host_machine_set_line(machine, t->script, length);
    fuzz_unit_run(t->fuzz, (uint64_t)(length + 1U) * BYTE_TICKS);
}

/* Waits for what the unit has to say. False: the run is over before. */
static bool wait_for_silence(struct talk *t)
{
    struct fuzz_unit *fuzz = t->fuzz;
    fuzz_unit_run(fuzz, 2U * TICKS_PER_MS);
    for (unsigned i = 0; i < WAIT_MS_MAX && fuzz->machine.line.to_send_count != 0; i++) {
        fuzz_unit_run(fuzz, TICKS_PER_MS);
    }
    return !fuzz_unit_is_over(fuzz);
}

/* One whole frame with the number of the request, from this unit. */
static void check_answer(struct talk *t)
{
    struct fuzz_unit *fuzz = t->fuzz;
    uint32_t length = frame_read(t->content, fuzz->sent, fuzz->sent_count);
    FUZZ_REQUIRE(fuzz->machine.line.to_send_count == 0);
    judge_exchange(&fuzz->judge, t->broadcast ? 0 : 1, fuzz->sent_count != 0 ? 1 : 0);
    if (!t->broadcast) {
        uint8_t address = NODE | LINK_ADDRESS_ANSWER | (t->open ? 0U : LINK_ADDRESS_REFUSED);
        FUZZ_REQUIRE(length >= 3 && (t->open || length == 3));
        FUZZ_REQUIRE(t->content[0] == address && t->content[1] == t->number);
    }
}

/* Only Set Command changes it. */
static uint32_t commands_taken(const struct fuzz_unit *fuzz)
{
    uint32_t sum = 0;
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        sum += fuzz->unit.interpreter[i].memory.written;
    }
    return sum;
}

static void do_frame(struct talk *t, bool repeated)
{
    const struct link *link = &t->fuzz->unit.line.link;
    uint32_t repeats = link->receiver.counts[LINK_COUNT_REPEATS];
    bool known = repeated && t->answered && !t->broadcast;
    uint32_t taken = commands_taken(t->fuzz);
    t->open = t->open || (!t->broadcast && t->opens);
    hear(t, t->frame, t->frame_length);
    if (wait_for_silence(t)) {
        check_answer(t);
        FUZZ_REQUIRE(link->receiver.counts[LINK_COUNT_REPEATS] - repeats == (known ? 1U : 0U) || !known);
        FUZZ_REQUIRE(t->open || t->broadcast || commands_taken(t->fuzz) == taken);
        t->answered = !t->broadcast && t->open;
    }
}

static void do_request(struct talk *t, const uint8_t *message, uint32_t length, bool broadcast)
{
    t->number = (uint8_t)(t->number == UINT8_MAX ? 1 : t->number + 1U);
    t->broadcast = broadcast;
    t->opens = message[0] == MESSAGES_VERSION;
    t->frame_length = frame_write(t->frame, broadcast ? 0 : NODE, t->number, message, length);
    do_frame(t, false);
}

static void do_message(struct talk *t, struct fuzz_stream *stream, bool broadcast)
{
    size_t length = 0;
    const uint8_t *message = fuzz_take_text(stream, &length);
    if (length != 0 && length <= MESSAGE_MAX) {
        do_request(t, message, (uint32_t)length, broadcast);
    }
}

/* Something that is no frame of ours, or only by chance. */
static void do_noise(struct talk *t, const uint8_t *bytes, uint32_t length)
{
    const uint32_t *counts = t->fuzz->unit.line.link.receiver.counts;
    uint32_t frames = counts[LINK_COUNT_FRAMES];
    hear(t, bytes, length);
    t->answered = false;
    bool over = !wait_for_silence(t);
    t->open = t->fuzz->unit.line.link.open; /* a frame in it may have been Version */
    if (!over) {
        FUZZ_REQUIRE(t->fuzz->sent_count == 0 || counts[LINK_COUNT_FRAMES] != frames);
    }
}

static void do_again(struct talk *t, unsigned place)
{
    if (t->frame_length == 0) {
        return;
    }
    if (place == 0) {
        do_frame(t, true);
        return;
    }
    uint8_t frame[FRAME_MAX];
    unsigned bit = place * 7919U % (t->frame_length * 8U);
    memcpy(frame, t->frame, t->frame_length);
    frame[bit / 8U] ^= (uint8_t)(1U << bit % 8U);
    do_noise(t, frame, t->frame_length);
}

static void take_noise(struct talk *t, struct fuzz_stream *stream)
{
    size_t length = 0;
    const uint8_t *bytes = fuzz_take_text(stream, &length);
    if (length > 0 && length <= FRAME_MAX) {
        do_noise(t, bytes, (uint32_t)length);
    }
}

static void do_trouble(struct talk *t, unsigned operand)
{
    if (!fuzz_order_flash_fault(&t->fuzz->machine, operand)) {
        fuzz_unit_restart(t->fuzz);
        t->open = false;
        t->answered = false;
    }
}

static void do_operation(struct talk *t, struct fuzz_stream *stream)
{
    uint8_t operation = fuzz_take_byte(stream);
    unsigned operand = operation / 8U;
    switch (operation % 8U) {
    case 0:
    case 1:
        do_message(t, stream, false);
        break;
    case 2:
        do_message(t, stream, true);
        break;
    case 3:
        do_again(t, operand);
        break;
    case 4:
        take_noise(t, stream);
        break;
    case 5:
        host_machine_set_input(&t->fuzz->machine, 1U + operand % 8U, operand / 8U % 2U != 0);
        break;
    case 6: {
        uint64_t time = fuzz_take_byte(stream);
        fuzz_unit_run(t->fuzz, time * time * TIME_UNIT_US * TICKS_PER_US);
        break;
    }
    default:
        do_trouble(t, operand);
        break;
    }
}

static uint64_t run_once(struct fuzz_stream stream, unsigned epoch)
{
    const uint8_t opening = MESSAGES_VERSION;
    talk.fuzz = fuzz_unit_begin(epoch);
    talk.frame_length = 0;
    talk.number = 0;
    talk.answered = false;
    talk.open = false;
    do_request(&talk, &opening, sizeof opening, false);
    for (unsigned i = 0; i < OPERATIONS_MAX && !fuzz_stream_is_over(&stream) && !fuzz_unit_is_over(talk.fuzz); i++) {
        do_operation(&talk, &stream);
    }
    fuzz_unit_end(talk.fuzz);
    return judge_digest(&talk.fuzz->judge);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_run_at_epochs(data, size, run_once);
}

/* The beginning of a request of some kind, or a command somewhere. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    size = LLVMFuzzerMutate(data, size, max_size);
    if (seed % 4U == 0) {
        const uint8_t begin[] = {0, (uint8_t)((seed >> 20U) % 3U), (uint8_t)(1U + (seed >> 16U) % 8U),
                                 (uint8_t)('0' + (seed >> 12U) % 5U)};
        return fuzz_insert(data, size, max_size, 1, seed / 4U, begin, sizeof begin);
    }
    return seed % 4U == 1 ? size : fuzz_insert_command(data, size, max_size, 1, seed / 4U);
}
