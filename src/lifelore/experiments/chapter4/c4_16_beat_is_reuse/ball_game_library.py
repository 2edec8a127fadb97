"""What was learnt of the ball game as a policy library: types × action sets, and the transitions as signal."""

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.ball_game.ball_game import BallGame, LossScale
from lifelore.domains.ball_game.moves import N_CONTEXTS, N_OUTCOMES
from lifelore.experiments.chapter4.ball_game_play import Trained
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.signals.transition_signal import TransitionSignal

N_STATES = max(N_CONTEXTS, N_OUTCOMES)


def library_of(game: BallGame, trained: Trained, scale: LossScale) -> PolicyLibrary:
    """The library of a game; its signal takes the pairs of `transition_of`."""
    samples = -scale.loss(trained.steps, trained.hits)
    types = [f"b = {b}" for b in game.sizes]
    policies = [f"speed {z}" for z in game.speeds]
    return PolicyLibrary.from_samples(samples, types, policies, signal=transition_signal(trained))


def transition_signal(trained: Trained) -> TransitionSignal:
    """T(s' | s; type, speed) in classes: from the context of a command to its outcome."""
    table = np.exp(trained.signal_table())
    n_speeds, _, n_types = table.shape
    probs = np.zeros((n_types, n_speeds, N_STATES, 1, N_STATES))
    shares = table.reshape(n_speeds, N_CONTEXTS, N_OUTCOMES, n_types).transpose(3, 0, 1, 2)
    probs[:, :, :N_CONTEXTS, 0, :N_OUTCOMES] = shares
    probs[:, :, N_CONTEXTS:, 0, 0] = 1.0  # no command has such a context
    return TransitionSignal(probs / probs.sum(axis=-1, keepdims=True))


def transition_of(signal: int) -> NDArray[np.int64]:
    """A signal's number as one transition (context, outcome), (1, 2) int64."""
    return np.array([divmod(int(signal), N_OUTCOMES)], np.int64)
