/*
 * The positioning unit as the programs see it that let units run.
 */
#ifndef POS_KIND_H
#define POS_KIND_H

#include "unit_kind.h"

extern const struct unit_kind pos_kind_of_unit;

#endif
