/*
 * The seam to the step output: four compare channels of one timer, one STEP pin each, and the DIR pins.
 *
 * The backend makes the rising edge of STEP in hardware at the armed tick, puts it back low after the board's pulse
 * width, and then calls the client's step interrupt (hal_run.h). One pulse a motor can be armed at a time.
 */
#ifndef HAL_STEP_H
#define HAL_STEP_H

#include <stdbool.h>
#include <stdint.h>

/* Arms a pulse of motor 0 to 3 at `tick`, the low 32 bits of the unit's time, less than 25 s ahead. A tick that has
 * just gone by is made good at once and counted as late. Main and all interrupts. */
void hal_step_arm(unsigned motor, uint32_t tick);

/* Takes the armed pulse back. False: it has been made already and its interrupt is due. Only while hal_step_hold is in
 * force, so in main, plan and tick interrupt. */
bool hal_step_disarm(unsigned motor);

/* Sets DIR: false forward, true backward. Called only while no pulse is armed. Main. */
void hal_step_set_direction(unsigned motor, bool backward);

/* Connects STEP and DIR of a motor to their pins, or holds the pins at 0 while all else runs on; at first they are
 * connected. Called only while the motor stands: DIR moves where no pulse is near. Main. */
void hal_step_connect(unsigned motor, bool connected);

/* Ticks that the backend wants between the planning of a change and the pulse at which it takes effect: at least
 * what planning takes. 0 where planning takes no time. Main. */
uint32_t hal_step_lead_ticks(void);

/* Holds the step interrupt off and all others with it, for less than 2 us, and lets them through again; not nested.
 * Main, plan and tick interrupt. */
void hal_step_hold(void);
void hal_step_release(void);

#endif
