"""A machine that says of two motors how far a step goes."""

from __future__ import annotations

from typing import Any

MACHINE: dict[str, Any] = {
    "format": "rkm04-machine",
    "version": 1,
    "name": "Table",
    "motors": [
        {"program": "S100 V1000 F400 R", "steps_per_mm": 40},
        {"program": "S100 V1000 F90 R", "steps_per_degree": 20},
        {"program": "F500 R"},
        {"program": ""},
    ],
}
