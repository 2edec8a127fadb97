"""C4.9: entries, and bytes of arrays, of the observation models of §4.7.6, once learnt. Thesis: §4.7.6."""

from collections.abc import Mapping

from reproduction.chapter4.c4_09_model_storage.applications import RANDOM, application
from reproduction.chapter4.c4_09_model_storage.stored_models import stored


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
    found = [stored(application(settings, cell, number, seed)) for number in range(draws)]
    return {"cell": dict(cell), "stored": found}
