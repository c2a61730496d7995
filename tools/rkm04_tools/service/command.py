"""`service`: serves the page until Ctrl-C."""

from __future__ import annotations

from argparse import Namespace
from functools import partial

from rkm04_tools.client_base import PORT_VARIABLE, named_port, reading_node_of
from rkm04_tools.service import virtual
from rkm04_tools.service.app import make_app
from rkm04_tools.service.hosting import Shown, serve_page
from rkm04_tools.service.orders import Connect

PAGE = Shown("rkm04", "index.html", 8404)


def run(options: Namespace) -> int:
    """Serve."""
    first = Connect(named_port(options, PORT_VARIABLE) or virtual.NAME,
                    reading_node_of(options))  # fmt: skip
    return serve_page(options, PAGE, partial(make_app, first=first))
