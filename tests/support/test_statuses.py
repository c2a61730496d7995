"""The shared answers to Get Status are what the second implementation makes."""

from __future__ import annotations

from pathlib import Path

import pytest
import statuses


@pytest.mark.parametrize("path", statuses.contents(), ids=lambda path: path.name)
def test_the_file_is_up_to_date(path: Path) -> None:
    assert path.read_text() == statuses.contents()[path]
