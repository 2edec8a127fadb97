"""C4.16: Algorithm 9 by hand beside Bayesian policy reuse, step by step. Thesis: §4.8.4.2.

Algorithm 9 reads counts of moves and multiplies probabilities. The general algorithm reads a policy library with a
transition signal and adds logs. Algorithm 9 is in charge, and both see its moves.
"""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import BallGame, LossScale, draw_sigma
from lifelore.interaction.adaptation.beat import rule_at
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy
from lifelore.interaction.signals.transition_signal import TransitionSignal
from reproduction.chapter4.ball_game.games import N_TYPES, Game
from reproduction.chapter4.ball_game.moves import N_CONTEXTS, N_OUTCOMES, PRIOR_MOVES, outcome_probs, read_moves
from reproduction.chapter4.ball_game.play import Trained, train
from reproduction.chapter4.ball_game.players import advance, new_balls, random_states
from reproduction.chapter4.ball_game.trials import EPISODES
from reproduction.engine.estimates import exact_value

EPSILONS = ("1/n", "by episode")
"""The two schedules that the thesis prints."""
N_STATES = max(N_CONTEXTS, N_OUTCOMES)


class Algorithm9:
    """BEAT as printed, with ∝ where it prints =; and the products as printed, which are never normalised.

    Parameters
    ----------
    counts : (n_speeds, contexts · outcomes, n_types) float
        Moves seen in training.
    value : (n_types, n_speeds) float
    """

    def __init__(self, counts: NDArray[np.float64], value: NDArray[np.float64]) -> None:
        n_speeds, _, n_types = counts.shape
        seen = counts.reshape(n_speeds, N_CONTEXTS, N_OUTCOMES, n_types) + PRIOR_MOVES / N_OUTCOMES
        self.transitions = seen / seen.sum(axis=2, keepdims=True)
        self.value, self.belief = value, np.full(n_types, 1 / n_types)
        self.printed = self.belief.copy()

    def probabilities(self, epsilon: float) -> NDArray[np.float64]:
        """Line 7: the Bayes optimal action set with probability 1 - ε, any with ε."""
        n_speeds = self.value.shape[1]
        found = np.full(n_speeds, epsilon / n_speeds)
        found[np.argmax([np.dot(self.belief, self.value[:, speed]) for speed in range(n_speeds)])] += 1 - epsilon
        return found

    def update(self, speed: int, context: int, outcome: int) -> None:
        """Line 6."""
        likelihood = self.transitions[speed, context, outcome]
        self.printed = likelihood * self.printed
        self.belief = likelihood * self.belief / np.dot(likelihood, self.belief)


def cells(settings: Mapping) -> list[dict]:
    """A cell for each schedule of ε."""
    return [{"epsilon": name} for name in EPSILONS]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Sessions of five episodes with users of every type."""
    game = Game.parsed(settings["game"]).game
    trained = train(game, settings["training"], seed)
    value = trained.value(LossScale())
    library = library_of(trained)
    sessions = []
    for kind, user in product(range(N_TYPES), range(settings["users"])):
        beat = Algorithm9(trained.signals, value)
        reuse = BayesianPolicyReuse(library, EpsilonGreedy(0.0), dynamics=TypeDynamics.static())
        world = stream(seed, "C4.16", cell["epsilon"], kind, user)
        sessions.append(_session(game, kind, beat, reuse, cell["epsilon"], world))
    return {**cell, "sessions": sessions}


def _session(
    game: BallGame,
    kind: int,
    beat: Algorithm9,
    reuse: BayesianPolicyReuse,
    schedule: str,
    world: np.random.Generator,
) -> dict:
    """One user's episodes: steps, those decided alike, the largest difference of beliefs, when products vanish."""
    steps, alike, apart, vanished = 0, 0, 0.0, 0
    heading, signal, before = np.empty(1, np.int64), np.empty(1, np.int64), np.empty((1, 2), np.int64)
    for episode in range(EPISODES):
        balls = new_balls(game, [kind], draw_sigma(world), random_states(world, 1))
        while balls.playing[0]:
            reuse.rule = rule_at(schedule, steps, episode)
            mine = beat.probabilities(reuse.rule.epsilon)
            alike += bool(np.abs(reuse.probabilities() - mine).max() < 1e-9)
            speed = int(world.choice(len(mine), p=mine))
            advance(game.field, balls, np.array([speed]), heading, before)
            read_moves(game.field, before, heading, np.array([speed]), balls.x, balls.y, signal)
            beat.update(speed, *divmod(int(signal[0]), N_OUTCOMES))
            reuse.update(speed, transition_of(signal[0]))
            steps += 1
            vanished = vanished or (0 if beat.printed.any() else steps)
            apart = max(apart, float(np.abs(beat.belief - reuse.belief).max()))
    return {"steps": steps, "alike": alike, "apart": apart, "vanished": vanished}


def library_of(trained: Trained) -> PolicyLibrary:
    """Types × speeds as a policy library; its signal takes the pairs of `transition_of`."""
    samples = -LossScale().loss(trained.steps, trained.hits)
    return PolicyLibrary.from_samples(samples, signal=transition_signal(trained))


def transition_signal(trained: Trained) -> TransitionSignal:
    """T(s' | s; type, speed) in classes: from the context of a command to its outcome."""
    shares = outcome_probs(trained.signals).transpose(3, 0, 1, 2)
    probs = np.zeros((*shares.shape[:2], N_STATES, 1, N_STATES))
    probs[:, :, :N_CONTEXTS, 0, :N_OUTCOMES] = shares
    probs[:, :, N_CONTEXTS:, 0, 0] = 1.0  # no command has such a context
    return TransitionSignal(probs / probs.sum(axis=-1, keepdims=True))


def transition_of(signal: int) -> NDArray[np.int64]:
    """A signal's number as one transition (context, outcome), (1, 2) int64."""
    return np.array([divmod(int(signal), N_OUTCOMES)], np.int64)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Share of decisions alike, the largest difference of beliefs, and sessions whose products vanish."""
    sessions = [session for result in results for session in result["sessions"]]
    steps = sum(session["steps"] for session in sessions)
    return {
        "decisions_alike": exact_value(sum(session["alike"] for session in sessions) / steps, steps),
        "steps": exact_value(steps, len(sessions)),
        "beliefs_apart": exact_value(max(session["apart"] for session in sessions), len(sessions)),
        "products_that_vanish": mean_estimate([float(session["vanished"] > 0) for session in sessions]),
    }
