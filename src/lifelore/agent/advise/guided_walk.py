"""Walks of a person through a building: what the person sees after each step, and the advice of a desk.

The desk with advice is the better advisor of `advise`, which saves fewer steps before it begins. The desk without
advice watches in the same way, but its κ is so large that it never advises: all steps count as the person's own.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.advise.advice_desk import AdviceDesk, register_desk
from lifelore.agent.advise.walk_building import WalkBuilding
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.grids.grid_world import MOVE_NAMES
from lifelore.memory import Memory

KAPPA = 0.5
"""Least gain of advice in nats; larger advises later."""
WINDOW = 60
"""Number of a person's last steps that count as evidence; more remembers longer."""
SHARE, BURST = 0.75, 15.0
"""Largest share of advised steps, and saved steps at which advice begins: after 20 steps, and for up to 60."""
NEVER = 1e9
"""κ in nats of a desk that never advises."""


def walk_desk(memory: Memory, building: WalkBuilding, advice: bool, maps: Mapping[str, str]) -> AdviceDesk:
    """The desk that watches the walks in a building; registers it where it is new.

    Parameters
    ----------
    advice : bool
        Whether its rule can fire.

    Raises
    ------
    InputError
        The name of the building cannot name a desk.
    """
    document = {
        "world": building.name,
        "experts": building.expert_steps,
        "goals": building.places.tolist(),
        "kappa": KAPPA if advice else NEVER,
        "window": WINDOW,
        "share": SHARE,
        "burst": BURST,
    }
    return register_desk(memory, walk_desk_name(building, advice), document, maps)


def walk_desk_name(building: WalkBuilding, advice: bool) -> str:
    """Name of the desk that watches the walks in a building."""
    return f"walk {building.name}{'' if advice else ', unadvised'}"


def begin_walk(building: WalkBuilding, desk: AdviceDesk, walk: str) -> dict[str, Any]:
    """The errand of a walk and what the person sees at its start; the desk takes in that the walk begins.

    Parameters
    ----------
    walk : str
        Name of the walk; the same name has the same errand.

    Returns
    -------
    dict
        As `take_step`; and ``shape`` (rows, columns), ``cell`` in metres,
        ``goal``, name of the place to find, ``shortest``, moves of the shortest way, ``kappa`` in nats.

    Raises
    ------
    InputError
        The walk has steps already.
    """
    start, place = building.errand(walk)
    view = _answer(building, desk, walk, 0, start, None)
    if view["step"]:
        raise InputError(f"walk must be new, got '{walk}', which has {view['step']} steps; choose another name")
    return view | _errand(building, start, place)


def resume_walk(building: WalkBuilding, desk: AdviceDesk, walk: str) -> dict[str, Any]:
    """A walk that has begun, as the person left it.

    Returns
    -------
    dict
        As `begin_walk`, but after the last step; and ``way``, {"at", "p_normal", "gain", "advise"} at the start
        and after each step; ``known``, {"seen", "places"}, all that has been in sight, as in `take_step`.

    Raises
    ------
    NotFoundError
        Nobody has begun this walk in this building.
    """
    steps = desk.retrace(walk)
    if not steps:
        raise NotFoundError(f"no walk '{walk}' has begun in {building.name}; begin it first")
    states = [state for state, _ in steps]
    now, cells = states[-1], building.world.cells
    seen = np.unique(np.concatenate([building.in_sight(state) for state in states]))
    way = [
        {"at": cells[state].tolist()} | {name: advice[name] for name in ("p_normal", "gain", "advise")}
        for state, advice in steps
    ]
    view = _with_advice(building, walk, len(steps) - 1, now, steps[-1][1])
    return view | _errand(building, *building.errand(walk)) | {"way": way, "known": _cells(building, seen)}


def take_step(
    building: WalkBuilding, desk: AdviceDesk, walk: str, number: int, state: int, move: str
) -> dict[str, Any]:
    """What the person sees after a move, and the advice there.

    Parameters
    ----------
    number : int
        Number of the move, from 1. A move that is sent twice counts once.
    state : int
        State in which the person tried the move.
    move : str
        north, south, east or west.

    Returns
    -------
    dict
        ``walk``; ``step``, number of moves so far; ``state`` and its cell ``at`` (row, column);
        ``open``, names of the moves that lead on; ``seen``, (row, column, bits) of the cells in sight, where bit k
        is set if the move k of `MOVE_NAMES` leads on; ``places`` in sight: {"name", "at"}; ``reached``;
        ``advise``, ``theta``, ``p_normal`` and ``gain`` as in `advise`.

    Raises
    ------
    InputError
        The number leaves a gap, or state or move breaks its rule.
    """
    if move not in MOVE_NAMES:
        raise InputError(f"move must be one of {', '.join(MOVE_NAMES)}, got '{move}'")
    if number < 1:
        raise InputError(f"number must be at least 1, the first move, got {number}")
    return _answer(building, desk, walk, number, state, move)


def _answer(
    building: WalkBuilding, desk: AdviceDesk, walk: str, number: int, state: int, move: str | None
) -> dict[str, Any]:
    # The desk counts the beginning of the walk as its first step, without an action.
    advice = desk.answer(walk, number, [{"state": state, "action": move}])
    after = int(building.world.neighbour[state, MOVE_NAMES.index(move)]) if move else state
    return _with_advice(building, walk, advice["step"] - 1, state if after < 0 else after, advice)


def _with_advice(
    building: WalkBuilding, walk: str, step: int, state: int, advice: Mapping[str, Any]
) -> dict[str, Any]:
    _, place = building.errand(walk)
    return {
        "walk": walk,
        "step": step,
        **_view(building, state),
        "reached": bool(state == building.places[place]),
        **{name: advice[name] for name in ("advise", "theta", "p_normal", "gain")},
    }


def _errand(building: WalkBuilding, start: int, place: int) -> dict[str, Any]:
    world = building.world
    return {
        "shape": list(world.shape),
        "cell": world.frame.cell,
        "goal": building.names[place],
        "shortest": int(building.distance[place, start]),
        "kappa": KAPPA,
    }


def _view(building: WalkBuilding, state: int) -> dict[str, Any]:
    world = building.world
    return {
        "state": state,
        "at": world.cells[state].tolist(),
        "open": [name for name, leads in zip(MOVE_NAMES, world.neighbour[state] >= 0, strict=True) if leads],
        **_cells(building, building.in_sight(state)),
    }


def _cells(building: WalkBuilding, states: NDArray[np.integer]) -> dict[str, Any]:
    """The cells of states with their open moves, and the places among them."""
    world = building.world
    bits = ((world.neighbour[states] >= 0) << np.arange(len(MOVE_NAMES))).sum(axis=1)
    places = np.flatnonzero(np.isin(building.places, states))
    return {
        "seen": np.column_stack([world.cells[states], bits]).tolist(),
        "places": [
            {"name": building.names[place], "at": world.cells[building.places[place]].tolist()} for place in places
        ],
    }
