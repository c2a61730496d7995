"""The ports of this machine."""

from __future__ import annotations

from typing import Any

from serial.tools import list_ports

from rkm04_tools.service import virtual


def ports() -> dict[str, Any]:
    """The ports of this machine, the virtual one first."""
    found = sorted(list_ports.comports(), key=lambda port: port.device)
    rows = [{"port": virtual.NAME, "label": "virtual unit"}]
    for port in found:
        named = port.description and port.description != "n/a"
        label = f"{port.device} ({port.description})" if named else port.device
        rows.append({"port": port.device, "label": label})
    return {"type": "ports", "ports": rows}
