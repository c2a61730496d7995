#include "pins.h"

#include <stdio.h>
#include <string.h>

#include "complain.h"
#include "infile.h"
#include "line.h"

enum {
    WORD_BYTES_MAX = 32
};

struct group {
    const char *before; /* of the names, before and after the number */
    const char *after;
    unsigned first;  /* enum signal */
    unsigned length; /* 0: one without a number */
    unsigned first_number;
};

static const struct group groups[] = {
    {"m", "_step", SIGNAL_STEP, PINS_MOTORS, 1},
    {"m", "_dir", SIGNAL_DIRECTION, PINS_MOTORS, 1},
    {"m", "_led", SIGNAL_LED, PINS_MOTORS, 1},
    {"bi", "", SIGNAL_INPUT, PINS_INPUTS, 1},
    {"bo", "", SIGNAL_OUTPUT, PINS_OUTPUTS, 1},
    {"de", "", SIGNAL_DRIVER, 0, 0},
    {"m", "_en", SIGNAL_ENABLE, PINS_MOTORS, 1},
    {"s1_", "", SIGNAL_SWITCH, PINS_SWITCHES, 1},
    {"led", "", SIGNAL_MORE_LED, PINS_MORE_LEDS, PINS_MORE_LEDS_FIRST},
    {"pwm", "", SIGNAL_PWM, 0, 0},
};

static const char *const usarts[] = {"USART1", "USART2", "USART3"};

/* Whether a name is one of a group; then `signal` is its number. */
static bool find_in_group(const struct group *group, const char *name, unsigned *signal)
{
    size_t length = strlen(group->before);
    if (strncmp(name, group->before, length) != 0) {
        return false;
    }
    name += length;
    *signal = group->first;
    if (group->length > 0) {
        int first = '0' + (int)group->first_number;
        if (*name < first || *name >= first + (int)group->length) {
            return false;
        }
        *signal += (unsigned)(*name - first);
        name++;
    }
    return strcmp(name, group->after) == 0;
}

static unsigned find_signal(const char *name)
{
    unsigned signal = SIGNAL_NONE;
    for (unsigned i = 0; i < sizeof groups / sizeof *groups; i++) {
        if (find_in_group(&groups[i], name, &signal)) {
            return signal;
        }
    }
    return SIGNAL_NONE;
}

bool pins_read_name(const char *text, struct pin *pin)
{
    uint64_t number = 0;
    const char *end = text + strlen(text);
    if (text[0] != 'P' || text[1] < 'A' || text[1] >= 'A' + GPIO_PORTS) {
        return false;
    }
    *pin = (struct pin){.port = (uint8_t)(text[1] - 'A')};
    text += 2;
    bool good = line_read_fixed(&text, end, 0, GPIO_PINS - 1, &number) && text == end;
    pin->number = (uint8_t)number;
    return good;
}

/* Null, or what is wrong with the USART of the line. */
static const char *take_usart(struct pins *pins, const char *place)
{
    for (unsigned usart = 0; usart < sizeof usarts / sizeof *usarts; usart++) {
        if (strcmp(place, usarts[usart]) == 0) {
            pins->usart = usart;
            return NULL;
        }
    }
    return "the line must be on USART1, USART2 or USART3";
}

/* Null, or what is wrong with a line of up to three words. */
static const char *take_line(struct pins *pins, const char *name, const char *place, const char *polarity)
{
    if (strcmp(name, "line") == 0) {
        return take_usart(pins, place);
    }
    unsigned signal = find_signal(name);
    if (signal == SIGNAL_NONE) {
        return "no such signal; m1_step, m1_dir, m1_led, m1_en, led5, bi1, bo1, pwm, de, s1_1 and line are known";
    }
    struct pin pin;
    if (!pins_read_name(place, &pin)) {
        return "no such pin; PA0 to PI15 are known";
    }
    if (polarity[0] != '\0' && strcmp(polarity, "low") != 0) {
        return "behind the pin there may be `low` only";
    }
    if (pins_is_connected(pins, signal) || pins->signal[pin.port][pin.number] != SIGNAL_NONE) {
        return "the signal or the pin is in use already";
    }
    pins->pin[signal] = pin;
    pins->low[signal] = polarity[0] != '\0';
    pins->signal[pin.port][pin.number] = (uint8_t)signal;
    return NULL;
}

static const char *read_line(struct pins *pins, char *line)
{
    char word[4][WORD_BYTES_MAX] = {""};
    char *comment = strchr(line, '#');
    if (comment != NULL) {
        *comment = '\0';
    }
    int words = sscanf(line, "%31s %31s %31s %31s", word[0], word[1], word[2], word[3]);
    if (words <= 0) {
        return NULL;
    }
    return words == 1 || words == 4 ? "a line is SIGNAL PIN, or SIGNAL PIN low"
                                    : take_line(pins, word[0], word[1], word[2]);
}

static void clear(struct pins *pins)
{
    memset(pins->signal, SIGNAL_NONE, sizeof pins->signal);
    for (unsigned i = 0; i < SIGNALS; i++) {
        pins->pin[i] = (struct pin){.port = GPIO_PORTS};
        pins->low[i] = false;
    }
    pins->usart = 0;
}

bool pins_read(struct pins *pins, const char *path)
{
    struct infile file;
    clear(pins);
    if (path == NULL) {
        return true;
    }
    if (!infile_read(&file, path)) {
        return false;
    }
    const char *wrong = NULL;
    for (char *line = strtok((char *)file.bytes, "\n"); line != NULL && wrong == NULL; line = strtok(NULL, "\n")) {
        wrong = read_line(pins, line);
        if (wrong != NULL) {
            complain("%s: `%s`: %s", path, line, wrong);
        }
    }
    infile_discard(&file);
    return wrong == NULL;
}
