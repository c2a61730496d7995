/*
 * The RKM04 unit as the programs see it that let units run.
 */
#ifndef RKM04_KIND_H
#define RKM04_KIND_H

#include "unit_kind.h"

extern const struct unit_kind rkm04_kind;

#endif
