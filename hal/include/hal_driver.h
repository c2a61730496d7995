/*
 * The seam to the ENABLE inputs of the motor drivers. The drivers are off, without current in the motors, from power-on
 * until the first motion, and again when no motor has moved for as long as the board says. A board without ENABLE
 * outputs does nothing here.
 *
 * All drivers are switched together: a motor that stands holds its place while another one works, and motors that
 * begin together have the same time to get their current.
 */
#ifndef HAL_DRIVER_H
#define HAL_DRIVER_H

enum {
    /* From hal_driver_enable to the first pulse at least, which the caller sees to: a motion's first pulse comes a
     * whole step after its begin. Boards have drivers that are ready by then. */
    HAL_DRIVER_READY_US = 200
};

/* Switches the drivers on; a motion begins. Not without the crystal, as nothing moves then. Main. */
void hal_driver_enable(void);

#endif
