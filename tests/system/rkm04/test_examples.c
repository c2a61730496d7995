/* The programs of the manual under the judge, which knows each of their orders: every pulse stands within a tick of its
 * time, whatever the inputs do. What they do as programs is for tests/programs to say. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "unity.h"

enum {
    PATH_BYTES = 512,
    LINE_BYTES = 256,
    RUN_MS = 30000
};

static struct bench bench;

void setUp(void)
{
    bench_init(&bench);
}

void tearDown(void)
{
    bench_check(&bench);
}

static FILE *open_example(const char *name, const char *extension)
{
    char path[PATH_BYTES];
    (void)snprintf(path, sizeof path, "%s/%s.%s", RKM04_EXAMPLES, name, extension);
    FILE *file = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    return file;
}

static void send_program(const char *name)
{
    static char text[BENCH_TEXT_BYTES_MAX + 1];
    FILE *file = open_example(name, "rks");
    text[fread(text, 1, BENCH_TEXT_BYTES_MAX, file)] = '\0';
    (void)fclose(file);
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, text));
}

/* Lines ms,input,level; others are comments. */
static void plan_inputs(const char *name)
{
    char line[LINE_BYTES];
    FILE *file = open_example(name, "csv");
    while (fgets(line, sizeof line, file) != NULL) {
        char *end = NULL;
        double ms = strtod(line, &end);
        if (end != line) {
            uint8_t input = (uint8_t)strtoul(end + 1, &end, 10);
            bench_plan_input(&bench, (uint64_t)llround(ms * TICKS_PER_MS), input, strtoul(end + 1, NULL, 10) != 0);
        }
    }
    (void)fclose(file);
}

TEST_CASE("1-three-moves")
TEST_CASE("2-back-and-forth")
TEST_CASE("3-branch")
TEST_CASE("4-loop")
TEST_CASE("5-wait-for-inputs")
TEST_CASE("6-guards")
TEST_CASE("7-total-stop")
TEST_CASE("8-subroutine")
TEST_CASE("9-compound")
TEST_CASE("fragment-4.6-loop")
TEST_CASE("fragment-7-guarded-run")
TEST_CASE("fragment-7-limit-backward")
TEST_CASE("fragment-7-limit-forward")
TEST_CASE("fragment-7-total-stop")
void test_an_example_with_quiet_inputs_is_lawful(const char *name)
{
    send_program(name);
    bench_run_ms(&bench, RUN_MS);
    TEST_ASSERT_GREATER_THAN_UINT32(100, bench_pulses(&bench, 1));
}

TEST_CASE("3-branch", "3-branch")
TEST_CASE("5-wait-for-inputs", "5-wait-for-inputs")
TEST_CASE("6-guards", "6-guards")
TEST_CASE("6-guards", "6-guards-quiet")
TEST_CASE("7-total-stop", "7-total-stop")
TEST_CASE("fragment-7-guarded-run", "fragment-7-guarded-run")
TEST_CASE("fragment-7-hold", "fragment-7-hold")
TEST_CASE("fragment-7-limit-backward", "fragment-7-limit-backward")
TEST_CASE("fragment-7-limit-forward", "fragment-7-limit-forward")
TEST_CASE("fragment-7-total-stop", "fragment-7-total-stop")
void test_an_example_with_its_inputs_is_lawful(const char *name, const char *inputs)
{
    plan_inputs(inputs);
    send_program(name);
    bench_run_ms(&bench, RUN_MS);
    TEST_ASSERT_GREATER_THAN_UINT32(100, bench_pulses(&bench, 1));
}
