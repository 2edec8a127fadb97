"""O1: six selection rules in 22 worlds, with exact models and with models learnt from few runs.

Tasks come in groups. A group has tasks, noise and, where they are drawn, deviations and tables of its own. Where
models are learnt it has a library of its own, and the rules among which the library's default is decided also run
with models that are known to be uncertain. All meet the same tasks, luck and libraries.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.figures.style import BLUE, GREY, ORANGE, Axes
from lifelore.interaction import selection
from lifelore.interaction.reuse.regret import library_regret
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN, late_regret, play_rule
from reproduction.figures.panels import panels
from reproduction.own.o_01_default_rule.worlds import CALLS, EQUAL, NOISES, world_of

RULES: dict[str, selection.SelectionRule] = {
    "EI, outcome": selection.ExpectedImprovement(of="outcome"),
    "EI, pay": selection.ExpectedImprovement(of="pay"),
    "IDS": selection.InformationDirected(),
    "KG": selection.KnowledgeGradient(),
    "sampling": selection.BeliefSampling(),
    "greedy": selection.Greedy(),
}
CANDIDATES = ("EI, pay", "IDS")
"""Rules among which the library's default is decided: they need no horizon and cost little for many users."""
STUCK = 0.01
"""Share of the range of mean pays; a task is stuck where its regret over the last ten episodes exceeds it."""
MOST_STUCK = 0.05
"""A default may leave this share of tasks stuck above the share of the rule that leaves the fewest in a world."""


