"""C5.10: `LongLivedAgent`, its ablations and a textbook's learner in eight families of others' worlds.

A cell is a life: all agents meet the same tasks and the same luck. Intervals resample lives. Returns of families
have different units: they are divided by the *spread* of the family, the mean return of the best agent above that
of the worst.

- First episode: the *way* is what an agent that knows the type earns in first episodes above an agent without a
  past; the share of the way that the whole agent goes counts. Only tasks of types that were met before count.
- Mean return: over all episodes of all tasks but the first of a life, which all agents begin without a past.
- A pair is a life and a type that is new after its first task and is visited again. It is *recognised* if its
  first visit adds a type, and the next visit is taken for that type, after three episodes and at the end.
- Alarms: the share of tasks of types met before in which the alarm was raised.
- A part pays in a family where the mean return without it is lower, by the 95 % interval.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.chapter5.c5_10_one_life.lives import AGENTS, FULL, PARTS, SCRATCH, TEXTBOOK, drawn_tasks, lived
from reproduction.engine.estimates import UNMEASURED, exact_share, exact_value, share_of
from reproduction.engine.records import having

Array = NDArray[np.float64]
Results = Sequence[Mapping]
RIVALS = (TEXTBOOK, PARTS["reuse"], PARTS["prior"])
"""Agents with fewer parts: none, the prior only, reuse only."""
INFORMED = "informed"


def cells(settings: Mapping) -> list[dict]:
    """A life in a family each."""
    return [{"family": one, "life": life} for one, life in product(settings["families"], range(settings["lives"]))]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The hidden types of the tasks of a life, and what each agent earned, see `lived`."""
    family, life, n_tasks = cell["family"], 1000 * seed + cell["life"], settings["tasks"]
    agents = {name: lived(family, name, life, n_tasks, settings["false_alarm"]) for name in AGENTS}
    return {**cell, "types": drawn_tasks(family, life, n_tasks)[0], "agents": agents}


def measure(settings: Mapping, results: Results) -> dict[str, Estimate]:
    """Shares of the way, recognised types, alarms, and what parts pay; over all families, or the least of all."""
    families = [having(results, family=name) for name in settings["families"]]
    found = {
        "first_share": first_share(families),
        "first_least": least([first_share([own]) for own in families]),
        "best_upper": exact_value(min(upper(above_best(own)) for own in families)),
        "recognised": recognised(results),
        "recognised_least": least([recognised(own) for own in families]),
        "alarms": alarms(results),
    }
    for part, other in PARTS.items():
        gains = [gain(own, other) for own in families]
        found[f"{part}_families"] = share_of([lower(mean_estimate(own)) > 0 for own in gains])
        found[f"{part}_gain"] = mean_estimate(np.mean(gains, axis=0))
    return found


def least(found: Sequence[Estimate]) -> Estimate:
    """The least value; `UNMEASURED` where one is."""
    return exact_value(min(one.value for one in found)) if all(one.n for one in found) else UNMEASURED


def readings(settings: Mapping, results: Results) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same for each family."""
    for name in settings["families"]:
        yield {"family": name}, measure({**settings, "families": [name]}, having(results, family=name))


def rows(settings: Mapping, results: Results) -> list[dict]:
    """By family: mean return, and first return on seen types, of each agent, in the family's own unit."""
    found = []
    for name in settings["families"]:
        own = having(results, family=name)
        first = {agent: first_returns(own, agent) for agent in (*AGENTS, INFORMED)}
        both = {"mean": mean_returns(own), "first": first}
        found.append({"family": name} | {key: _means(values) for key, values in both.items()})
    return found


def _means(values: Mapping[str, Array]) -> dict[str, float | None]:
    known = {agent: own[np.isfinite(own)] for agent, own in values.items()}
    return {agent: round(float(own.mean()), 3) if own.size else None for agent, own in known.items()}


# ---- first episodes ----------------------------------------------------------------------------------------


def seen(types: Sequence[str]) -> NDArray[np.bool_]:
    """(n_tasks,) whether the type of each task was met in an earlier one."""
    return np.array([hidden in types[:number] for number, hidden in enumerate(types)])


