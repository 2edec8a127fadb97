"""C4.3: a telephone service that learns from calls, their rewards, or their sum. Thesis: §4.6.2, Figure 4.6.

The service samples the belief. It knows for each caller's type and language model the distribution of the signal
and of the utility, exactly or learnt from so many calls a pair. A caller's uniform numbers are the same whatever
is signalled, so that the signals are compared on the same luck. Callers come in groups; where models are learnt
each group has a library of its own.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.domains.telephone import telephone
from lifelore.domains.telephone.telephone import (
    HUNG_UP,
    OPEN,
    PATHS,
    REWARDS_OF_PATH,
    STATES,
    SUCCESS,
    UTILITIES,
    UTILITY_OF_PATH,
    Telephone,
    reward,
)
from lifelore.figures.style import BLUE, GREY, INK, PAPER, Axes, Figure, new_figure
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.reuse.regret import library_regret
from lifelore.interaction.selection import BeliefSampling
from lifelore.interaction.signals.category_signal import CategorySignal
from reproduction.chapter4.reuse.looks import draw_linear, look_of
from reproduction.chapter4.reuse.many_tasks import LAST, converged_after, grouped_mean, play_rule

SIGNAL_OF_PATH: dict[str, tuple[int, ...]] = {
    "(s, a, s′)": tuple(range(len(PATHS))),
    "(s, a, r)": REWARDS_OF_PATH,
    "U": UTILITY_OF_PATH,
}
"""The signal of each call, by kind of signal: the whole path, its rewards, or their sum."""
N_SIGNALS = {"(s, a, s′)": len(PATHS), "(s, a, r)": len(telephone.REWARD_SEQUENCES), "U": len(UTILITIES)}
SHORT = dict(zip(SIGNAL_OF_PATH, ("sas", "sar", "u"), strict=True))


def ways(settings: Mapping) -> list[dict]:
    """Readings: reading A with each number of language models and calls a pair, None for exact models; B exact.

    The first is the default.
    """
    numbers = settings["models"]
    found = [{"system": "A", "models": n, "samples": k} for n in numbers for k in (None, *settings["samples"])]
    return [*found, {"system": "B", "models": numbers[0], "samples": None}]


def cells(settings: Mapping) -> list[dict]:
    """Every signal in each of the `ways`."""
    return [{**way, "signal": signal} for way in ways(settings) for signal in SIGNAL_OF_PATH]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """All callers of one cell: mean regret by call, and of each caller its sum and when it ended.

    Regret is expected (Definition 4.3.1), so that it is 0 exactly when the preferred model is used. ``ended``: the
    first call from which on there is none.
    """
    phone, signal, samples = (
        Telephone(cell["models"], settings["eta"], cell["system"]),
        cell["signal"],
        cell["samples"],
    )
    n_groups = settings["groups" if samples is None else "learnt_groups"]
    luck = stream(seed, "callers", cell["models"])
    types = luck.integers(phone.n_models, size=(n_groups, settings["users"]))
    uniforms = luck.random((*types.shape, settings["calls"]))
    if samples is None:
        libraries = [exact_library(phone, signal)]
        types, uniforms = types.reshape(1, -1), uniforms.reshape(1, -1, settings["calls"])
    else:
        streams = (stream(seed, "training calls", cell["models"], samples, g) for g in range(n_groups))
        libraries = [learnt_library(phone, signal, own, samples, settings["pseudo_count"]) for own in streams]
    parts = [
        _serve(phone, library, types[group], uniforms[group], signal, stream(seed, "service", group))
        for group, library in enumerate(libraries)
    ]
    regret = np.concatenate(parts)
    return {
        **cell,
        "mean": regret.mean(axis=0).round(4).tolist(),
        "sums": regret.sum(axis=1).round(3).tolist(),
        "ended": converged_after(regret).tolist(),
    }


def exact_library(phone: Telephone, signal: str) -> PolicyLibrary:
    """The service that knows all distributions."""
    probs = {"(s, a, s′)": phone.path_probs, "(s, a, r)": phone.reward_probs, "U": phone.utility_probs}[signal]
    return PolicyLibrary(CategoricalOutcomes(UTILITIES, phone.utility_probs), CategorySignal(probs))


def learnt_library(
    phone: Telephone, signal: str, generator: np.random.Generator, samples: int, pseudo_count: float
) -> PolicyLibrary:
    """The service that has taken `samples` calls of each type with each model."""
    every = np.arange(phone.n_models)
    paths = phone.sample(generator, np.tile(every[:, None, None], (1, len(every), samples)), every[:, None])
    signals = np.array(SIGNAL_OF_PATH[signal])[paths]
    paid = np.array(UTILITIES)[np.array(UTILITY_OF_PATH)[paths]]
    return PolicyLibrary(
        CategoricalOutcomes.from_samples(paid, UTILITIES, pseudo_count),
        CategorySignal.from_samples(signals, N_SIGNALS[signal], pseudo_count),
    )


def _serve(
    phone: Telephone, library: PolicyLibrary, types: NDArray, uniforms: NDArray, signal: str, generator
) -> NDArray:
    """Regret of each call, (n_users, n_calls)."""
    signal_of = np.array(SIGNAL_OF_PATH[signal])

    def signals(call: int, models: NDArray[np.int64]) -> NDArray[np.int64]:
        return signal_of[phone.path_of(uniforms[:, call], types, models)]

    n_users, n_calls = uniforms.shape
    played = play_rule(BeliefSampling(), library, signals, n_users, n_calls, generator)
    return library_regret(phone.mean[types], played.policies)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Exact models, reading A, the first number of language models; sums beside differences."""
    (_, found), *_ = by_way(settings, results)
    sums = {f"sum_{SHORT[name]}": grouped_mean(_grouped(settings, one, "sums")) for name, one in found.items()}
    return sums | compared(settings, found)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Each of the `ways`."""
    for way, found in by_way(settings, results):
        yield {**way, "samples": way["samples"] or "exact"}, compared(settings, found)


def by_way(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Mapping]]]:
    """Each of the `ways` with its results by signal."""
    for way in ways(settings):
        yield way, {result["signal"]: result for result in results if way.items() <= result.items()}


def compared(settings: Mapping, found: Mapping[str, Mapping]) -> dict[str, Estimate]:
    """How much more regret a poorer signal has, and how much more it varies; callers without regret at the end."""
    sums = {name: _grouped(settings, one, "sums") for name, one in found.items()}
    measured = {}
    for better, worse in pairwise(SIGNAL_OF_PATH):
        pair = f"{SHORT[worse]}_minus_{SHORT[better]}"
        spread = [(sums[name] - sums[name].mean()) ** 2 for name in (worse, better)]
        measured[f"regret_{pair}"] = grouped_mean(sums[worse] - sums[better])
        measured[f"variance_{pair}"] = grouped_mean(spread[0] - spread[1])
    last = max(settings["calls"] - LAST + 1, 1)
    for name, one in found.items():
        measured[f"ended_{SHORT[name]}"] = grouped_mean(_grouped(settings, one, "ended") <= last)
    return measured


def _grouped(settings: Mapping, result: Mapping, key: str) -> NDArray[np.float64]:
    return np.array(result[key], float).reshape(-1, settings["users"])


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The default's mean regret by call."""
    (_, found), *_ = by_way(settings, results)
    return [{"signal": name, "regret": one["mean"]} for name, one in found.items()]


