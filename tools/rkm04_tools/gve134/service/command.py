"""`service`: serves the page until Ctrl-C."""

from __future__ import annotations

import os
from argparse import Namespace
from functools import partial

from rkm04_tools.client_base import named_port
from rkm04_tools.gve134.client_base import PORT_VARIABLE
from rkm04_tools.gve134.gcode.command import MACHINE_VARIABLE
from rkm04_tools.gve134.service.app import make_app
from rkm04_tools.gve134.service.machine_file import read_machine_file
from rkm04_tools.service import virtual
from rkm04_tools.service.hosting import Shown, serve_page
from rkm04_tools.service.unit_orders import Connect

PAGE = Shown("gve134", "gve134.html", 8405)


def run(options: Namespace) -> int:
    """Serve."""
    first = Connect(named_port(options, PORT_VARIABLE) or virtual.NAME)
    name = options.machine or os.environ.get(MACHINE_VARIABLE)
    machine = read_machine_file(name) if name else None
    make = partial(make_app, first=first, baud=options.baud, machine=machine)
    return serve_page(options, PAGE, make)
