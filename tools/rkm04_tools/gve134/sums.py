"""What becomes of the checksums of a unit: enum gve_master_sums of tools/gve134_master."""

from __future__ import annotations

from enum import IntEnum


class Sums(IntEnum):
    """`KEPT`: they stay as they are, on or off."""

    NONE = 0
    ON = 1
    KEPT = 2