def cells(settings: Mapping) -> list[dict]:
    """Every world with every noise; calls have a single noise."""
    noises = {name: (EQUAL,) if name == CALLS else NOISES for name in settings["worlds"]}
    return [
        {"world": name, "noise": noise, "model": model}
        for name, model in product(settings["worlds"], (EXACT, LEARNT))
        for noise in noises[name]
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """By rule and group: the mean of the summed regret and the share of stuck tasks, (n_groups,) each.

    ``rules`` take models for the truth; ``uncertain``: the candidates know that learnt models are uncertain.
    """
    groups = [_group(settings, cell, seed, group) for group in range(settings["groups"])]
    found = {
        kind: {
            name: {key: [group[kind][name][key] for group in groups] for key in ("regret", "stuck")}
            for name in groups[0][kind]
        }
        for kind in groups[0]
    }
    return {**cell, **found}


def _group(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict[str, dict[str, dict[str, float]]]:
    name, noise, model = cell["world"], cell["noise"], cell["model"]
    n_tasks, n_episodes = settings["tasks"], settings["episodes"]
    world = world_of(name, noise, seed, group)
    library = world.library(model, settings["samples"], stream(seed, "O1", "training runs", name, noise, group))
    tasks = stream(seed, "O1", "tasks", name, group)
    types, luck = tasks.integers(len(world.mean), size=n_tasks), tasks.random((n_tasks, n_episodes))
    signals, most = world.pays(types, luck), STUCK * float(np.ptp(world.mean))

    def judged(policies: NDArray[np.int64]) -> dict[str, float]:
        regret = library_regret(world.mean[types], policies)
        stuck = float((late_regret(regret) > most).mean())
        return {"regret": round(float(regret.sum(axis=1).mean()), 4), "stuck": stuck}

    found: dict[str, dict[str, dict[str, float]]] = {"rules": {}}
    for word, rule in RULES.items():
        generator = stream(seed, "O1", "chooser", word, name, noise, model, group)
        found["rules"][word] = judged(play_rule(rule, library, signals, n_tasks, n_episodes, generator).policies)
    if model == LEARNT:
        found[UNCERTAIN] = {}
        for word in CANDIDATES:
            generator = stream(seed, "O1", "doubting", word, name, noise, group)
            played = play_rule(RULES[word], library, signals, n_tasks, n_episodes, generator, models="uncertain")
            found[UNCERTAIN][word] = judged(played.policies)
    return found


def key_of(rule: str) -> str:
    """A rule in the name of a measure."""
    return rule.replace(", ", "_")


def decided_rule(measured: Mapping[str, Mapping[str, Any]], among: Sequence[str] = tuple(RULES)) -> str:
    """The rule that the filed decision names, by the measures of a result.

    It has the least mean of relative regret among the rules that are stuck on at most 5 % of tasks more than the
    least stuck rule in every world. Where there is no such rule, the rule for which the largest of these excesses
    is least.
    """
    excess = {name: measured[f"stuck_above_least_{key_of(name)}"]["value"] for name in among}
    regret = {name: measured[f"regret_{key_of(name)}"]["value"] for name in among}
    allowed = [name for name in among if excess[name] <= MOST_STUCK]
    return min(allowed, key=regret.__getitem__) if allowed else min(among, key=excess.__getitem__)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Regret of each rule relative to the best of each world, and stuck tasks above those of the least stuck."""
    found = {f"regret_{key_of(name)}": mean_estimate(_relative(results, name).mean(axis=0)) for name in RULES}
    found |= {f"stuck_above_least_{key_of(name)}": _largest_excess(results, name) for name in RULES}
    learnt = [result for result in results if UNCERTAIN in result]
    for name, key in ((name, key_of(name)) for name in CANDIDATES):
        uncertain, plug_in = (_relative(learnt, name, kind).mean(axis=0) for kind in (UNCERTAIN, "rules"))
        found[f"regret_{key}_uncertain"] = mean_estimate(uncertain)
        found[f"regret_{key}_uncertain_minus_plug_in"] = difference_estimate(uncertain, plug_in)
        found[f"stuck_above_least_{key}_uncertain"] = _largest_excess(learnt, name, UNCERTAIN)
    return found | _statements(results)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """All worlds, and those of each kind of models and noise."""
    yield {"models": "all", "noise": "all"}, measure(settings, results)
    for model, noise in product((EXACT, LEARNT), NOISES):
        own = [result for result in results if (result["model"], result["noise"]) == (model, noise)]
        if own:
            excess = {"stuck_above_least_IDS": _largest_excess(own, "IDS")}
            yield {"models": model, "noise": noise}, _statements(own) | excess


def _statements(results: Sequence[Mapping]) -> dict[str, Estimate]:
    means = {name: _relative(results, name).mean(axis=0) for name in RULES}
    best = min((name for name in RULES if name != "IDS"), key=lambda name: means[name].mean())
    found = {"regret_IDS_minus_best_other": difference_estimate(means["IDS"], means[best])}
    unequal = [result for result in results if result["noise"] != EQUAL]
    if unequal:
        worse = (_relative(unequal, name).mean(axis=0) for name in ("EI, outcome", "greedy"))
        found["regret_EI_outcome_over_greedy_unequal"] = ratio_estimate(*worse)
    return found


def _relative(results: Sequence[Mapping], rule: str, kind: str = "rules") -> NDArray[np.float64]:
    """Regret of a rule by world and group, in units of the mean regret of the best rule of the world."""
    best = [min(np.mean(found["regret"]) for found in result["rules"].values()) for result in results]
    return np.array([result[kind][rule]["regret"] for result in results]) / np.array(best)[:, None]


def _largest_excess(results: Sequence[Mapping], rule: str, kind: str = "rules") -> Estimate:
    """Share of stuck tasks above that of the least stuck rule, in the world where it is the largest; over groups.

    The interval is of that world alone. As the world is the worst of all, the number is rather too high.
    """
    stuck = {name: np.array([result[kind][name]["stuck"] for result in results]) for name in results[0][kind]}
    shares = {name: own.mean(axis=1) for name, own in stuck.items()}
    world = int((shares[rule] - np.min(list(shares.values()), axis=0)).argmax())
    least = min(shares, key=lambda name: shares[name][world])
    return difference_estimate(stuck[rule][world], stuck[least][world])


PANELS = {"regret": BLUE, "stuck_above_least": ORANGE}


@panels(8.4, 2.8, 1, 2, sharey=True, grid="x")
def draw(result: Mapping, left: Axes, right: Axes) -> None:
    """Relative regret of six selection rules over all worlds, and their largest excess of stuck tasks.

    A dot with its interval a rule; the dotted line is the most that a default may leave stuck.
    """
    for axes, (key, colour) in zip((left, right), PANELS.items(), strict=True):
        for place, rule in enumerate(RULES):
            number = result["measured"][f"{key}_{key_of(rule)}"]
            low, high = number["ci95"] or [number["value"]] * 2
            axes.plot([low, high], [place, place], color=colour, linewidth=2)
            axes.plot(number["value"], place, "o", color=colour, markersize=6)
    left.set(yticks=range(len(RULES)), yticklabels=list(RULES), xlabel="regret / regret of each world's best rule")
    left.invert_yaxis()
    right.axvline(MOST_STUCK, color=GREY, linestyle=(0, (1, 2)))
    right.set_xlabel("stuck tasks above the least stuck rule, worst world")
