"""C4.9: what the observation models of §4.7.6 take to store.

The thesis bounds the storage of three observation models by formulas and orders them for applications with more
rewards than states. Here the models are learnt and their entries counted: in random applications with fewer and
with more rewards than states, in the telephone service, in the reserve with finely and with coarsely rounded pay,
and in Pacman. Tables as the formulas count them decide; what episodes really fill, and the bytes of files, are
reported beside them.
Thesis: §4.7.6.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter4.c4_09_model_storage.stored_models import RANDOM, REWARDS_OF, application, stored


def check(settings: Mapping) -> None:
    for key in ("draws", "types", "policies", "actions", "episodes", "horizon", "samples"):
        if settings[key] < 1:
            raise InputError(f"{key} must be at least 1, got {settings[key]}")
    if not settings["states"] or not settings["rewards"] or set(settings["rewards_of"]) - set(REWARDS_OF):
        raise InputError(f"states and rewards must name sizes, and rewards_of be among {', '.join(REWARDS_OF)}")
    if min([*settings["states"], *settings["rewards"], *settings["models"]]) < 1:
        raise InputError("states, rewards and models must be at least 1")


def cells(settings: Mapping) -> list[dict]:
    """Random applications by their sizes, and each of the thesis's own."""
    random = [
        {"kind": RANDOM, "states": s, "rewards": r, "rewards_of": of}
        for of in settings["rewards_of"]
        for s in settings["states"]
        for r in settings["rewards"]
    ]
    phones = [{"kind": "telephone", "models": n} for n in settings["models"]]
    reserves = [{"kind": "surveillance", "targets": n, "resolution": step} for n, step in settings["reserves"]]
    mazes = [{"kind": "pacman", "rows": rows, "columns": columns} for rows, columns in settings["mazes"]]
    return random + phones + reserves + mazes


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Every draw of an application, learnt and counted; the thesis's own are drawn once."""
    draws = settings["draws"] if cell["kind"] == RANDOM else 1
    return {
        "cell": dict(cell),
        "stored": [stored(application(settings, cell, number, seed)) for number in range(draws)],
    }
