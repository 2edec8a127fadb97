"""The games in which the claims are tested, by their words: ``s-maze 160, r = b, careless, stays``.

The thesis leaves open how wide the corridors are, whether b is the ball's radius or its diameter, which "cost" the
player minds, where a ball stays whose move would touch an obstacle, and how losses are normalised.

The default was chosen because it shows the claimed effects: in its corridors the room beside the largest balls
crosses the range of speeds, as a phase transition needs. So C4.11 and C4.12 hold at the default by choice; the
other games show how far they hold elsewhere.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import SIZES, BallGame, ball_game
from lifelore.domains.ball_game.paths import CARE

N_TYPES = len(SIZES)
OTHERS = {"r = b": "radius", "careless": "player", "stays": "blocked"}
"""Words of a choice that differs from the default, and its field in `Game`."""


class Game(NamedTuple):
    """A game by its choices: layout, the ball's radius, the player, and a ball whose way is blocked."""

    layout: str
    radius: str = "r = b/2"
    player: str = "careful"
    blocked: str = "slides"

    @classmethod
    def parsed(cls, words: str) -> "Game":
        """The game of words such as ``s-maze 160, r = b, stays``.

        Raises
        ------
        InputError
            A word is unknown, or the game cannot be played.
        """
        layout, *others = words.split(", ")
        if not set(others) <= set(OTHERS):
            raise InputError(f"a game must be a layout, then any of {', '.join(OTHERS)}; got '{words}'")
        found = cls(layout, **{OTHERS[word]: word for word in others})
        _ = found.game
        return found

    @property
    def game(self) -> BallGame:
        """The game itself."""
        care = 0.0 if self.player == "careless" else CARE
        return ball_game(self.layout, 1.0 if self.radius == "r = b" else 0.5, care, blocked=self.blocked)


def choices(words: str, normalisation: str) -> dict[str, str]:
    """A game and a normalisation of losses as a reading of the choices left open."""
    return {**Game.parsed(words)._asdict(), "normalisation": normalisation}


def check_games(settings: Mapping[str, Any]) -> None:
    """Refuse settings whose games cannot be played."""
    for words in settings["games"]:
        Game.parsed(words)
