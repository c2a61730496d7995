"""`service`: serves the page until Ctrl-C."""

from __future__ import annotations

import os
from argparse import Namespace
from functools import partial

from rkm04_tools.failure import Failure
from rkm04_tools.frame import NODES
from rkm04_tools.positioning.client import PORT_VARIABLE
from rkm04_tools.positioning.service.app import make_app
from rkm04_tools.positioning.service.connection import LineForm
from rkm04_tools.service import virtual
from rkm04_tools.service.hosting import Shown, serve_page
from rkm04_tools.service.unit_orders import Connect

PAGE = Shown("positioning", "positioning.html", 8406)


def run(options: Namespace) -> int:
    """Serve."""
    if options.node not in NODES:
        raise Failure(f"--node {options.node}: write an address, 1 to 16")
    port = options.port or os.environ.get(PORT_VARIABLE) or virtual.NAME
    first = Connect(port, 1 if port == virtual.NAME else options.node)
    form = LineForm(options.baud, options.form)
    return serve_page(options, PAGE, partial(make_app, first=first, form=form))
