#include "link_sender.h"

#include "link_fcs.h"
#include "link_frame.h"

/* The places of a frame; message and FCS lie between. */
enum {
    PLACE_OPENING,
    PLACE_ADDRESS,
    PLACE_NUMBER,
    PLACE_MESSAGE,
};

static uint32_t fcs_place(const struct link_sender *sender)
{
    return PLACE_MESSAGE + sender->length;
}

static uint32_t closing_place(const struct link_sender *sender)
{
    return fcs_place(sender) + LINK_FCS_BYTES;
}

void link_sender_init(struct link_sender *sender)
{
    *sender = (struct link_sender){.place = PLACE_MESSAGE + LINK_FCS_BYTES + 1U};
}

void link_sender_start(struct link_sender *sender, uint8_t address, uint8_t number, const uint8_t *message,
                       uint32_t length)
{
    *sender = (struct link_sender){
        .message = message,
        .length = length,
        .fcs = LINK_FCS_START,
        .address = address,
        .number = number,
    };
}

bool link_sender_is_done(const struct link_sender *sender)
{
    return sender->place > closing_place(sender);
}

static bool is_at_flag(const struct link_sender *sender)
{
    return sender->place == PLACE_OPENING || sender->place == closing_place(sender);
}

/* The byte at `place`, between the flags, before escaping. */
static uint8_t plain_byte(const struct link_sender *sender)
{
    uint32_t place = sender->place;
    if (place == PLACE_ADDRESS) {
        return sender->address;
    }
    if (place == PLACE_NUMBER) {
        return sender->number;
    }
    if (place < fcs_place(sender)) {
        return sender->message[place - PLACE_MESSAGE];
    }
    unsigned inverted = ~(unsigned)sender->fcs;
    return (uint8_t)(place == fcs_place(sender) ? inverted : inverted >> 8U);
}

static bool is_special(uint8_t plain)
{
    return plain == LINK_FLAG || plain == LINK_ESCAPE;
}

uint8_t link_sender_byte(const struct link_sender *sender)
{
    if (is_at_flag(sender)) {
        return LINK_FLAG;
    }
    uint8_t plain = plain_byte(sender);
    if (!is_special(plain)) {
        return plain;
    }
    return sender->escaped ? plain ^ LINK_ESCAPED : LINK_ESCAPE;
}

void link_sender_advance(struct link_sender *sender)
{
    if (!is_at_flag(sender)) {
        uint8_t plain = plain_byte(sender);
        if (is_special(plain) && !sender->escaped) {
            sender->escaped = true;
            return;
        }
        if (sender->place < fcs_place(sender)) {
            sender->fcs = link_fcs_append(sender->fcs, plain);
        }
    }
    sender->escaped = false;
    sender->place++;
}
