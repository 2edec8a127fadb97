"""`bench lived_relations`: what a robot's own picks teach its model of relations.

A round is a life of tabletop jobs by the whole agent, which sees points with labels. What falls when an object is
lifted, and what stays, labels pairs of the perceived trays (`pick_lessons`). Each label that learning would use is
compared with the forces on that tray, and so is what perception believed of the pair before the pick. Then a model
learns from the trays of the life, and from nothing else; it and the shipped model judge pairs of simulated scenes
that neither has seen.
"""

import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import at_least, estimated_row
from lifelore.agent.long_lived.families.by_name import TABLETOP_TYPES
from lifelore.agent.long_lived.families.pick_lessons import Lesson
from lifelore.agent.long_lived.families.tabletop import TabletopFamily
from lifelore.agent.long_lived.families.tabletop_task import TabletopTask
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, live_task
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.agent.perceive.relation_memory import LabelledScene, joined
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.metrics import mean_estimate
from lifelore.core.protocols import Progress
from lifelore.core.relations import BOTH, ON, SYMMETRIC, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import tabletop_scenes
from lifelore.domains.tabletop.truth import SHARE, bearing
from lifelore.domains.tabletop_job.job import TabletopJob
from lifelore.domains.task_stream import TaskStream
from lifelore.perception.pairs.scene_pairs import scene_pairs
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from reproduction.engine.cell_store import CellStore
from reproduction.engine.source_key import source_key

TASKS, SCENES = 120, 60
"""Tasks of a life, some four minutes of a core, and simulated scenes on which models are judged."""
LEAST = 2
"""Least confidence of labels that count: the models learn from no others."""
LABELS_BETTER = "right about carrying, labels less perception"
MODEL_BETTER = "exact relation, model of the life less shipped"
OUT = Path("benchmarks/results")


@dataclass(frozen=True)
class LivedRound:
    """Counts of a life and of the scenes after it.

    tasks, scenes : tasks of the life, and trays of which picks have shown something
    pairs, labels : labelled pairs, and those of them whose label has the confidence that learning asks for
    right, right_before : of those labels, how many say truly who carries whom, and how often perception did
    corrected, spoilt : labels that are right where perception was wrong, and the other way round
    judged, lived, shipped : pairs of the simulated scenes, and how many relations each model names exactly
    """

    tasks: int
    scenes: int
    pairs: int
    labels: int
    right: int
    right_before: int
    corrected: int
    spoilt: int
    judged: int
    lived: int
    shipped: int


def bench_lived_relations(repeats: int, progress: Progress, out: Path = OUT) -> dict[str, Any]:
    """Rows and goals; see `benchmarks.bench`. Rows also have ``ci95`` and ``n``, the lives.

    A bench that was stopped goes on with the life that it was in.
    """
    store = CellStore(out / "cells" / "lived_relations", {"code": source_key(__name__)})
    rounds: list[LivedRound] = []
    for number in range(repeats):
        cell = {"round": number, "tasks": TASKS, "scenes": SCENES}
        kept = store.get(cell)
        if kept is None:
            began = time.perf_counter()
            found = lived_round(number)
            store.put(cell, asdict(found), round(time.perf_counter() - began, 1))
        else:
            found = LivedRound(**kept["result"])
        rounds.append(found)
        progress(number + 1, repeats, f"life {number + 1}")
    return report(rounds)


def lived_round(number: int) -> LivedRound:
    """A life, and the model that learns from it."""
    scenes, pairs, judged = [], 0, list[tuple[bool, bool]]()
    for task in _life(number):
        for actions, lesson in task.lessons().items():
            taken = tuple(verb * task.job.n_objects + k for verb, k in actions)
            carried = task.job.tree.seen(taken, "carried", carried_shares)
            scenes.append(LabelledScene(lesson.tray.pairs, lesson.labels))
            pairs += len(lesson.labels)
            judged += judged_lesson(lesson, carried)
    label, before = np.array(judged, np.bool_).reshape(-1, 2).T
    scenes = joined((), scenes)
    model = RelationClassifier().fit_pairs([scene.pairs for scene in scenes], [scene.truth for scene in scenes])
    answers = _answers(number, (model, shipped_model()))
    return LivedRound(
        TASKS,
        len(scenes),
        pairs,
        len(judged),
        int(label.sum()),
        int(before.sum()),
        int((label & ~before).sum()),
        int((before & ~label).sum()),
        len(answers),
        sum(ours for ours, _ in answers),
        sum(shipped for _, shipped in answers),
    )


