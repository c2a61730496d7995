#include "gve_answer.h"

#include <assert.h>

#include "base_text.h"

enum {
    SUM_DIGITS = 2,
};

void gve_answer_init(struct gve_answer *answer)
{
    *answer = (struct gve_answer){.unsent = 0};
}

static void put_sum(struct text *text)
{
    uint32_t sum = 0;
    text_put_byte(text, ',');
    for (uint32_t i = 0; i < text->length; i++) {
        sum += text->bytes[i];
    }
    text_put_hex(text, sum, SUM_DIGITS);
}

void gve_answer_make(struct gve_answer *answer, unsigned digit, const uint8_t *values, uint32_t length, bool sum,
                     bool apart)
{
    struct gve_answer_bytes *made = apart ? &answer->apart : &answer->last;
    struct text text;
    assert(answer->unsent == 0 && length <= GVE_ANSWER_VALUES_MAX);
    text_init(&text, made->bytes, sizeof made->bytes);
    text_put_hex(&text, digit, 1);
    if (length != 0) {
        text_put_byte(&text, ',');
    }
    for (uint32_t i = 0; i < length; i++) {
        text_put_byte(&text, values[i]);
    }
    if (sum) {
        put_sum(&text);
    }
    text_put_byte(&text, '\r');
    made->length = (uint8_t)text.length;
    answer->is_apart = apart;
    answer->unsent = made->length;
}

bool gve_answer_again(struct gve_answer *answer)
{
    assert(answer->unsent == 0);
    answer->is_apart = false;
    answer->unsent = answer->last.length;
    return answer->unsent != 0;
}

bool gve_answer_is_sending(const struct gve_answer *answer)
{
    return answer->unsent != 0;
}

uint8_t gve_answer_byte(const struct gve_answer *answer)
{
    const struct gve_answer_bytes *made = answer->is_apart ? &answer->apart : &answer->last;
    assert(answer->unsent != 0);
    return made->bytes[made->length - answer->unsent];
}

void gve_answer_advance(struct gve_answer *answer)
{
    assert(answer->unsent != 0);
    answer->unsent--;
}
