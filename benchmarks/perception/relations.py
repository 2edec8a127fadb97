"""`bench relations`: how right relations are, ours beside the thesis's method and its peers; what they survive.

Everybody learns from the same simulated scenes and is judged on others of other shapes; on real scenes, untrained
on any; and on each real scene after learning from all the others as well. The model that ships with the package is
judged as it is, and is what the goals of simulation are about; also on arrangements of books, boxes and cartons.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from benchmarks.perception.relation_differences import difference_rows
from benchmarks.perception.relation_learners import (
    LEARNERS,
    LOGIC,
    OURS,
    SHIPPED,
    SeenScene,
    asked,
    taught,
)
from benchmarks.perception.relation_scenes import (
    HALF,
    HELD_OUT,
    LABELS,
    LEARNT,
    NOISE,
    TENTH,
    THINNED,
    THIRD,
    SpoiltScene,
    seen_simulated,
    spoilt_real,
    spoilt_simulated,
)
from benchmarks.perception.shipped_relations import (
    ARRANGED_SCENES,
    ARRANGEMENTS,
    calibration_error,
    judged_arrangement,
)
from benchmarks.rounds import at_least, at_most, estimated_row, row
from lifelore.core.metrics import Estimate
from lifelore.core.protocols import Progress
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, tabletop_scenes
from lifelore.perception.relations.relation_classifier import shipped_model
from reproduction.chapter2.scenes.real_scenes import real_scenes_folder
from reproduction.chapter2.scoring.relation_scoring import JudgedPair, difference, score, share

LEARNT_SCENES, JUDGED_SCENES = 60, 40
"""A round; four to five pairs of things each."""
SIMULATED, REAL, WITH_OTHERS = "simulated", "real", "real, learnt from the others too"
MOST_LOST = {THIRD: 0.01, TENTH: 0.04, NOISE: 0.02, LABELS: 0.02}
SAME_NODES = {HALF: 0.95, THIRD: 0.93}
MOST_SHIFT = 0.003
Answers = dict[str, list[JudgedPair]]


def bench_relations(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`. Each round adds scenes, all are judged together."""
    real = spoilt_real() if real_scenes_folder() else []
    after = _counter(progress, repeats, len(real))
    lessons = [seen_simulated(scene) for scene in _drawn(LEARNT_SCENES * repeats, LEARNT, after)]
    tests = [spoilt_simulated(scene) for scene in _drawn(JUDGED_SCENES * repeats, HELD_OUT, after)]
    answers = {
        SIMULATED: _from_lessons(lessons, [test.scene for test in tests], after),
        REAL: _from_lessons(lessons, [test.scene for test in real], after),
        WITH_OTHERS: _leaving_one_out(lessons, [test.scene for test in real], after),
    }
    shipped = shipped_model()
    arranged = {f"{SIMULATED} {name}": judged_arrangement(name, repeats, shipped, after) for name in ARRANGEMENTS}
    everywhere = answers | arranged
    rows = [line for where, said in everywhere.items() for line in _score_rows(where, said)]
    rows += [line for where, said in everywhere.items() for line in _calibration_rows(where, said)]
    for where, said in answers.items():
        rows += difference_rows(where, {who: _things(judged, where) for who, judged in said.items()})
    lost = _lost(tests)
    networks = {SIMULATED: tests, REAL: real}
    rows += [
        estimated_row(f"{SHIPPED + LOGIC}, simulated, exact lost, {way}", estimate, "share")
        for way, estimate in lost.items()
    ]
    rows += [line for where, scenes in networks.items() for line in _network_rows(where, scenes)]
    return {"rows": rows, "goals": _goals(answers, lost, networks)}


def _counter(progress: Progress, repeats: int, real: int) -> Callable[[str], None]:
    learners = len(LEARNERS)
    drawn = LEARNT_SCENES + JUDGED_SCENES + len(ARRANGEMENTS) * ARRANGED_SCENES
    total = drawn * repeats + learners + (learners * (1 + real) if real else 0)
    done = 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, label)

    return after


def _drawn(n: int, which: tuple[int, str], after: Callable[[str], None]) -> Iterator[TabletopScene]:
    """Simulated scenes one by one: their points are many, and nobody keeps them."""
    seed, shapes = which
    for scene in tabletop_scenes(n, seed, TabletopSettings(shapes=shapes)):
        yield scene
        after("scenes drawn and seen")


def _from_lessons(lessons: Sequence[SeenScene], scenes: Sequence[SeenScene], after) -> Answers:
    """Everybody's answers after learning from `lessons`, and those of the shipped model."""
    if not scenes:
        return {}
    answers: Answers = {}
    for name in LEARNERS:
        answers |= asked(name, taught(name, lessons), scenes)
        after(f"{name} judged")
    return answers | asked(SHIPPED, shipped_model(), scenes)


def _leaving_one_out(lessons: Sequence[SeenScene], real: Sequence[SeenScene], after) -> Answers:
    """Everybody's answers on each real scene after learning from `lessons` and all other real scenes."""
    answers: Answers = {}
    for name in LEARNERS:
        for number, scene in enumerate(real):
            model = taught(name, [*lessons, *real[:number], *real[number + 1 :]])
            for who, judged in asked(name, model, [scene]).items():
                answers.setdefault(who, []).extend(judged)
            after(f"{name} on {scene.name}")
    return answers


