"""One colour and line for each rule of policy reuse and each peer, in every figure of chapter 4."""

from typing import Any

from lifelore.core.errors import NotFoundError
from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION, YELLOW

SOLID: Any = "-"
PRINTED: Any = (0, (2, 1.2))
"""Forms as printed are dashed in the colour of their standard form."""
DOTS: Any = (0, (1, 1.2))

LOOKS: dict[str, tuple[str, Any]] = {
    "greedy": (GREY, SOLID),
    "eps-greedy": (YELLOW, SOLID),
    "sampling": (GREEN, SOLID),
    "PI": (PURPLE, SOLID),
    "PI, printed": (PURPLE, PRINTED),
    "EI": (BLUE, SOLID),
    "EI, printed": (BLUE, PRINTED),
    "BE": (ORANGE, SOLID),
    "BE, printed": (ORANGE, PRINTED),
    "BE, κ 30": (ORANGE, DOTS),
    "KG": (VERMILION, SOLID),
    "KG, printed": (VERMILION, PRINTED),
    "IDS": (SKY, SOLID),
    # peers, which know no types
    "UCB1": (VERMILION, SOLID),
    "UCB1, flat": (VERMILION, DOTS),
    "UCB1, tuned": (VERMILION, PRINTED),
    "GP-UCB": (ORANGE, SOLID),
    "GP-UCB, tuned": (ORANGE, PRINTED),
    "GP-UCB, true metric": (PURPLE, PRINTED),
    "GP-UCB, prior covariance": (PURPLE, DOTS),
    "interval estimation": (INK, PRINTED),
    "eps-greedy on means": (YELLOW, SOLID),
    "clustered UCB": (GREEN, PRINTED),
    "Thompson": (GREEN, DOTS),
    "EXP-3": (SKY, PRINTED),
    "try all": (GREY, SOLID),
    # signals
    "(s, a, s′)": (BLUE, SOLID),
    "(s, a, r)": (GREEN, SOLID),
    "U": (VERMILION, SOLID),
    "random": (INK, DOTS),
}


def look_of(name: str) -> tuple[str, Any]:
    """Colour and line style of a rule, peer or signal."""
    if name not in LOOKS:
        raise NotFoundError(f"no look for '{name}'; add it to figures/reuse_palette.py, beside {', '.join(LOOKS)}")
    return LOOKS[name]
