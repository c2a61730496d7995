#include "serve_options.h"

#include <stddef.h>
#include <string.h>

#include "line.h"
#include "serve_clock.h"

enum {
    SPEED_DECIMALS = 3,
    PORT_MAX = 65535,
};

static bool read_number(const char *value, unsigned decimals, uint64_t max, uint64_t *number)
{
    const char *at = value;
    const char *end = value + strlen(value);
    return line_read_fixed(&at, end, decimals, max, number) && at == end;
}

static bool read_port(const char *name, const char *value, uint16_t *port)
{
    uint64_t number = 0;
    if (!read_number(value, 0, PORT_MAX, &number)) {
        complain("%s %s: not a port; write 1 to 65535, or 0 for any free one", name, value);
        return false;
    }
    *port = (uint16_t)number;
    return true;
}

static bool read_tcp(struct serve_options *options, const char *value)
{
    options->tcp = true;
    return read_port("--tcp", value, &options->tcp_port);
}

static bool read_control(struct serve_options *options, const char *value)
{
    options->control = true;
    return read_port("--control", value, &options->control_port);
}

static bool read_node(struct serve_options *options, const char *value)
{
    uint64_t node = 0;
    if (!read_number(value, 0, SERVE_NODE_MAX, &node) || node == 0) {
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

static bool read_speed(struct serve_options *options, const char *value)
{
    uint64_t milli = 0;
    if (!read_number(value, SPEED_DECIMALS, SERVE_MILLI_SPEED_MAX, &milli)) {
        complain("--speed %s: write 0.001 to 1000 times real time, or 0 for as fast as possible", value);
        return false;
    }
    options->milli_speed = (uint32_t)milli;
    return true;
}

static bool read_pty(struct serve_options *options, const char *value)
{
    options->pty = value;
    return true;
}

static bool read_flash(struct serve_options *options, const char *value)
{
    options->flash = value;
    return true;
}

static bool read_address(struct serve_options *options, const char *value)
{
    options->address = value;
    return true;
}

struct option {
    const char *name;
    bool (*read)(struct serve_options *options, const char *value);
};

static bool read_pair(struct serve_options *options, const char *name, const char *value)
{
    static const struct option table[] = {
        {"--tcp", read_tcp},     {"--pty", read_pty},         {"--control", read_control}, {"--node", read_node},
        {"--flash", read_flash}, {"--address", read_address}, {"--speed", read_speed},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        if (strcmp(name, table[i].name) != 0) {
            continue;
        }
        if (value == NULL || value[0] == '\0') {
            complain("%s: its value is missing; serve --help shows it", name);
            return false;
        }
        return table[i].read(options, value);
    }
    complain("%s: no such option of serve; serve --help lists them", name);
    return false;
}

static bool read_switch(struct serve_options *options, const char *name)
{
    bool unpaced = strcmp(name, "--unpaced") == 0;
    bool json = strcmp(name, "--json") == 0;
    bool until_eof = strcmp(name, "--until-eof") == 0;
    options->unpaced = options->unpaced || unpaced;
    options->json = options->json || json;
    options->until_eof = options->until_eof || until_eof;
    return unpaced || json || until_eof;
}

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

enum exit_status serve_options_read(struct serve_options *options, int count, char *const arguments[])
{
    *options = (struct serve_options){.address = "127.0.0.1", .milli_speed = 1000, .tcp_port = SERVE_TCP_PORT};
    for (int i = 0; i < count; i++) {
        if (read_switch(options, arguments[i])) {
            continue;
        }
        if (!read_pair(options, arguments[i], i + 1 < count ? arguments[i + 1] : NULL)) {
            return EXIT_USAGE;
        }
        i++;
    }
    return is_whole(options) ? EXIT_DONE : EXIT_USAGE;
}
