"""`bench start`: how long somebody waits for a first answer, of a learner and of each verb from the shell.

Verbs are whole processes, timed in three states: *first ever* with no kernel compiled, *first after setup* with
the kernels that ``lifelore doctor --warm`` leaves, and *warm*. Seconds are of the processor, so that other
programs on the machine count little; what a verb waits for the disk is not in them.
"""

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import repeat
from pathlib import Path
from statistics import median

from benchmarks.rounds import at_most, row
from benchmarks.startup.first_result import LEARNERS, first_result_seconds
from benchmarks.startup.process_cost import Cost, installed_environment, process_cost
from benchmarks.startup.start_cases import clouds_to_perceive, fitted_study, open_decisions
from lifelore.core.protocols import Progress

COLD, WARM, AFTER_SETUP = 3.0, 0.15, 3.0
"""Most seconds of a learner's first result with and without compiling, and of a verb's first use after setup."""
HELP, LIVE, PERCEIVE, CHOOSE, UPDATE = "--help", "live", "perceive", "reuse choose", "reuse update"
VERB_GOALS = {HELP: 0.3, PERCEIVE: 1.4, CHOOSE: 0.6, UPDATE: 0.6}
"""Most seconds of a warm process."""
FURTHER = 0.5
"""Most seconds of each further cloud in one process."""
COLD_ROUNDS = 3
"""Compiling costs seconds a time and differs little: at most this many rounds of it."""

Arguments = Iterator[Sequence[object]]
"""The arguments of each process of a verb."""


def bench_start(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    cold = min(repeats, COLD_ROUNDS)
    total = cold * len(LEARNERS) + 1 + 5 + 6 * repeats + 5
    done = 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, label)

    parts = [_learners(cold, after)]
    with tempfile.TemporaryDirectory() as folder:
        parts.append(_verbs(Path(folder), repeats, after))
    return {key: [line for part in parts for line in part[key]] for key in ("rows", "goals")}


def _learners(rounds: int, after: Callable[[str], None]) -> dict[str, list[dict]]:
    """First results with an empty and with a filled cache of kernels, imports apart."""
    rows, goals = [], []
    for learner in LEARNERS:
        name, times = f"first result of learner {learner}", []
        for _ in range(rounds):
            times.append(first_result_seconds(learner))
            after(name)
        cold, warm = (median(column) for column in zip(*times, strict=True))
        rows += [row(f"{name}, cold", cold, "s"), row(f"{name}, warm", warm, "s", f"{name}, cold", warm / cold)]
        goals += [at_most(f"{name}, cold, s", COLD, cold), at_most(f"{name}, warm, s", WARM, warm)]
    return {"rows": rows, "goals": goals}


def _verbs(folder: Path, repeats: int, after: Callable[[str], None]) -> dict[str, list[dict]]:
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
) -> dict[str, list[dict]]:
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
    return {"rows": rows, "goals": goals}
