"""O4: generated offices compared with their own edited maps, other offices, and floors with the same walls.

The seeds of the offices chose none of the thresholds.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from lifelore.agent.live.buildings.recognition import LEAST_MATCH, leads
from lifelore.core.metrics import Estimate
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.buildings.office import office_map
from lifelore.domains.buildings.registration import Registration, Walls, register
from reproduction.engine.estimates import exact_share, exact_value
from reproduction.own.o_04_same_building.edits import EDITS, turned

OTHERS = ("another office", "a smaller office", "the same walls, other furniture")


def cells(settings: Mapping) -> list[dict]:
    """An office each."""
    return [{"office": number} for number in range(settings["offices"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """By the map that is compared: the share of walls that match, and whether the building is recognised."""
    number = settings["first_seed"] + 3 * (settings["offices"] * seed + cell["office"])
    width, height = settings["width_m"], settings["height_m"]
    office = office_map(number, width, height)
    maps: dict[str, OccupancyMap] = {name: edit(office, number) for name, edit in EDITS.items()}
    others = (
        office_map(number + 1, width, height),
        office_map(number + 2, 0.75 * width, 0.75 * height),
        turned(office_map(number, width, height, furniture=number), 3.0),
    )
    maps |= dict(zip(OTHERS, others, strict=True))
    return {"compared": {name: _compared(register(Walls(office), Walls(other))) for name, other in maps.items()}}


def _compared(found: Registration | None) -> dict[str, Any]:
    match = 0.0 if found is None else round(found.best.match, 4)
    return {"match": match, "recognised": found is not None and recognised(found)}


def recognised(found: Registration) -> bool:
    """Whether a registration would recognise the building, were it the only one in memory."""
    clear = found.second is None or leads(found.best, found.second)
    return found.best.match >= LEAST_MATCH and clear


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Share of edited maps that are recognised, and number of other maps that are."""
    own, others = ([result["compared"][name] for result in results for name in names] for names in (EDITS, OTHERS))
    return {
        "recognised": exact_share(one["recognised"] for one in own),
        "false_recognitions": exact_value(sum(one["recognised"] for one in others), len(others)),
        "largest_false_match": exact_value(max(one["match"] for one in others), len(others)),
    }
