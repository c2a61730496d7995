#include "exact_text.h"

#include <stdlib.h>
#include <string.h>

#include "unity.h"

void exact_text_take(struct exact_text *text, const void *bytes, size_t length)
{
    free(text->bytes);
    text->bytes = malloc(length > 0 ? length : 1);
    TEST_ASSERT_NOT_NULL(text->bytes);
    memcpy(text->bytes, bytes, length);
    text->length = (uint32_t)length;
}

void exact_text_free(struct exact_text *text)
{
    free(text->bytes);
    *text = (struct exact_text){.bytes = NULL};
}
