"""Lines of the ball game's figures: a colour for each size of the ball and for each method."""

from collections.abc import Sequence
from typing import Any

from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.figures.style import BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILION

_SIZE_COLOURS: dict[int, str] = dict(zip(SIZES, (PURPLE, BLUE, SKY, GREEN, ORANGE, VERMILION), strict=True))
METHODS = {"static": INK, "EXP-3": VERMILION, "BEAT": BLUE}
WORDS = {"static": "best static speed α*", "EXP-3": "EXP-3", "BEAT": "BEAT"}
"""Colour and label of each curve of Figure 4.16."""


def size_lines(sizes: Sequence[int], **properties: Any) -> dict[str, dict[str, Any]]:
    """Line properties of the ball sizes, ``b = 2`` and so on, cold for small balls and warm for large ones."""
    return {f"b = {size}": {"color": _SIZE_COLOURS[size], **properties} for size in sizes}


def method_lines(**properties: Any) -> dict[str, dict[str, Any]]:
    """Line properties of the methods by label."""
    return {WORDS[name]: {"color": colour, **properties} for name, colour in METHODS.items()}
