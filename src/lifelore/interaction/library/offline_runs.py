"""The offline procedure that fills a library: run every policy on all instances of every type.

Thesis: §4.4.1. The models do step 4, fitting: ``PolicyLibrary.from_samples(runs.outcomes)``,
``RewardSignal.from_sequences(runs.sequences(), …)``.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream


@dataclass(frozen=True)
class OfflineRuns:
    """Outcomes and signals of every policy on every type.

    outcomes : (n_types, n_policies, n) float64
        Utility of each run; NaN fills up types with fewer instances.
    signals : list by type, policy and run
        None where runs give only the utility.
    """

    outcomes: NDArray[np.float64]
    signals: list[list[list[Any]]]

    def sequences(self) -> Iterator[tuple[int, int, Any]]:
        """Every run as (type, policy, signal)."""
        for type_, of_type in enumerate(self.signals):
            for policy, of_policy in enumerate(of_type):
                for signal in of_policy:
                    yield type_, policy, signal


def run_offline(
    types: Sequence[Any],
    policies: Sequence[Any],
    instances: Callable[[Any, np.random.Generator], Iterable[Any]],
    run: Callable[[Any, Any, np.random.Generator], float | tuple[float, Any]],
    seed: int = 0,
    repeats: int = 1,
) -> OfflineRuns:
    """Run every policy on every instance of every type.

    Parameters
    ----------
    types, policies : sequence
        Any values that `instances` and `run` accept.
    instances : callable
        ``instances(type, generator)`` gives tasks of the type, at least one.
    run : callable
        ``run(policy, task, generator)`` gives the utility, or the utility and the signal.
    seed : int
        Every type, policy, instance and repetition has its own stream, so that additions change no other stream.
    repeats : int
        Runs of each policy on each instance.

    Raises
    ------
    InputError
        There are no types, policies or instances, or a utility is not finite.

    Examples
    --------
    >>> runs = run_offline([1.0, 2.0], [3.0], lambda type_, g: [type_] * 2, lambda policy, task, g: policy * task)
    >>> runs.outcomes.tolist()
    [[[3.0, 3.0]], [[6.0, 6.0]]]
    """
    if not len(types) or not len(policies) or repeats < 1:
        raise InputError(
            f"types, policies and repeats must be at least 1, got {len(types)}, {len(policies)}, {repeats}"
        )
    utilities: list[list[list[float]]] = []
    signals: list[list[list[Any]]] = []
    for number, type_ in enumerate(types):
        tasks = list(instances(type_, stream(seed, "instances", number)))
        if not tasks:
            raise InputError(f"type {number} has no instance to run policies on")
        ran = [_runs(run, policy, tasks, (seed, number, place), repeats) for place, policy in enumerate(policies)]
        utilities.append([[utility for utility, _ in of_policy] for of_policy in ran])
        signals.append([[signal for _, signal in of_policy] for of_policy in ran])
    longest = max(len(of_type[0]) for of_type in utilities)
    filled = [[row + [np.nan] * (longest - len(row)) for row in of_type] for of_type in utilities]
    return OfflineRuns(np.array(filled), signals)


def _runs(
    run: Callable[[Any, Any, np.random.Generator], Any],
    policy: Any,
    tasks: list[Any],
    place: tuple[int, int, int],
    repeats: int,
) -> list[tuple[float, Any]]:
    """(utility, signal) of a policy's runs on a type's tasks; `place` is (seed, type, policy)."""
    seed, of_type, of_policy = place
    found = []
    for number, task in enumerate(tasks):
        for repeat in range(repeats):
            given = run(policy, task, stream(seed, "run", of_type, of_policy, number, repeat))
            utility, signal = given if isinstance(given, tuple) else (given, None)
            if not np.isfinite(utility):
                raise InputError(f"the utility of policy {of_policy} on type {of_type} is {utility}")
            found.append((float(utility), signal))
    return found
