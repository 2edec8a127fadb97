"""The games on which the claims are tested: the default, and those that differ from it in one thing or two.

A game is ``[layout, radius_share, care, normalisation]``. The thesis does not say how wide its corridors are,
whether b is the ball's radius or its diameter, what "cost" its player minds, nor what losses are divided by. The
default was chosen so that the room beside the largest balls crosses the range of speeds, as a phase transition
needs.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from lifelore.core.errors import InputError, LifeloreError
from lifelore.domains.ball_game import SIZES, BallGame, ball_game
from lifelore.domains.ball_game_ways import CARE

DEFAULT = ["s-maze 160", 0.5, CARE, "fixed"]
NORMALISATIONS = ("fixed", "maxima")
GAMES = [
    DEFAULT,
    ["s-maze 110", 0.5, CARE, "fixed"],
    ["s-maze 130", 0.5, CARE, "fixed"],
    ["s-maze 200", 0.5, CARE, "fixed"],
    ["s-maze 160", 1.0, CARE, "fixed"],
    ["s-maze 200", 1.0, CARE, "fixed"],
    ["s-maze 160", 0.5, 0.0, "fixed"],
    ["blobs", 0.5, CARE, "fixed"],
    ["open field", 0.5, CARE, "fixed"],
    ["s-maze 160", 0.5, CARE, "maxima"],
]


class Setting(NamedTuple):
    """One of the games, named."""

    layout: str
    radius_share: float
    care: float
    normalisation: str

    @property
    def game(self) -> BallGame:
        return ball_game(self.layout, float(self.radius_share), float(self.care))

    @property
    def words(self) -> str:
        """Such as ``s-maze 160, r = b/2, T/400 + C/20``."""
        radius = {0.5: "r = b/2", 1.0: "r = b"}.get(self.radius_share, f"r = {self.radius_share:g} b")
        care = "" if self.care else ", careless"
        return f"{self.layout}, {radius}{care}{'' if self.normalisation == 'fixed' else ', by maxima'}"


def check_games(settings: Mapping[str, Any], counts: Sequence[str]) -> None:
    """Refuse settings whose games cannot be played, or whose `counts` are not at least 1."""
    for key in counts:
        if settings[key] < 1:
            raise InputError(f"{key} must be at least 1, got {settings[key]}")
    if not settings["games"]:
        raise InputError("games must name at least one [layout, radius_share, care, normalisation], got none")
    for entry in settings["games"]:
        if len(entry) != 4 or entry[3] not in NORMALISATIONS:
            raise InputError(
                f"a game must be [layout, radius_share, care, normalisation], the last one of "
                f"{', '.join(NORMALISATIONS)}; got {entry}"
            )
        try:
            _ = Setting(*entry).game
        except LifeloreError as error:
            raise InputError(f"game {entry} cannot be played: {error}") from None


N_TYPES = len(SIZES)
