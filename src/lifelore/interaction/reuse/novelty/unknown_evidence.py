"""Rows of Algorithm 7 that weigh a type that is not known against the types of a library (`UnknownUsers`).

In these rows a task is as close to its type as the spread of the tasks of a type allows. An agent's own models may
allow more: where the runs do not tell tasks apart, also tasks between the types. They then fit almost any task,
and their evidence is no sign of a new type. Hence detectors have rows of their own.
"""

from numpy.typing import ArrayLike

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import Models, law_of
from lifelore.interaction.reuse.reuse_algorithm import Dynamics, ReuseAlgorithm
from lifelore.interaction.reuse.unknown_law import unknown_law


def unknown_evidence(
    library: PolicyLibrary,
    n_tasks: int = 1,
    prior: ArrayLike | None = None,
    dynamics: Dynamics | None = None,
    models: Models = "uncertain",
) -> ReuseAlgorithm:
    """Rows of tasks whose `unknown` has the evidence that no known type fits.

    Parameters
    ----------
    library : PolicyLibrary
        Read once: what it learns later does not count.
    prior, dynamics, models
        As for `ReuseAlgorithm`.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories.
    """
    broad, least = unknown_law(library), law_of(library.signal, library.n_types, models).spread.least
    return ReuseAlgorithm(
        library, n_tasks, prior=prior, dynamics=dynamics, models=models, spread=least, unknown=broad
    )
