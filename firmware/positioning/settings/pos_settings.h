/*
 * The settings, kept without power: all of them as one text of the store, all old ones or all new ones.
 *
 * Comes in: values of registers. Goes out: the same values after a start. Main only.
 */
#ifndef POS_SETTINGS_H
#define POS_SETTINGS_H

#include <stdbool.h>

#include "../../store/store.h"
#include "../registers/pos_registers.h"

enum {
    POS_SETTINGS_SLOT = 0,
};

struct pos_settings {
    bool damaged; /* what was stored is not used, until something is stored again */
    bool other;   /* the settings in force are not those that are stored, or delivered where nothing is stored */
    struct store store;
};

/* Finds what is stored, and puts it into the registers; where nothing is, or it is damaged, the delivered settings. */
void pos_settings_init(struct pos_settings *settings, struct pos_registers *registers);

/* Stores the settings of the registers; what is stored already is not written. False: it has failed, and what was
 * stored before still is. May take seconds. */
bool pos_settings_store(struct pos_settings *settings, const struct pos_registers *registers);

/* Settings have been written: sees whether they are those that are stored. */
void pos_settings_compare(struct pos_settings *settings, const struct pos_registers *registers);

#endif
