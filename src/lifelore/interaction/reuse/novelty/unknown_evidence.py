"""Log odds of a type that is not known against the types of a library, for rows of tasks.

    log odds = Σ log q(σ) − Σ log m(σ)

q is the broad type (`broad_library`) and m the mixture of the library's types, each given the task's earlier
signals. In m a task is as close to its type as the spread of the tasks of a type allows. An agent's own models may
allow more: where the runs do not tell tasks apart, also tasks between the types. They then fit almost any task,
and their evidence is no sign of a new type. Hence these rows have beliefs of their own.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import Models, Numbers, law_of
from lifelore.interaction.reuse.explanation import MAX_SURPRISE
from lifelore.interaction.reuse.novelty.broad_library import broad_library
from lifelore.interaction.reuse.reuse_algorithm import Dynamics, ReuseAlgorithm

Array = NDArray[Any]


class UnknownEvidence:
    """The evidence of tasks that no known type fits.

    Parameters
    ----------
    library : PolicyLibrary
        Read once: what it learns later does not count.
    n_tasks : int
    prior, dynamics, models
        As for `ReuseAlgorithm`.

    Attributes
    ----------
    log_odds : (n_tasks,) float64
        In nats, without a prior.
    types, broad : ReuseAlgorithm
        The known types, and the broad type.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories.
    """

    def __init__(
        self,
        library: PolicyLibrary,
        n_tasks: int = 1,
        prior: ArrayLike | None = None,
        dynamics: Dynamics | None = None,
        models: Models = "uncertain",
    ) -> None:
        self.broad = ReuseAlgorithm(broad_library(library), n_tasks, dynamics=TypeDynamics.static())
        least = law_of(library.signal, library.n_types, models).spread.least
        self.types = ReuseAlgorithm(
            library, n_tasks, prior=prior, dynamics=dynamics, models=models, spread=least, unknown_users=False
        )
        self.log_odds = np.zeros(n_tasks)

    def observe(self, tasks: Numbers, policies: Numbers, signals: Any) -> None:
        """Take in a signal of each of `tasks`; a signal counts at most `MAX_SURPRISE` nats against either side.

        Errors as for `ReuseAlgorithm.observe`; all stays as it was.
        """
        known = self.types.observe(tasks, policies, signals).log_evidence
        other = self.broad.observe(tasks, policies, signals).log_evidence
        self.log_odds[tasks] += np.maximum(other, -MAX_SURPRISE) - np.maximum(known, -MAX_SURPRISE)

    def end_episode(self, tasks: Numbers) -> None:
        """End an episode of `tasks`: types may have changed before the next."""
        self.types.end_episode(tasks)
