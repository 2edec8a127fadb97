"""C4.8: regret by size of the library and number of episodes. Thesis: §4.6.4, Figure 4.12.

Regret is counted against the best of all 68 policies. By Definition 4.3.1 it is counted against the best policy of
the *library*: a library without a good policy for a task has next to no regret on it.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.figures.style import BLUE, SKY, Axes
from lifelore.interaction.reuse.regret import library_regret
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, play_rule
from reproduction.chapter4.reuse.rules import RULES
from reproduction.chapter4.surveillance.runs import draw_tasks, library_of
from reproduction.figures.panels import panels

EVERY = tuple(product((LEARNT, EXACT), ("EI", "EI, printed")))
"""Models and rules; the first is the default."""
BESTS = ("all", "library")
"""The policies with whose best regret compares."""


def cells(settings: Mapping) -> list[dict]:
    """Every size of the library with each kind of models and form of expected improvement."""
    shares = sorted(set(settings["shares"]))
    return [{"models": models, "rule": rule, "share": share} for (models, rule), share in product(EVERY, shares)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean regret up to each number of episodes, trial by trial, (n_trials, n_episodes) against each best.

    A trial's task, noise and order of policies are the same for all cells: a larger library holds the smaller.
    """
    world, counts = Surveillance(), sorted(set(settings["episodes"]))
    found: dict[str, list] = {key: [] for key in BESTS}
    for trial in range(settings["trials"]):
        order = stream(seed, "library", trial).permutation(world.n_targets)
        part = np.sort(order[: max(1, round(cell["share"] * world.n_targets))])
        task = draw_tasks(world, 1, counts[-1], seed, trial)
        library = library_of(world, cell["models"], settings["samples"], seed, trial)
        library = library.take(part.tolist(), part.tolist())
        mean = task.mean[:, part]

        def pays(episode: int, policies: np.ndarray, mean=mean, task=task) -> np.ndarray:
            return mean[0, policies] + world.deviation * task.noise[:, episode]

        generator = stream(seed, "chooser", cell["rule"], trial)
        chosen = play_rule(RULES[cell["rule"]], library, pays, 1, counts[-1], generator).policies
        regrets = {"all": library_regret(task.mean, part[chosen]), "library": library_regret(mean, chosen)}
        for key, regret in regrets.items():
            found[key].append([round(float(regret[0, :k].mean()), 3) for k in counts])
    return {**cell, **found}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Expected improvement with learnt models; beside it regret against the library's best, and both ends."""
    regret = _regret(results, *EVERY[0])
    return _saved(regret) | {
        "library_saved_by_size": _saved(_regret(results, *EVERY[0], "library"))["saved_by_size_late"],
        "first": mean_estimate(regret[0, :, 0]),
        "last": mean_estimate(regret[-1, :, -1]),
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Each kind of models with each form of expected improvement."""
    for models, rule in EVERY:
        yield {"models": models, "rule": rule}, _saved(_regret(results, models, rule))


def _regret(results: Sequence[Mapping], models: str, rule: str, best: str = "all") -> np.ndarray:
    """Mean regret, (n_shares, n_trials, n_counts)."""
    return np.array([one[best] for one in results if (one["models"], one["rule"]) == (models, rule)], float)


def _saved(regret: np.ndarray) -> dict[str, Estimate]:
    """Regret that the largest library saves beside the smallest, and all episodes beside the first, paired."""
    small, whole = regret[0], regret[-1]
    return {
        "saved_by_size_early": difference_estimate(small[:, 0], whole[:, 0]),
        "saved_by_size_late": difference_estimate(small[:, -1], whole[:, -1]),
        "saved_by_episodes_small": difference_estimate(small[:, 0], small[:, -1]),
        "saved_by_episodes_whole": difference_estimate(whole[:, 0], whole[:, -1]),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The default's mean regret by size of the library and number of episodes."""
    mean = _regret(results, *EVERY[0]).mean(axis=1).round(2)
    counts, shares = sorted(set(settings["episodes"])), sorted(set(settings["shares"]))
    return [{"episodes": k, "shares": shares, "regret": of.tolist()} for k, of in zip(counts, mean.T, strict=True)]


@panels(6.4, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """Mean regret by size of the library and number of episodes (Figure 4.12).

    A line for each number of episodes over the size of the library.
    """
    from matplotlib.colors import LinearSegmentedColormap

    rows = result["rows"]
    shades = LinearSegmentedColormap.from_list("episodes", [SKY, BLUE, "#0b2a4a"])(np.linspace(0, 1, len(rows)))
    for row, shade in zip(rows, shades, strict=True):
        axes.plot([100 * s for s in row["shares"]], row["regret"], "o-", color=shade, ms=4, label=row["episodes"])
    axes.set(ylim=(0, None), xlabel="size of the library (% of 68 types)", ylabel="average episodic regret")
    axes.set_title(f"BPR-EI, {result['settings']['trials']} random tasks")
    axes.figure.legend(*axes.get_legend_handles_labels(), title="episodes", loc="outside right upper")
