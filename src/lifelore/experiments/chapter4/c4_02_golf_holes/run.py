"""C4.2: a hundred unknown holes of 120 to 220 yards: error and belief by shot, beside single clubs.

What each was given: the rules four clubs on four training holes, exactly or from `samples` shots a pair, and
after each shot its category; a single club nothing; the best club the hole's distance. The dynamic program (Eq.
4.3, three shots) knows the models and that the hole is one of the four, and is the best that can be done then.

Headline: greedy selection with models learnt from samples; no hole played is a training hole.

Thesis: §4.6.1, Figure 4.4.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.golf.golf import Golf
from lifelore.experiments.chapter4.c4_02_golf_holes.golf_programs import GIVEN, program_gaps
from lifelore.experiments.chapter4.golf_runs import (
    EXACT,
    LEARNT,
    WOOD,
    draw_group,
    errors_of,
    library_of,
    play_holes,
)
from lifelore.experiments.chapter4.reuse_rules import RULES_SHOWN
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import exact_share
from lifelore.experiments.engine.learning_settings import check_counts
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "groups": 100,
    "holes": 100,
    "yards": [120.0, 220.0],
    "shots": 8,
    "samples": 10,
    "pseudo_count": 0.5,
    "horizon": 3,
}
QUICK = {**FULL, "groups": 4, "holes": 40}
GREEDY = "greedy"
NEAR = 15.0
"""Yards: the far end of "10–15"."""


def _check(settings: Mapping) -> None:
    check_counts(settings, ("groups", "holes", "samples", "horizon"))
    check_counts(settings, ("shots",), 2)
    yards = settings["yards"]
    if np.shape(yards) != (2,) or not 0 < yards[0] <= yards[1]:
        raise InputError(f"yards must be two distances, rising, above 0, got {yards}")
    if settings["pseudo_count"] < 0:
        raise InputError(f"pseudo_count must be at least 0, got {settings['pseudo_count']}")


def cells(settings: Mapping) -> list[dict]:
    """Each rule on each kind of model, greedy also with the 3-wood first, single clubs, and the program."""
    played = [
        {"part": "rule", "model": m, "rule": name, "first": None} for m in (LEARNT, EXACT) for name in RULES_SHOWN
    ]
    forced = [{"part": "rule", "model": m, "rule": GREEDY, "first": WOOD} for m in (LEARNT, EXACT)]
    return [*played, *forced, {"part": "clubs"}, {"part": "program"}]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Means of each group of holes: error by shot, entropy before each shot and after the last."""
    if cell["part"] == "program":
        return {**cell, "found": program_gaps(settings["horizon"])}
    groups = [
        (_clubs_of if cell["part"] == "clubs" else _rule_of)(settings, cell, seed, group)
        for group in range(settings["groups"])
    ]
    keys = groups[0].keys()
    return {**cell, **{key: [group[key] for group in groups] for key in keys}}


def _rule_of(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict:
    distance, luck = draw_group(settings, seed, group)
    library = library_of(settings, cell["model"], seed, group)
    found = play_holes(RULES_SHOWN[cell["rule"]], library, distance, luck, seed + group, cell["first"])
    return {
        "error": np.abs(found.error).mean(axis=0).round(5).tolist(),
        "entropy": found.entropy.mean(axis=0).round(6).tolist(),
    }


def _clubs_of(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict:
    """What single clubs miss by at the second shot's luck, and the best club for the hole in retrospect."""
    distance, luck = draw_group(settings, seed, group)
    golf = Golf()
    missed = [np.abs(errors_of(np.full(len(luck), j), distance, luck[:, 1])) for j in range(golf.n_clubs)]
    best = golf.mean_at(distance).argmax(axis=1)
    return {
        "club": [round(float(m.mean()), 5) for m in missed],
        "best": round(float(np.abs(errors_of(best, distance, luck[:, 1])).mean()), 5),
    }


def _of(results: Sequence[Mapping], key: str, **wanted) -> np.ndarray:
    """The numbers `key` of the one cell that has all of `wanted`, a row a group."""
    return np.array(next(r[key] for r in results if all(r.get(k) == v for k, v in wanted.items())), float)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Greedy selection by model, what it gains over one club, and each rule's gap to the program."""
    measured = {}
    clubs, best = _of(results, "club", part="clubs"), _of(results, "best", part="clubs")
    for model in (LEARNT, EXACT):
        error = _of(results, "error", model=model, rule=GREEDY, first=None)
        entropy = _of(results, "entropy", model=model, rule=GREEDY, first=None)
        wood = _of(results, "error", model=model, rule=GREEDY, first=WOOD)
        measured |= {
            f"error_shot_1_{model}": mean_estimate(error[:, 0]),
            f"error_shot_2_{model}": mean_estimate(error[:, 1]),
            f"error_last_{model}": mean_estimate(error[:, -1]),
            f"error_shot_2_wood_first_{model}": mean_estimate(wood[:, 1]),
            f"groups_within_15_{model}": exact_share((error[:, 1] <= NEAR).tolist()),
            f"gain_over_best_single_club_{model}": mean_estimate(
                clubs[:, clubs.mean(axis=0).argmin()] - error[:, 1]
            ),
            f"more_than_best_club_{model}": mean_estimate(error[:, 1] - best),
            f"entropy_fall_first_{model}": mean_estimate(entropy[:, 0] - entropy[:, 1]),
            f"entropy_fall_later_{model}": mean_estimate(entropy[:, 1] - entropy[:, -1]),
        }
    for name, way in next(r["found"] for r in results if r["part"] == "program").items():
        measured[f"gap_{name.replace(' ', '_').replace(',', '')}"] = Estimate(way["gap"], way["gap"], None, 1)
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Curves of every rule, single clubs, and the program's values."""
    kept = []
    for result in results:
        row = {key: value for key, value in result.items() if key in ("part", "model", "rule", "first")}
        if result["part"] == "program":
            kept += [{**row, "way": name, "given": GIVEN, **way} for name, way in result["found"].items()]
            continue
        for key in ("error", "entropy", "club", "best"):
            if key in result:
                of_groups = np.array(result[key], float)
                row[key] = of_groups.mean(axis=0).round(4).tolist()
                if key == "error":
                    row["worst_groups"] = np.quantile(of_groups, 0.95, axis=0).round(3).tolist()
        kept.append(row)
    return kept


def _draw(result: Mapping):
    from lifelore.experiments.chapter4.c4_02_golf_holes.figure_golf_curves import draw_golf_curves

    return draw_golf_curves(result)


CLAIM = Claim(
    id="C4.2",
    title="A hundred unknown golf holes (Figure 4.4)",
    thesis="Over 100 unknown holes of 120 to 220 yards greedy selection has by the second shot a club that brings "
    "the ball within 10–15 yards of the hole, while the entropy of the belief falls; single clubs and the best "
    "club in retrospect are shown for comparison.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C4.2"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    check=_check,
)