SHOWN = 100
"""Calls drawn: later ones are without regret."""
PLACES = dict(zip(STATES, ((0, 0), (4, 0), (8, 0), (11, 0), (6, 2.5), (6, -2.5)), strict=True))
"""Where the states stand in the picture of the calls' transition system."""


def draw(result: Mapping) -> Figure:
    """The calls' transition system, and regret by kind of signal (Figures 4.5 and 4.6).

    The system above; regret of each call, and summed up to it, where the signals differ most, below.
    """
    rows, settings = result["rows"], result["settings"]
    figure = new_figure(8.6, 6.2)
    top, bottom = figure.subfigures(2, 1, height_ratios=[1, 1.1])  # pyright: ignore
    draw_call_graph(top.subplots())
    left, right = bottom.subplots(1, 2)
    curves = {row["signal"]: row["regret"][:SHOWN] for row in rows}
    draw_linear(left, curves, 1, title="Regret of a call", xlabel="call")
    sums = {name: np.cumsum(values).tolist() for name, values in curves.items()}
    draw_linear(right, sums, 1, title="Regret summed up to the call", xlabel="call")
    for name, values in sums.items():
        shift = {"(s, a, s′)": -7, "(s, a, r)": 7}.get(name, 0)
        right.annotate(
            f"{name} {values[-1]:.1f}", (len(values), values[-1]), (4, shift), textcoords="offset points",
            va="center", fontsize=8, color=look_of(name)["color"],
        )  # fmt: skip
    for axes in (left, right):
        axes.lines[0].set_linewidth(4)  # the first two nearly coincide
    left.legend(title="signal")
    n = settings["groups"] * settings["users"]
    bottom.suptitle(f"{n:,} callers, {settings['models'][0]} language models, exact models", x=0.01, ha="left")
    return figure


def draw_call_graph(axes: Axes) -> None:
    """The states of a call, those that end it with thick rims; each edge with its probability and reward."""
    import networkx as nx

    graph = nx.DiGraph()
    for state in OPEN:
        for after, words in ((state + 1, "η"), (SUCCESS, "(1−η)ρ"), (HUNG_UP, "(1−η)(1−ρ)")):
            graph.add_edge(STATES[state], STATES[after], label=f"{words}\n[{reward(state, after):g}]")
    rims = [1.2 if STATES.index(name) in OPEN else 3.0 for name in graph]
    nx.draw_networkx(
        graph, PLACES, ax=axes, node_size=1600, node_color=PAPER, edgecolors=INK, linewidths=rims, font_size=6,
        edge_color=GREY, arrowsize=12,
    )  # fmt: skip
    nx.draw_networkx_edge_labels(
        graph, PLACES, nx.get_edge_attributes(graph, "label"), label_pos=0.58, ax=axes, rotate=False, font_size=7,
        font_color=BLUE, bbox={"fc": PAPER, "ec": "none", "pad": 0.5},
    )  # fmt: skip
    axes.margins(0.08, 0.2)
    axes.axis("off")
