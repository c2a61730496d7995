/*
 * What the files of the unit share: gve134.c (main and interrupts), gve134_execute.c (commands), gve134_packet.c
 * (packets). Main only.
 */
#ifndef GVE134_PRIVATE_H
#define GVE134_PRIVATE_H

#include "base_text.h"
#include "gve134.h"

/* What is to be answered. */
struct gve134_reply {
    enum gve_code code;
    struct text values;
    uint8_t bytes[GVE_ANSWER_VALUES_MAX];
    bool later;   /* no answer in this pass */
    bool changes; /* after the answer gve134_change is to be called: with many vectors it takes as long as an answer may
                   */
};

/* No motion is made after a fault, or without the crystal. */
bool gve134_is_locked(const struct gve134 *unit);

/* INTA as answers tell it. */
bool gve134_inta(const struct gve134 *unit);

/* Polarities and coupling as the EEPROM has them. While the axes stand. */
void gve134_apply_memory(struct gve134 *unit);

/* J: pulses end, outputs are off. */
void gve134_abort(struct gve134 *unit);

/* Executes a command that has come whole and is not of a packet. */
void gve134_execute(struct gve134 *unit, const struct gve_request *request, struct gve134_reply *reply);

/* Executes an X command that has been answered. */
void gve134_change(struct gve134 *unit, const struct gve_command *command);

/* Whether a parameter of an axis that is coupled makes a command wrong. */
bool gve134_is_coupled_out(const struct gve134 *unit, const struct gve_command *command);

/* A vector without pulses takes no place. */
static inline bool gve134_has_pulses(const int32_t steps[PATH_AXES])
{
    return steps[0] != 0 || steps[1] != 0 || steps[2] != 0 || steps[3] != 0;
}

/* Takes a request that belongs to a packet, or ends it. */
void gve134_take_packet(struct gve134 *unit, const struct gve_request *request, struct gve134_reply *reply);

/* The vectors of a packet that has been answered with 0 become visible. */
void gve134_enter_packet(struct gve134 *unit);

#endif
