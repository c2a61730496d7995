#include "line_bench.h"

#include <string.h>

#include "unity.h"

/* The longest answer, all of it escaped. */
enum {
    ANSWER_MS_MAX = 10000
};

/* The bench is the context of all its listeners. */
static struct line_bench *listening;

static void on_line(void *context, uint64_t tick, uint8_t value)
{
    struct line_bench *line = listening;
    (void)context;
    TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(LINE_BENCH_SENT_MAX, line->sent_count, "too many bytes for the bench");
    line->sent[line->sent_count] = (struct host_line_byte){.tick = tick, .value = value};
    line->sent_count++;
}

void line_init(struct line_bench *line, struct bench *bench)
{
    memset(line, 0, sizeof *line);
    line->bench = bench;
    bench->machine.listener.line = on_line;
    listening = line;
}

uint64_t line_plan(struct line_bench *line, const uint8_t *bytes, uint32_t length)
{
    struct host_line *host = &line->bench->machine.line;
    uint64_t tick = bench_now(line->bench);
    if (host->script_next < host->script_length) {
        tick = line->script[line->script_length - 1].tick;
    } else {
        line->script_length = 0;
    }
    bool first = line->script_length == 0;
    for (uint32_t i = 0; i < length; i++) {
        TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(LINE_BENCH_SCRIPT_MAX, line->script_length, "too much for the bench");
        tick += LINE_BENCH_BYTE_TICKS;
        line->script[line->script_length++] = (struct host_line_byte){.tick = tick, .value = bytes[i]};
    }
    if (first) {
        host_machine_set_line(&line->bench->machine, line->script, line->script_length);
    } else {
        host->script_length = line->script_length;
    }
    return tick;
}

uint64_t line_plan_frame(struct line_bench *line, uint8_t address, uint8_t number, const void *text, uint32_t length)
{
    line->asked = *(const uint8_t *)text;
    return line_plan(line, line->frame, frame_write(line->frame, address, number, text, length));
}

void line_run(struct line_bench *line)
{
    bench_run_ticks(line->bench, line->script[line->script_length - 1].tick + 1 - bench_now(line->bench));
}

uint64_t line_request(struct line_bench *line, uint8_t address, uint8_t number, uint8_t message, const char *text)
{
    uint8_t bytes[MESSAGES_REQUEST_BYTES_MAX] = {message};
    size_t length = strlen(text);
    TEST_ASSERT_LESS_THAN_size_t(sizeof bytes, length);
    memcpy(bytes + 1, text, length);
    uint64_t end = line_plan_frame(line, address, number, bytes, (uint32_t)length + 1U);
    line_run(line);
    return end;
}

void line_drain(struct line_bench *line)
{
    for (uint32_t ms = 0; line->bench->machine.line.to_send_count != 0; ms++) {
        TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(ANSWER_MS_MAX, ms, "an answer does not end");
        bench_run_ms(line->bench, 1);
    }
}

const char *line_answer(struct line_bench *line, uint8_t number)
{
    bench_run_ms(line->bench, 20);
    line_drain(line);
    uint32_t length = line->sent_count - line->read_count;
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(LINE_BENCH_FRAME_MAX, length);
    if (length == 0) {
        return NULL;
    }
    for (uint32_t i = 0; i < length; i++) {
        line->frame[i] = line->sent[line->read_count + i].value;
    }
    line->read_count = line->sent_count;
    length = frame_read(line->content, line->frame, length);
    TEST_ASSERT_GREATER_THAN_UINT32_MESSAGE(2, length, "what was sent is not one frame");
    TEST_ASSERT_EQUAL_HEX8(0x80 | line->bench->machine.line.node, line->content[0]);
    TEST_ASSERT_EQUAL_UINT8(number, line->content[1]);
    TEST_ASSERT_EQUAL_UINT8(line->asked, line->content[2]);
    line->content[length] = '\0';
    return (const char *)line->content + 3;
}

void line_open(struct line_bench *line)
{
    line_check(line);
    line->sent_count = 0;
    line->read_count = 0;
}

void line_check(struct line_bench *line)
{
    line_request(line, LINE_BENCH_NODE, 99, MESSAGES_VERSION, "");
    TEST_ASSERT_EQUAL_STRING("\x10" RKM04_VERSION, line_answer(line, 99));
}

/* xorshift64* */
uint8_t line_random_byte(void)
{
    static uint64_t state = UINT64_C(20261121);
    state ^= state >> 12U;
    state ^= state << 25U;
    state ^= state >> 27U;
    return (uint8_t)((state * UINT64_C(0x2545F4914F6CDD1D)) >> 56U);
}
