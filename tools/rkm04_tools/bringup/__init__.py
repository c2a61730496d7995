"""`bringup`: walks a person through the first tries of a board (hal/stm32/bringup/README.md)."""