def _things(judged: Iterable[JudgedPair], where: str) -> list[JudgedPair]:
    """Pairs of things; in simulation, where the gap alone makes the label, without those near the limit."""
    return [pair for pair in judged if not pair.with_table and not (where.startswith(SIMULATED) and pair.border)]


def _with_table(judged: Iterable[JudgedPair]) -> list[JudgedPair]:
    return [pair for pair in judged if pair.with_table]


def _score_rows(where: str, answers: Answers) -> list[dict]:
    rows = []
    for who, judged in answers.items():
        found = score(_things(judged, where))
        if found is None:
            continue
        measures = {
            "exact": found.exact,
            "on": found.on,
            "adjacent": found.adjacent,
            "macro F1": found.macro_f1,
            **{f"recall of {name}": recall for name, recall in found.recall.items()},
        }
        apart = {
            "pairs with the table": _with_table(judged),
            "pairs near the gap's limit": [p for p in judged if where.startswith(SIMULATED) and p.border],
            "pairs that look over 3 cm apart": [p for p in judged if p.hidden and not p.with_table],
        }
        measures |= {
            f"exact, {name}": share(part, lambda pair: pair.exact) for name, part in apart.items() if part
        }
        rows += [
            estimated_row(f"{who}, {where}, {name}", estimate, "share") for name, estimate in measures.items()
        ]
    return rows


def _calibration_rows(where: str, answers: Answers) -> list[dict]:
    """Calibration errors of the shipped model, of pairs of objects and of pairs with the table."""
    judged = answers.get(SHIPPED + LOGIC, [])
    parts = {"calibration error": _things(judged, where), "calibration error, table": _with_table(judged)}
    return [
        row(f"{SHIPPED + LOGIC}, {where}, {name}", calibration_error(part), "probability") | {"n": len(part)}
        for name, part in parts.items()
        if part
    ]


def _lost(tests: Sequence[SpoiltScene]) -> dict[str, Estimate]:
    """Share of exact answers that the shipped model loses in each way scenes are spoilt."""
    model, who = shipped_model(), SHIPPED + LOGIC
    whole = _things(asked(SHIPPED, model, [test.scene for test in tests])[who], SIMULATED)
    lost = {}
    for way in tests[0].spoilt:
        spoilt = asked(SHIPPED, model, [test.spoilt[way] for test in tests])[who]
        lost[way] = difference(whole, _things(spoilt, SIMULATED))
    return lost


def _network_rows(where: str, tests: Sequence[SpoiltScene]) -> list[dict]:
    rows = []
    for way in THINNED:
        same, shift, n = _stable(tests, way)
        rows.append(row(f"networks, {where}, same number of nodes, {way}", same, "share") | {"n": n})
        rows.append(row(f"networks, {where}, median shift of a node, {way}", shift, "m") | {"n": n})
    return rows


def _stable(tests: Sequence[SpoiltScene], way: str) -> tuple[float | None, float | None, int]:
    """Share of networks with the same number of nodes, the median shift of those, and how many there are."""
    same = [answer for test in tests for answer in test.networks[way].same_count]
    shifts = [shift for test in tests for shift in test.networks[way].shifts]
    if not same:
        return None, None, 0
    return float(np.mean(same)), float(np.median(shifts)) if shifts else None, len(same)


def _goals(answers: dict[str, Answers], lost: dict[str, Estimate], networks: dict) -> list[dict]:
    ours, shipped = OURS + LOGIC, SHIPPED + LOGIC
    goals = [
        *_accuracy(SIMULATED, shipped, answers, 0.92, 0.97),
        *_accuracy(REAL, shipped, answers, 0.75, 0.92, 0.94),
        *_accuracy(WITH_OTHERS, ours, answers, 0.82, 0.95, 0.94),
    ]
    goals += [at_most(f"{shipped}, exact lost, {way}", most, lost[way].value) for way, most in MOST_LOST.items()]
    for where, tests in networks.items():
        stable = {way: _stable(tests, way) for way in THINNED}
        goals += [
            at_least(f"networks, {where}, same number of nodes, {way}", least, stable[way][0])
            for way, least in SAME_NODES.items()
        ]
        goals.append(at_most(f"networks, {where}, median shift, {THIRD}, m", MOST_SHIFT, stable[THIRD][1]))
    return goals


def _accuracy(
    where: str, who: str, answers: dict[str, Answers], exact: float, on: float, table: float | None = None
) -> list[dict]:
    judged = answers[where].get(who, [])
    found, on_table = score(_things(judged, where)), _with_table(judged)
    goals = [
        at_least(f"{who}, {where}, exact", exact, found and found.exact.value),
        at_least(f"{who}, {where}, on", on, found and found.on.value),
    ]
    if table is not None:
        right = share(on_table, lambda pair: pair.exact).value if on_table else None
        goals.append(at_least(f"{who}, {where}, exact, pairs with the table", table, right))
    return goals
