#include "serve_options.h"

#include <stddef.h>
#include <string.h>

#include "arguments.h"
#include "serve_clock.h"
#include "serve_noise.h"

enum {
    SPEED_DECIMALS = 3,
    PORT_MAX = 65535,
    SEED_MAX = 1000000000,
};

static bool read_port(const char *name, const char *value, uint16_t *port)
{
    uint64_t number = 0;
    if (!arguments_read_number(value, (struct argument_number){.most = PORT_MAX}, &number)) {
        complain("%s %s: not a port; write 1 to 65535, or 0 for any free one", name, value);
        return false;
    }
    *port = (uint16_t)number;
    return true;
}

static bool read_tcp(void *target, const char *value)
{
    struct serve_options *options = target;
    options->tcp = true;
    return read_port("--tcp", value, &options->tcp_port);
}

static bool read_control(void *target, const char *value)
{
    struct serve_options *options = target;
    options->control = true;
    return read_port("--control", value, &options->control_port);
}

bool serve_options_read_node(void *target, const char *value)
{
    struct serve_options *options = target;
    uint64_t node = 0;
    if (!arguments_read_number(value, (struct argument_number){.least = 1, .most = SERVE_NODE_MAX}, &node)) {
        complain("--node %s: not an address; write 1 to 16", value);
        return false;
    }
    if (memchr(options->nodes, (int)node, options->units) != NULL) {
        complain("--node %s: there is a unit %s already; give each unit an address of its own", value, value);
        return false;
    }
    options->nodes[options->units++] = (uint8_t)node;
    return true;
}

static bool read_speed(void *target, const char *value)
{
    struct serve_options *options = target;
    const struct argument_number range = {.decimals = SPEED_DECIMALS, .most = SERVE_MILLI_SPEED_MAX};
    uint64_t milli = 0;
    if (!arguments_read_number(value, range, &milli)) {
        complain("--speed %s: write 0.001 to 1000 times real time, or 0 for as fast as possible", value);
        return false;
    }
    options->milli_speed = (uint32_t)milli;
    return true;
}

#define NUMBER_ROW(option, member, limit)                                                                              \
    {.name = (option),                                                                                                 \
     .kind = ARGUMENT_NUMBER,                                                                                          \
     .offset = offsetof(struct serve_options, member),                                                                 \
     .number = {.most = (limit), .factor = 1}}

static const struct argument common_rows[] = {
    ARGUMENT_TEXT_ROW(serve_options, "--pty", pty),
    ARGUMENT_TEXT_ROW(serve_options, "--flash", flash),
    ARGUMENT_TEXT_ROW(serve_options, "--address", address),
    ARGUMENT_FLAG_ROW(serve_options, "--unpaced", unpaced),
    ARGUMENT_FLAG_ROW(serve_options, "--json", json),
    ARGUMENT_FLAG_ROW(serve_options, "--until-eof", until_eof),
    NUMBER_ROW("--noise", noise, SERVE_NOISE_PER_MAX),
    NUMBER_ROW("--loss", loss, SERVE_NOISE_PER_MAX),
    NUMBER_ROW("--seed", seed, SEED_MAX),
    ARGUMENT_OTHER_ROW("--tcp", read_tcp),
    ARGUMENT_OTHER_ROW("--control", read_control),
    ARGUMENT_OTHER_ROW("--speed", read_speed),
};

static bool is_whole(struct serve_options *options)
{
    if (options->pty != NULL && options->tcp) {
        complain("--pty and --tcp exclude each other; name one of them");
        return false;
    }
    if (options->units == 0) {
        options->nodes[options->units++] = 1;
    }
    return true;
}

enum exit_status serve_options_read(struct serve_options *options, const struct argument *own, int count,
                                    char *const arguments[])
{
    struct argument rows[sizeof common_rows / sizeof common_rows[0] + 1U];
    memcpy(rows, common_rows, sizeof common_rows);
    rows[sizeof common_rows / sizeof common_rows[0]] = *own;
    const struct argument_table table = {
        .rows = rows,
        .count = sizeof rows / sizeof rows[0],
        .unknown = "no such option of serve; serve --help lists them",
        .missing = "its value is missing; serve --help shows it",
    };
    *options = (struct serve_options){.address = "127.0.0.1", .milli_speed = 1000, .tcp_port = SERVE_TCP_PORT};
    if (arguments_read(&table, options, count, arguments) != EXIT_DONE) {
        return EXIT_USAGE;
    }
    return is_whole(options) ? EXIT_DONE : EXIT_USAGE;
}
