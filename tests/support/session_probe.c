/*
 * A session with the unit that follows a real clock (tools/simulator/wasm/paced.h), for tests: the same lines give the
 * same answers here and in WebAssembly (wasm_session.mjs). Lines of standard input:
 *
 *     at NS           real time, from the begin on; the unit follows
 *     in INPUT LEVEL
 *     ask HEX         prints the answer in hex
 *
 * At the end it prints the unit's time and the time that it has stood, in ns.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "messages.h"
#include "paced.h"

enum {
    LINE_BYTES_MAX = 32 + 2 * MESSAGES_REQUEST_BYTES_MAX,
};

static void follow(struct paced *unit, uint64_t real_ns)
{
    while (paced_follow(unit, real_ns)) {
    }
}

static void ask(struct paced *unit, const char *hex)
{
    uint32_t length = 0;
    unsigned byte = 0;
    for (; sscanf(hex, "%2x", &byte) == 1; hex += 2) {
        paced_request(unit)[length++] = (uint8_t)byte;
    }
    length = paced_message(unit, length);
    for (uint32_t i = 0; i < length; i++) {
        (void)printf("%02x", paced_answer(unit)[i]);
    }
    (void)printf("\n");
}

static void obey(struct paced *unit, const char *line)
{
    unsigned input = 0;
    unsigned level = 0;
    if (strncmp(line, "at ", 3) == 0) {
        follow(unit, strtoull(line + 3, NULL, 10));
    } else if (sscanf(line, "in %u %u", &input, &level) == 2) {
        paced_set_input(unit, input, level != 0);
    } else if (strncmp(line, "ask ", 4) == 0) {
        ask(unit, line + 4);
    }
}

int main(void)
{
    static char line[LINE_BYTES_MAX];
    struct paced *unit = paced_begin(0);
    if (unit == NULL) {
        return EXIT_FAILURE;
    }
    while (fgets(line, (int)sizeof line, stdin) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        obey(unit, line);
    }
    (void)printf("%" PRIu64 " %" PRIu64 "\n", paced_now_ns(unit), paced_stood_ns(unit));
    return EXIT_SUCCESS;
}
