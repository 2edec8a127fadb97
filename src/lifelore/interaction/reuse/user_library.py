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
        learns = self._outcomes.law.learns
        return self._outcomes.prediction(self._users) if learns else self.library.performance  # pyright: ignore

    def table(self, n_bins: int) -> SignalTable:
        """The next signal of each pair, in at most `n_bins` bins; errors as for `PolicyLibrary.table`."""
        model = self._signals
        if not (model.law.learns and hasattr(model.law, "prediction")):
            return self.library.table(n_bins)
        rows: Any = self.performance if model is self._outcomes else model.prediction(self._users)
        return rows.table(n_bins)

    def part(self, rows: Any, policies: NDArray[np.bool_]) -> PartOfLibrary:
        """What rules read of some of the users and policies."""
        users = self._users if np.ndim(self._users) == 0 else self._users[rows]
        own: Any = UserLibrary(self.library, self._signals, self._outcomes, users)
        return PartOfLibrary(own, policies)
