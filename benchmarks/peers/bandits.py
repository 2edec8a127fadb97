"""Outside programs that select among the same policies: MABWiser's UCB1 and BoTorch's GP-UCB.

Both are optional; without them their rows are left empty. MABWiser starts from one pull of each arm at its
mean over the types, which is more than it asks for. BoTorch is told where the targets lie, which policy reuse
is not; neither is given the models by type.
"""

import warnings
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import NDArray

MABWISER, BOTORCH = "mabwiser", "botorch"
UCB1 = "MABWiser UCB1"
ALPHAS = {"as it comes": 1.0, "tuned": 30.0}
"""UCB1's factor: MABWiser's default, and the best of 0, 1, 3, 9, 30, 100 and 300 on forty other tasks."""
BETA = 4.0
"""GP-UCB's β: two deviations above the mean."""

Player = tuple[Callable[[], int], Callable[[int, float], None]]
"""Selects a policy; learns from its reward."""


def installed(name: str) -> bool:
    """Whether the program can be imported."""
    return find_spec(name) is not None


def mabwiser_ucb1(prior_means: NDArray[np.float64], alpha: float) -> Player:
    """UCB1 of MABWiser; its bonus is √(2 ln N / n) times `alpha`, in the rewards' units."""
    from mabwiser.mab import MAB, LearningPolicy  # pyright: ignore[reportMissingImports]

    arms = list(range(len(prior_means)))
    bandit = MAB(arms, LearningPolicy.UCB1(alpha=alpha), seed=0)
    bandit.fit(decisions=arms, rewards=prior_means.tolist())

    def update(policy: int, reward: float) -> None:
        bandit.partial_fit(decisions=[policy], rewards=[reward])

    return bandit.predict, update


class BoTorchUCB:
    """GP-UCB of BoTorch over the targets' coordinates, hyperparameters fitted every `refit` episodes.

    Parameters
    ----------
    places : (n_policies, 2) float
        Coordinates in [0, 1].
    first : int
        The policy to start with, before there is anything to fit.
    refit : int
    """

    def __init__(self, places: NDArray[np.float64], first: int, refit: int) -> None:
        import torch  # pyright: ignore[reportMissingImports]

        torch.set_num_threads(1)
        self.torch, self.refit, self.first = torch, refit, first
        self.places = torch.tensor(places, dtype=torch.float64)
        self.policies: list[int] = []
        self.rewards: list[float] = []
        self.fitted: Any = None

    def select(self) -> int:
        """The policy of the largest upper bound."""
        if len(self.policies) < 2:
            # Two to begin with, far apart in number: a deviation needs two rewards.
            return (self.first + len(self.policies) * (len(self.places) // 2)) % len(self.places)
        with warnings.catch_warnings():
            # Remarks about few points, scaling and older parts of PyTorch are no matter of ours.
            warnings.simplefilter("ignore")
            return self._best()

    def update(self, policy: int, reward: float) -> None:
        """Keep the reward for the next fit."""
        self.policies.append(policy)
        self.rewards.append(reward)

    def _best(self) -> int:
        from botorch.acquisition import UpperConfidenceBound  # pyright: ignore[reportMissingImports]

        model = self._model()
        with self.torch.no_grad():
            return int(UpperConfidenceBound(model, beta=BETA)(self.places.unsqueeze(1)).argmax())

    def _model(self) -> Any:
        from botorch.fit import fit_gpytorch_mll  # pyright: ignore[reportMissingImports]
        from botorch.models import SingleTaskGP  # pyright: ignore[reportMissingImports]
        from gpytorch.mlls import ExactMarginalLogLikelihood  # pyright: ignore[reportMissingImports]

        seen = self.torch.tensor(self.rewards, dtype=self.torch.float64)
        scaled = (seen - seen.mean()) / seen.std().clamp_min(1e-9)
        model = SingleTaskGP(self.places[self.policies], scaled[:, None], outcome_transform=None)
        if self.fitted is None or len(self.rewards) % self.refit == 0:
            fit_gpytorch_mll(ExactMarginalLogLikelihood(model.likelihood, model))
            self.fitted = model.state_dict()
        else:
            model.load_state_dict(self.fitted)
        return model.eval()
