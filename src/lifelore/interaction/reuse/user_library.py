"""A policy library as selection rules read it for some users, given what these have shown."""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import Numbers
from lifelore.interaction.outcomes.prediction import Prediction
from lifelore.interaction.reuse.user_model import UserModel
from lifelore.interaction.selection.choice import PartOfLibrary


class UserLibrary:
    """Predictions and signal tables of `users`; arrays have a leading axis of users only where users differ.

    Parameters
    ----------
    library : PolicyLibrary
    signals, outcomes : UserModel
    users : int or (k,) int64
    """

    def __init__(self, library: PolicyLibrary, signals: UserModel, outcomes: UserModel, users: Numbers) -> None:
        self.library, self._signals, self._outcomes, self._users = library, signals, outcomes, users
        self.n_types, self.n_policies = library.n_types, library.n_policies

    @cached_property
    def performance(self) -> Prediction:
        """The next outcome of each pair."""
        model = self._outcomes
        if not model.law.learns:
            return self.library.performance  # pyright: ignore[reportReturnType]
        law: Any = model.law
        return law.prediction(model.shown, self._users, model.log_weights[self._users])

    def table(self, n_bins: int) -> SignalTable:
        """The next signal of each pair, in at most `n_bins` bins; errors as for `PolicyLibrary.table`."""
        model = self._signals
        law: Any = model.law
        if not (law.learns and hasattr(law, "table")):
            return self.library.table(n_bins)
        return law.table(n_bins, model.shown, self._users, model.log_weights[self._users])

    def part(self, rows: Any, policies: NDArray[np.bool_]) -> PartOfLibrary:
        """What rules read of some of the users and policies."""
        users = self._users if np.ndim(self._users) == 0 else self._users[rows]
        own: Any = UserLibrary(self.library, self._signals, self._outcomes, users)
        return PartOfLibrary(own, policies)
