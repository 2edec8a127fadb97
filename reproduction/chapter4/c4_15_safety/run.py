"""C4.15: losses and naming of types by type and episode, on as many players of every type in every game.

Thesis: §4.8.5.2.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.streams import stream
from reproduction.chapter4.ball_game.games import NORMALISATIONS, Setting
from reproduction.chapter4.ball_game.games import check_games as check
from reproduction.chapter4.ball_game.methods import (
    BEAT_PRINTED,
    BEATS,
    NamedTypes,
    beat_learner,
    crowd_of,
    known_of,
    run_methods,
)
from reproduction.chapter4.ball_game.play import play_all

__all__ = ["cells", "check", "run_cell"]
LAGGING = "BEAT, players who adapt late"
"""Players adapt to a new speed only after ``lag`` steps of it; BEAT is unchanged."""


def cells(settings: Mapping) -> list[dict]:
    """Lots of players of every game under every normalisation of the loss; the default, with `lots`, is first."""
    games = [
        list(Setting(*game)._replace(normalisation=own)) for game in settings["games"] for own in NORMALISATIONS
    ]
    lots = [settings["lots"]] + [settings["grid_lots"]] * (len(games) - 1)
    return [{"game": game, "lot": lot} for game, own in zip(games, lots, strict=True) for lot in range(own)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Losses (n_types, players, episodes) by method, and how soon BEAT names the right type.

    ``needed``: steps until the type named stays right. ``half``: whether it is right half-way through the first
    episode, whose steps are ``lengths``. ``_printed`` marks those of BEAT with ε as printed.
    """
    setting = Setting(*cell["game"])
    known = known_of(setting, settings["training"], settings["tuning"], seed)
    n_types = known.game.n_types
    name = f"C4.15 {setting.words} {cell['lot']}"
    crowd = crowd_of(n_types, n_types, settings["players"] * n_types, stream(seed, name, "players"))
    n, kinds = len(crowd.population), crowd.players.kinds
    found = run_methods(known, crowd, seed, name)
    lagging = beat_learner(known, n, stream(seed, name, LAGGING), {})
    found[LAGGING] = known.losses(crowd.players, lagging, lag=settings["lag"])
    watches, lengths = {}, {}
    for key, words, variant in (("", "naming", {}), ("_printed", "naming, ε as printed", BEATS[BEAT_PRINTED])):
        learner = beat_learner(known, n, stream(seed, name, words), variant)
        watches[key] = NamedTypes(learner)
        played = play_all(known.game, crowd.players, learner, known.scale, watch=watches[key])
        lengths[key] = played.steps[:, 0]
    best_speed = known.value.argmax(axis=1)

    def by_type(values: np.ndarray) -> list:
        return values.reshape(n_types, -1, *values.shape[1:]).tolist()

    return {
        **cell,
        "losses": {method: by_type(np.round(lost, 4)) for method, lost in found.items()},
        # Types with the same best speed need not be distinguished.
        "right_speed": by_type(best_speed[watches[""].named] == best_speed[kinds]),
        **{f"needed{key}": by_type(watch.steps_needed(kinds)) for key, watch in watches.items()},
        **{f"half{key}": by_type(watch.halfway(lengths[key]) == kinds) for key, watch in watches.items()},
        **{f"lengths{key}": by_type(steps) for key, steps in lengths.items()},
    }