def first_returns(results: Results, agent: str) -> Array:
    """(n_lives,) mean return of the first episodes of tasks of seen types; `agent` may be ``informed``.

    NaN for a life without such tasks.
    """
    found = []
    for one in results:
        informed = one["agents"][FULL]["informed"]
        values = informed if agent == INFORMED else one["agents"][agent]["first"]
        chosen = [n for n in np.flatnonzero(seen(one["types"])) if informed[n] is not None]
        found.append(np.mean([values[n] for n in chosen]) if chosen else np.nan)
    return np.array(found)


def first_share(families: Sequence[Results]) -> Estimate:
    """The share of the way that the whole agent goes; families count by way over spread.

    `UNMEASURED` where knowing the type is no gain.
    """
    full, informed = [], []
    for own in families:
        values = {agent: first_returns(own, agent) for agent in (*AGENTS, INFORMED)}
        by = spread(values)
        full.append((values[FULL] - values[SCRATCH]) / by)
        informed.append((values[INFORMED] - values[SCRATCH]) / by)
    goes, way = np.mean(full, axis=0), np.mean(informed, axis=0)
    measured = np.isfinite(way)
    if not measured.any() or way[measured].mean() <= 0:
        return UNMEASURED
    return ratio_estimate(goes[measured], way[measured])


def spread(values: Mapping[str, Array]) -> float:
    """The mean of the best agent above that of the worst; 1 where all are equal or unmeasured."""
    means = [float(np.mean(own[np.isfinite(own)])) for own in values.values() if np.isfinite(own).any()]
    return max(means, default=0.0) - min(means, default=0.0) or 1.0


# ---- mean returns ------------------------------------------------------------------------------------------


def mean_returns(results: Results) -> dict[str, Array]:
    """(n_lives,) mean return of all tasks but the first, by agent."""
    return {agent: np.array([np.mean(one["agents"][agent]["mean"][1:]) for one in results]) for agent in AGENTS}


def gain(results: Results, other: str) -> Array:
    """(n_lives,) mean return of the whole agent above another's, in units of the spread."""
    values = mean_returns(results)
    return (values[FULL] - values[other]) / spread(values)


def above_best(results: Results) -> Estimate:
    """Mean return above that of the best agent with fewer parts, in units of the spread."""
    values = mean_returns(results)
    return mean_estimate(gain(results, max(RIVALS, key=lambda name: values[name].mean())))


def upper(one: Estimate) -> float:
    """The upper end of the interval; the value where there is none."""
    return one.ci95[1] if one.ci95 else one.value


def lower(one: Estimate) -> float:
    """The lower end of the interval; the value where there is none, and −∞ of fewer than three lives."""
    return one.ci95[0] if one.ci95 else one.value if one.n >= 3 else -np.inf


# ---- new types ---------------------------------------------------------------------------------------------


def pairs(one: Mapping) -> Iterator[tuple[int, int]]:
    """Of a life: the first two visits of each type that is new after the first task and is visited again."""
    types = one["types"]
    for hidden in dict.fromkeys(types):
        visits = [number for number, name in enumerate(types) if name == hidden]
        if visits[0] > 0 and len(visits) > 1:
            yield visits[0], visits[1]


def recognised(results: Results) -> Estimate:
    """The share of pairs in which a new type was noticed, and recognised at its next visit."""
    return exact_share(is_recognised(one["agents"][FULL], *pair) for one in results for pair in pairs(one))


def is_recognised(thought: Mapping, first: int, following: int) -> bool:
    """Whether the first visit added a type, and the next was taken for it after three episodes and at the end."""
    name = thought["named"][first]
    return bool(thought["new"][first] and thought["named"][following] == name == thought["soon"][following])


def alarms(results: Results) -> Estimate:
    """The share of tasks of seen types with an alarm."""
    return exact_share(
        raised
        for one in results
        for raised, known in zip(one["agents"][FULL]["alarm"], seen(one["types"]), strict=True)
        if known
    )
