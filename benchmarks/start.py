"""Time to a first answer: of a learner, and of each verb from the shell.

Seconds are those of the processor, so that other programs on the machine count little; they do not contain waits
for the disk. A learner's first result is timed without imports, with an empty and with a filled cache of kernels:
the lattice is enumerated, solved exactly and learnt, and the learnt policy is evaluated. Verbs are whole processes
in three states: *first ever* with no kernel compiled, *first after setup* with the kernels of ``lifelore doctor
--warm``, and *warm*.
"""

import csv
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import repeat
from pathlib import Path
from statistics import median

from benchmarks.process import Cost, cold_and_warm, installed_environment, process_cost
from benchmarks.rounds import Part, at_most, counted, joined, row
from lifelore.agent.personalise.decisions import choose
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.study import open_study
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.tabletop.scene_folder import save_cloud
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.memory import open_memory
from reproduction.chapter2.scenes.real_scenes import real_scenes_folder

COLD, WARM, AFTER_SETUP = 3.0, 0.15, 3.0
"""Most seconds of a learner's first result with and without compiling, and of a verb's first use after setup."""
HELP, LIVE, PERCEIVE, CHOOSE, UPDATE = "--help", "live", "perceive", "reuse choose", "reuse update"
VERB_GOALS = {HELP: 0.3, PERCEIVE: 1.4, CHOOSE: 0.6, UPDATE: 0.6}
"""Most seconds of a warm process."""
FURTHER = 0.5
"""Most seconds of each further cloud in one process."""
COLD_ROUNDS = 3
"""Compiling costs seconds a time and differs little: at most this many rounds of it."""
REAL = ("learn22", "test47", "test49", "test45")
"""Real scenes of three to seven objects; the first is the one cloud, the others are the further ones."""
SIMULATED = (3, 4, 5, 6)
"""Objects of the simulated scenes that stand in for them."""
SEED = 7004
USERS, TYPES, POLICIES, OUTCOMES = 60, 4, 6, 8
"""Of the log that is fitted; each user has `OUTCOMES` lines."""

_FIRST = """
import time
import numpy as np
from lifelore.core.learning.curve import new_curve
from lifelore.core.learning.known_world import unknown_world, known_policy
from lifelore.core.learning.model_learning import ExplorationStrategy, StateInfo, explore, new_model_learner
from lifelore.core.planning.planning import greedy_policy, optimal_q, policy_values
from lifelore.core.streams import stream
from benchmarks.lattice import lattice_task, new_case, run_kernel
started = time.process_time()
tables = lattice_task().tables()
optimal_q(tables, 0.95)
{learn}
policy_values(tables, policy, 0.95)
print(time.process_time() - started)
"""
_Q = """
case = new_case(500)
run_kernel(case)
policy = greedy_policy(case.learner.q)
"""
_MODEL = """
n = tables.n_states
model, explorer = unknown_world(n, 4), new_model_learner(n, 4, stream(0, "world"), stream(0, "own"))
seen = StateInfo(np.zeros(n, np.int64), np.zeros(n, np.int32), np.zeros((1, 4)))
explore(tables, model, seen, ExplorationStrategy(), explorer, new_curve(20), 1000, 0.95, 10**9)
policy = known_policy(model, explorer.place)
"""
LEARNERS = {"q": _FIRST.format(learn=_Q), "model": _FIRST.format(learn=_MODEL)}
"""Programs that print the seconds of a first result."""

Arguments = Iterator[Sequence[object]]
"""The arguments of each process of a verb."""


