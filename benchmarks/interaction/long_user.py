"""`bench long_user`: a choice and its outcome for a user with very many decisions in memory.

The user's history is written at once, as a merge of memories would, and then goes on decision by decision.
Processor time of this process; memory is durable, so each decision and each outcome also waits for the disk.
"""

import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.rounds import at_most, interleaved, paired_ratio, row
from lifelore.agent.reuse.history import Decision, History, user_key
from lifelore.agent.reuse.one_user import choose, update
from lifelore.agent.reuse.study import ACTIVE, Study
from lifelore.core.protocols import Progress, Record
from lifelore.core.streams import stream
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import Memory, open_memory

DECISIONS = (100, 100_000)
"""Decisions of the short and of the long history."""
TYPES, POLICIES, NOISE = 10, 6, 2.0
EACH = 20
"""Decisions that a round measures."""
MILLISECONDS, STATEMENTS = 2.0, 6
"""Most processor time and most SQL statements of a choice and its outcome; begin and end of transactions apart."""


def bench_long_user(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    study = _study()
    done = 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, repeats * len(DECISIONS), label)

    with TemporaryDirectory() as folder, open_memory(Path(folder) / "users.db", durable=True) as memory:
        labels = {f"choice and outcome after {n:,} decisions": _goes_on(memory, study, n) for n in DECISIONS}
        times = interleaved(labels, repeats, after)
        statements = _statements(memory, study)
    short, long = times
    growth = paired_ratio(times[long], times[short])
    counted = "SQL statements of a choice and its outcome"
    return {
        "rows": [
            row(short, median(times[short]), "ms"),
            row(long, median(times[long]), "ms", short, growth),
            row(counted, statements, "statements"),
        ],
        "goals": [
            at_most(f"{long}, ms", MILLISECONDS, median(times[long])),
            at_most(f"{long} / {short}", 1.5, growth),
            at_most(counted, STATEMENTS, statements),
        ],
    }


def _study() -> Study:
    means = stream(0, "bench", "long user").normal(0.0, 3.0, (TYPES, POLICIES))
    library = PolicyLibrary.from_means(means, NOISE)
    active = dict.fromkeys(library.policies, ACTIVE)
    return Study("bench", library, active, control=0.0, rule="information-directed", change=0.0)


def _statements(memory: Memory, study: Study) -> float:
    """SQL statements of another choice and its outcome, of a user with decisions."""
    before = memory.statements
    update(memory, study, choose(memory, study, _user(DECISIONS[0]))["decision"], 0.0)
    return float(memory.statements - before)


def _user(n: int) -> str:
    return f"user of {n} decisions"


def _goes_on(memory: Memory, study: Study, n: int) -> Callable[[], float]:
    """Milliseconds of a choice and its outcome, after `n` decisions, without the first one."""
    user = _user(n)
    _write_history(memory, study, user, n)
    random = stream(0, "bench", "long user", n)

    def timed() -> float:
        started = time.process_time()
        for outcome in random.normal(0.0, NOISE, EACH):
            update(memory, study, choose(memory, study, user)["decision"], float(outcome))
        return (time.process_time() - started) / EACH * 1e3

    timed()  # the belief of a history without one is computed from all decisions, once
    return timed


def _write_history(memory: Memory, study: Study, user: str, n: int) -> None:
    """`n` decisions with outcomes as a single contribution."""
    random = stream(0, "bench", "long user", "history", n)
    history = History(study.name, user_key(study.name, user), user, None, ())
    policies, outcomes = random.integers(0, POLICIES, n).tolist(), random.normal(0.0, NOISE, n).tolist()
    parts: list[Record] = []
    for number, (policy, outcome) in enumerate(zip(policies, outcomes, strict=True)):
        one = Decision(number, study.library.policies[policy], 1 / POLICIES, False, 0, 0)
        parts += [*history.records_of(one), history.outcome_record(one, outcome, 0)]
    slots, values = (np.concatenate([getattr(part, name) for part in parts]) for name in ("slots", "values"))
    record = Record(parts[0].kind, parts[0].key, parts[0].version, "newest", slots, values, parts[0].about)
    memory.contribute(history.robot, [record], process="history", seq=0, task={})
