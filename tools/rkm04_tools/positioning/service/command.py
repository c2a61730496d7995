"""`service`: serves the page until Ctrl-C."""

from __future__ import annotations

from argparse import Namespace
from functools import partial

from rkm04_tools.client_base import named_port
from rkm04_tools.positioning.client import PORT_VARIABLE, node_of
from rkm04_tools.positioning.service.app import make_app
from rkm04_tools.positioning.service.connection import LineForm
from rkm04_tools.service import virtual
from rkm04_tools.service.hosting import Shown, serve_page
from rkm04_tools.service.unit_orders import Connect

PAGE = Shown("positioning", "positioning.html", 8406)


def run(options: Namespace) -> int:
    """Serve."""
    node = node_of(options)
    port = named_port(options, PORT_VARIABLE) or virtual.NAME
    first = Connect(port, 1 if port == virtual.NAME else node)
    form = LineForm(options.baud, options.form)
    return serve_page(options, PAGE, partial(make_app, first=first, form=form))
