"""What a page of this unit says of failures."""

from __future__ import annotations

from rkm04_tools.service.words import Words

WORDS = Words("gve134")
