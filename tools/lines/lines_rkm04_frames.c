#include "lines_rkm04_frames.h"

#include <stdlib.h>

#include "link_sender.h"
#include "master_ear.h"

struct lines_rkm04_ear {
    struct master_ear ear;
    bool completed; /* by the last byte */
};

uint32_t lines_rkm04_frame_bytes_max(uint32_t message_length)
{
    return 2 * (LINK_HEAD_BYTES + message_length + LINK_FCS_BYTES) + 2;
}

uint32_t lines_rkm04_frame_write(uint8_t *frame, uint8_t address, uint8_t number, const uint8_t *message,
                                 uint32_t length)
{
    struct link_sender sender;
    uint32_t bytes = 0;
    for (link_sender_start(&sender, address, number, message, length); !link_sender_is_done(&sender);
         link_sender_advance(&sender)) {
        frame[bytes++] = link_sender_byte(&sender);
    }
    return bytes;
}

struct lines_rkm04_ear *lines_rkm04_ear_begin(void)
{
    struct lines_rkm04_ear *ear = calloc(1, sizeof *ear);
    if (ear != NULL) {
        master_ear_init(&ear->ear);
    }
    return ear;
}

void lines_rkm04_ear_end(struct lines_rkm04_ear *ear)
{
    free(ear);
}

uint32_t lines_rkm04_ear_take(struct lines_rkm04_ear *ear, const uint8_t *bytes, uint32_t length)
{
    uint32_t taken = 0;
    ear->completed = false;
    while (taken < length && !ear->completed) {
        ear->completed = master_ear_take(&ear->ear, bytes[taken++]);
    }
    return taken;
}

const uint8_t *lines_rkm04_ear_content(const struct lines_rkm04_ear *ear)
{
    return ear->ear.content;
}

uint32_t lines_rkm04_ear_length(const struct lines_rkm04_ear *ear)
{
    return ear->completed ? LINK_HEAD_BYTES + ear->ear.length : 0;
}

bool lines_rkm04_ear_is_damaged(const struct lines_rkm04_ear *ear)
{
    return master_ear_is_damaged(&ear->ear);
}
