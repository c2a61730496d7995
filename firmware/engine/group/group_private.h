/*
 * What the files of the group share: group.c (from vectors to pulses), group_change.c (changes and stops). Main with
 * the plan interrupt held off, or the plan interrupt.
 */
#ifndef GROUP_PRIVATE_H
#define GROUP_PRIVATE_H

#include "base_wide.h"
#include "group.h"

/* The lowest of some motors, at least one. */
static inline unsigned group_lowest(unsigned motors)
{
    return wide_bits((uint32_t)(motors & (0U - motors))) - 1U;
}

/* Hands the next segment of an axis over, if its first pulse is due before `until_tick`. False if there is none, or no
 * room for it now. */
bool group_feed_axis(struct group *group, unsigned axis, uint64_t until_tick);

/* Plans what has been asked for and could not be planned, and takes vectors along that came too late to join. */
void group_plan(struct group *group);

#endif