def _life(number: int) -> Iterator[TabletopTask]:
    """The tasks of a life, each after it was lived."""
    seed = _seed("life", number)
    family = TabletopFamily(TaskStream(TABLETOP_TYPES, seed=seed), seed, labelled=True)
    knowledge, full = Knowledge.empty(family), AGENTS["full"]
    for place in range(TASKS):
        drawn, task = family.meet(place, full)
        assert isinstance(task, TabletopTask)
        live_task(knowledge, drawn, task, full, LivingSettings(), f"robot.{place}", seed)
        yield task


def _seed(purpose: str, number: int) -> int:
    return int(stream(0, "bench", "lived relations", purpose, number).integers(1 << 31))


def carried_shares(job: TabletopJob) -> NDArray[np.float64]:
    """Share of each object's weight (row) that each other object (column) carries now, as truth counts it."""
    borne = bearing(*job.contacts())
    return np.maximum(borne.share, borne.lift)[:-1, :-1]


def judged_lesson(lesson: Lesson, carried: NDArray[np.float64]) -> list[tuple[bool, bool]]:
    """By label that learning uses: whether it says truly who carries whom, and whether perception did before."""
    number = {label: k for k, label in lesson.tray.label.items()}
    before = {frozenset((belief.a, belief.b)): belief.best() for belief in lesson.tray.beliefs}
    found = []
    for label in lesson.labels:
        if label.confidence >= LEAST:
            a, b = label.a, label.b
            up, down = (bool(carried[number[x], number[y]] > SHARE) for x, y in ((a, b), (b, a)))
            true = (a, b) if up else (b, a) if down else None
            found.append((_carrying(label) == true, _carrying(before[frozenset((a, b))]) == true))
    return found


def _carrying(said: PairLabel | Relation) -> tuple[int, int] | None:
    """Who is carried, and by whom."""
    return (said.a, said.b) if said.relation in (ON, BOTH) else None


def _answers(number: int, models: Sequence[RelationClassifier]) -> list[tuple[bool, ...]]:
    """By pair of objects in simulated scenes: whether each model names its relation exactly."""
    found = []
    for scene in tabletop_scenes(SCENES, _seed("scenes", number)):
        seen = scene_pairs(scene.cloud)
        truth = {
            frozenset((label.a, label.b)): label
            for label in scene.truth
            if label.confidence >= LEAST and label.b != TABLE
        }
        said = [{frozenset((one.a, one.b)): one.best() for one in model.beliefs_of(seen)} for model in models]
        near = truth.keys() & set[frozenset[int]]().union(*said)
        found += [tuple(pair in one and exact(one[pair], truth[pair]) for one in said) for pair in near]
    return found


def exact(said: Relation, true: PairLabel) -> bool:
    """Whether a relation is the true one, in the true order where it has one."""
    return said.relation == true.relation and (true.relation in SYMMETRIC or (said.a, said.b) == (true.a, true.b))


def report(rounds: Sequence[LivedRound]) -> dict[str, Any]:
    """Rows and goals of some lives."""
    counts = {name: np.array([asdict(one)[name] for one in rounds], np.float64) for name in asdict(rounds[0])}
    labels, judged, tasks = counts["labels"], counts["judged"], counts["tasks"]
    values = {
        ("labelled pairs", "a task"): counts["pairs"] / tasks,
        ("labelled pairs that a model learns from", "a task"): labels / tasks,
        ("trays that a model learns from", "a life"): counts["scenes"],
        ("right about carrying, labels", "share"): counts["right"] / labels,
        ("right about carrying, perception before", "share"): counts["right_before"] / labels,
        (LABELS_BETTER, "share"): (counts["right"] - counts["right_before"]) / labels,
        ("labels that correct perception", "a life"): counts["corrected"],
        ("labels that are wrong where perception was right", "a life"): counts["spoilt"],
        ("pairs of simulated scenes", "a life"): judged,
        ("exact relation, model of the life", "share"): counts["lived"] / judged,
        ("exact relation, shipped model", "share"): counts["shipped"] / judged,
        (MODEL_BETTER, "share"): (counts["lived"] - counts["shipped"]) / judged,
    }
    rows = [estimated_row(name, mean_estimate(found), unit) for (name, unit), found in values.items()]
    measured = {line["name"]: line["value"] for line in rows}
    return {"rows": rows, "goals": [at_least(name, 0.0, measured[name]) for name in (LABELS_BETTER, MODEL_BETTER)]}
