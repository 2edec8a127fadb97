"""Losses by type and episode of BEAT and what it is compared with, on as many players of every type: for C4.15.

Thesis: §4.8.5.2.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.streams import stream
from lifelore.experiments.chapter4.ball_game_settings import Setting
from lifelore.experiments.chapter4.diversity_runs import crowd_of, known_of, run_methods
from lifelore.experiments.chapter4.type_naming import NamedTypes, learner_of, play_all

LAGGING = "BEAT, players who adapt late"
"""Players reckon with a new speed only after ``lag`` steps of it; BEAT does as before."""


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Losses (n_types, players, episodes) by method, and the steps until the type that BEAT names stays right."""
    setting = Setting(*cell["game"])
    known = known_of(setting, settings["training"], settings["tuning"], seed)
    n_types = known.game.n_types
    name = f"C4.15 {setting.words} {cell['lot']}"
    generator = stream(seed, name, "players")
    crowd = crowd_of(n_types, n_types, settings["players"] * n_types, generator)
    found = run_methods(known, crowd, seed, name)
    lagging = learner_of(known, len(crowd.population), "BEAT", stream(seed, name, LAGGING))
    played = play_all(known.game, crowd.players, lagging, known.scale, lag=settings["lag"])
    found[LAGGING] = known.scale.loss(*played)
    losses = {
        method: np.round(lost.reshape(n_types, -1, lost.shape[1]), 4).tolist() for method, lost in found.items()
    }
    learner = learner_of(known, len(crowd.population), "BEAT", stream(seed, name, "naming"))
    watch = NamedTypes(learner)
    played = play_all(known.game, crowd.players, learner, known.scale, watch=watch)
    named = learner.users.log_belief.argmax(axis=1)
    needed = np.where(named == crowd.players.kinds, watch.wrong_until, -1)
    chosen = known.value.argmax(axis=1)
    # What matters to the player is the speed: types that share the best one need not be told apart.
    right_speed = chosen[named] == chosen[crowd.players.kinds]
    return {
        **cell,
        "losses": losses,
        "needed": needed.reshape(n_types, -1).tolist(),
        "right_speed": right_speed.reshape(n_types, -1).tolist(),
        "lengths": played.steps.reshape(n_types, -1, played.steps.shape[1])[:, :, 0].tolist(),
    }