def bench_start(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    cold = min(repeats, COLD_ROUNDS)
    after = counted(progress, cold * len(LEARNERS) + 1 + 5 + 6 * repeats + 5)
    with tempfile.TemporaryDirectory() as folder:
        return joined(_learners(cold, after), _verbs(Path(folder), repeats, after))


def _learners(rounds: int, after: Callable[[str], None]) -> Part:
    """First results with an empty and with a filled cache of kernels, imports apart."""
    rows, goals = [], []
    for learner, source in LEARNERS.items():
        name, times = f"first result of learner {learner}", []
        for _ in range(rounds):
            times.append(cold_and_warm(source))
            after(name)
        cold, warm = (median(column) for column in zip(*times, strict=True))
        rows += [row(f"{name}, cold", cold, "s"), row(f"{name}, warm", warm, "s", f"{name}, cold", warm / cold)]
        goals += [at_most(f"{name}, cold, s", COLD, cold), at_most(f"{name}, warm, s", WARM, warm)]
    return rows, goals


def _verbs(folder: Path, repeats: int, after: Callable[[str], None]) -> Part:
    clouds, what = clouds_to_perceive(folder)
    study = fitted_study(folder)
    verbs: dict[str, Arguments] = {
        HELP: repeat(["--help"]),
        LIVE: repeat(["live", "--tasks", 1, "--memory", folder / "life.db"]),
        PERCEIVE: repeat(["perceive", clouds[0], "--json"]),
        CHOOSE: repeat(["reuse", "choose", "--user", "ann", "--memory", study]),
        UPDATE: (
            ["reuse", "update", "--decision", decision, "--outcome", 1, "--memory", study]
            for decision in open_decisions(study, repeats + 2)
        ),
    }
    ready = installed_environment(folder, folder / "setup")
    process_cost(next(verbs[HELP]), ready)
    setup = process_cost(["doctor", "--warm"], ready)
    after("lifelore doctor --warm")
    first = _each(verbs, ready, after, "first after setup")
    warm: dict[str, list[Cost]] = {verb: [] for verb in verbs}
    further = []
    for _ in range(repeats):
        for verb, cost in _each(verbs, ready, after, "warm").items():
            warm[verb].append(cost)
        together = process_cost(["perceive", *clouds, "--json"], ready)
        further.append((together.cpu - warm[PERCEIVE][-1].cpu) / (len(clouds) - 1))
        after("further clouds")
    ever = {}
    for verb, arguments in verbs.items():
        ever[verb] = process_cost(next(arguments), installed_environment(folder, folder / f"empty {len(ever)}"))
        after(f"lifelore {verb}, first ever")
    return _verb_lines(setup, ever, first, warm, further, what)


def _each(
    verbs: Mapping[str, Arguments], environment: dict[str, str], after: Callable[[str], None], label: str
) -> dict[str, Cost]:
    costs = {}
    for verb, arguments in verbs.items():
        costs[verb] = process_cost(next(arguments), environment)
        after(f"lifelore {verb}, {label}")
    return costs


def _verb_lines(
    setup: Cost,
    ever: Mapping[str, Cost],
    first: Mapping[str, Cost],
    warm: Mapping[str, Sequence[Cost]],
    further: Sequence[float],
    cloud: str,
) -> Part:
    rows, goals = [row("lifelore doctor --warm, with nothing compiled", setup.cpu, "s")], []
    for verb in warm:
        usual = median(cost.cpu for cost in warm[verb])
        name = f"lifelore {verb}" + (f" of {cloud}" if verb == PERCEIVE else "")
        states = {"first after setup": first[verb].cpu, "warm": usual}
        rows.append(row(f"{name}, first ever", ever[verb].cpu, "s"))
        rows += [
            row(f"{name}, {state}", seconds, "s", f"{name}, first ever", seconds / ever[verb].cpu)
            for state, seconds in states.items()
        ]
        if verb != HELP:
            goals.append(at_most(f"{name}, first after setup, s", AFTER_SETUP, first[verb].cpu))
        if verb in VERB_GOALS:
            goals.append(at_most(f"{name}, warm, s", VERB_GOALS[verb], usual))
    each = median(further)
    rows.append(row("each further cloud in one process", each, "s"))
    goals.append(at_most("each further cloud in one process, s", FURTHER, each))
    return rows, goals


# ---- inputs of the verbs --------------------------------------------------------------------------------------


def clouds_to_perceive(folder: Path) -> tuple[list[Path], str]:
    """Four real Kinect clouds where they are, else simulated ones written to `folder`; and the name of one."""
    real = real_scenes_folder()
    if real is not None and all((real / f"{name}.pcd").is_file() for name in REAL):
        return [real / f"{name}.pcd" for name in REAL], "a Kinect's PCD"
    sources = [folder / f"scene{number}.pcd" for number in range(len(SIMULATED))]
    for number, (source, things) in enumerate(zip(sources, SIMULATED, strict=True)):
        save_cloud(source, sample_scene(SEED, number, TabletopSettings(n_objects=(things, things))))
    return sources, "a simulated camera's PCD"


def fitted_study(folder: Path) -> Path:
    """A memory in `folder` with a study fitted from a log."""
    place = folder / "study.db"
    write_log(folder / "log.csv")
    with open_memory(place) as memory:
        fit([folder / "log.csv"], memory, FitSettings(rule="information-directed"))
    return place


def open_decisions(place: Path, n: int) -> list[str]:
    """Identifiers of `n` decisions for different users in the memory of `fitted_study`, without outcomes."""
    with open_memory(place) as memory:
        study = open_study(memory)
        return [choose(memory, study, f"new user {user}")["decision"] for user in range(n)]


def write_log(path: Path) -> None:
    """A log of normal outcomes whose users' types it names."""
    generator = stream(0, "bench reuse start")
    means = generator.normal(scale=10, size=(TYPES, POLICIES))
    with path.open("w", newline="") as file:
        lines = csv.writer(file)
        lines.writerow(["user", "policy", "outcome", "type"])
        for user in range(USERS):
            type_ = user % TYPES
            for policy in generator.integers(POLICIES, size=OUTCOMES).tolist():
                outcome = float(generator.normal(means[type_, policy], 3))
                lines.writerow([f"user {user}", f"policy {policy}", outcome, f"type {type_}"])
