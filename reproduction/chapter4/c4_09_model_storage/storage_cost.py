"""Storage cost of each observation model by the formulas of §4.7.6, as printed and corrected.

The thesis swaps the formulas of (s, a, s') and of rewards: the distribution over next states of every state and
action has |S|² |A| entries, the distribution over rewards |S| |A| |R|. With the right formulas the printed order,
performance < reward < state-action-state for |R| > |S|, becomes performance < state-action-state < reward. The
printed order holds where |R| < |S|. The printed performance model has a number for each level of reward, but sums
of rewards take more values (`n_returns`). Thesis: §4.7.6.
"""

from dataclasses import dataclass
from math import comb, inf
from numbers import Integral
from typing import Literal

from lifelore.core.errors import InputError


@dataclass(frozen=True)
class StorageSizes:
    """Sizes of a problem, in the thesis's letters: |Π|, N, |S|, |A|, |R|, T, γ, B.

    n_policies, n_types, n_states, n_actions, n_rewards, horizon : int
        At least 1.
    discount : float
        In [0, 1].
    bits : int
        Bits of a probability, at least 1.

    Raises
    ------
    InputError
        A size is no whole number of at least 1, or the discount lies outside [0, 1].
    """

    n_policies: int
    n_types: int
    n_states: int
    n_actions: int
    n_rewards: int
    horizon: int = 1
    discount: float = 1.0
    bits: int = 64

    def __post_init__(self) -> None:
        for name, value in list(vars(self).items()):
            if name != "discount":
                _check_whole(name, value)
                # Products of NumPy integers would overflow.
                object.__setattr__(self, name, int(value))
        if not 0 <= self.discount <= 1:
            raise InputError(f"discount must lie in [0, 1], got {self.discount}")


@dataclass(frozen=True)
class StorageCost:
    """Bits of each observation model."""

    performance: float
    discounted_performance: float
    reward: float
    state_action_state: float

    def order(self) -> tuple[str, ...]:
        """The three signals, cheapest first."""
        costs = {
            "performance": self.performance,
            "reward": self.reward,
            "state-action-state": self.state_action_state,
        }
        return tuple(sorted(costs, key=costs.__getitem__))


def storage_cost(sizes: StorageSizes, variant: Literal["standard", "thesis"] = "standard") -> StorageCost:
    """Bits of each observation model.

    Parameters
    ----------
    variant : {"standard", "thesis"}
        ``thesis`` swaps the two formulas of (s, a, s') and of rewards, as printed.

    Raises
    ------
    InputError
        There is no such variant.

    Examples
    --------
    >>> storage_cost(StorageSizes(2, 3, n_states=10, n_actions=4, n_rewards=5, bits=1)).order()
    ('performance', 'reward', 'state-action-state')
    """
    if variant not in ("standard", "thesis"):
        raise InputError(f"variant must be 'standard' or 'thesis', got {variant!r}")
    each = sizes.n_policies * sizes.n_types * sizes.bits
    rewards = each * sizes.n_states * sizes.n_actions * sizes.n_rewards
    states = each * sizes.n_states**2 * sizes.n_actions
    if variant == "thesis":
        rewards, states = states, rewards
    levels = each * sizes.n_rewards
    return StorageCost(levels, levels * effective_horizon(sizes.horizon, sizes.discount), rewards, states)


def effective_horizon(horizon: int, discount: float) -> float:
    """(1 - γ^T) / (1 - γ): number of undiscounted rewards that equal the discounted sum; T if γ is 1."""
    return float(horizon) if discount == 1 else (1 - discount**horizon) / (1 - discount)


def n_returns(n_rewards: int, horizon: int, discounted: bool) -> float:
    """The largest number of values of a return of `horizon` rewards out of `n_rewards`.

    Undiscounted returns depend on the number of times of each reward, discounted returns also on their order.
    Infinite where the number exceeds all floats.

    Raises
    ------
    InputError
        `n_rewards` or `horizon` is no whole number of at least 1.
    """
    _check_whole("n_rewards", n_rewards)
    _check_whole("horizon", horizon)
    try:
        return float(n_rewards) ** horizon if discounted else float(comb(horizon + n_rewards - 1, horizon))
    except OverflowError:
        return inf


def _check_whole(name: str, value: int) -> None:
    if not (isinstance(value, Integral) and value >= 1):
        raise InputError(f"{name} must be a whole number of at least 1, got {value!r}")
