"""Dynamics that learn, beside plain Python; the patterns that they find; rows and states."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import log_prior, update
from lifelore.interaction.beliefs.learnt_dynamics import (
    CONCENTRATION,
    HAZARD_WEIGHTS,
    HAZARDS,
    MOST_CATEGORIES,
    WEIGHT_OF_TABLES,
    LearntDynamics,
)
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics

PRIOR = np.array([0.5, 0.3, 0.2])
BY = ("time", "type", "outcome")


def likelihoods(seed: int, n: int = 12) -> np.ndarray:
    return np.random.default_rng(seed).random((n, 3)) ** 3


def of_rows(by: str, signals: np.ndarray, outcomes: list, dtype="f8", user=1, start=None) -> np.ndarray:
    """The belief before each episode, and at the end."""
    rows = (start or LearntDynamics(by)).rows(3, PRIOR, dtype)  # pyright: ignore[reportArgumentType]
    belief, seen = log_prior(PRIOR).astype(dtype), []
    for signal, outcome in zip(signals, outcomes, strict=True):
        seen.append(np.exp(belief))
        belief = rows.step(update(belief, np.log(signal)).log_belief, user, outcome)
    return np.array([*seen, np.exp(belief)])


def in_plain_python(by: str, signals: np.ndarray, outcomes: list) -> np.ndarray:
    """The same by lists of p(way, type): a hazard or a table of counts a way, each with a belief of its own."""
    n, kinds = len(PRIOR), {"time": [], "type": [(1, 0)], "outcome": [(1, 0), (0, 1), (1, 1)]}[by]
    weight = (1 - WEIGHT_OF_TABLES) if kinds else 1.0
    ways = [(weight * w / sum(HAZARD_WEIGHTS), h) for w, h in zip(HAZARD_WEIGHTS, HAZARDS, strict=True)]
    ways += [(WEIGHT_OF_TABLES / len(kinds), kind) for kind in kinds]
    joint = [[w * p for p in PRIOR] for w, _ in ways]
    counts: list[dict] = [{} for _ in ways]
    last: list = [None] * len(ways)
    last_outcome = None
    seen = []
    for signal, outcome in zip(signals, outcomes, strict=True):
        seen.append([sum(row[t] for row in joint) for t in range(n)])
        joint = [[row[t] * signal[t] for t in range(n)] for row in joint]
        total = sum(map(sum, joint))
        joint = [[p / total for p in row] for row in joint]
        for way, (_, kind) in enumerate(ways):
            own = sum(joint[way])
            if not isinstance(kind, tuple):
                joint[way] = [(1 - kind) * joint[way][t] + kind * own * PRIOR[t] for t in range(n)]
                continue
            if last[way] is not None:
                # Expected transitions of the last step, given this episode's signals.
                before, chance = last[way]
                for t in range(n):
                    into = sum(before[f] * chance[f][t] for f in range(n))
                    for f in range(n):
                        place = (f if kind[0] else 0, last_outcome if kind[1] else 0, t)
                        more = before[f] * chance[f][t] / into * joint[way][t] / own
                        counts[way][place] = counts[way].get(place, 0.0) + more
            popular = [PRIOR[t] + sum(c for (_, _, to), c in counts[way].items() if to == t) for t in range(n)]
            popular = [CONCENTRATION * p / sum(popular) for p in popular]
            chance = []
            for f in range(n):
                row = [counts[way].get((f if kind[0] else 0, outcome if kind[1] else 0, t), 0.0) for t in range(n)]
                row = [c + p for c, p in zip(row, popular, strict=True)]
                chance.append([c / sum(row) for c in row])
            last[way] = (joint[way], chance)
            joint[way] = [sum(joint[way][f] * chance[f][t] for f in range(n)) for t in range(n)]
        last_outcome = outcome
    return np.array([*seen, [sum(row[t] for row in joint) for t in range(n)]])


@pytest.mark.parametrize("by", BY)
@pytest.mark.parametrize("seed", range(3))
def test_beliefs_are_those_of_plain_python(by, seed):
    signals, outcomes = likelihoods(seed), ["won", "lost", "won", "draw"] * 3
    expected = in_plain_python(by, signals, outcomes)
    assert of_rows(by, signals, outcomes) == pytest.approx(expected, rel=1e-9, abs=1e-12)
    assert of_rows(by, signals, outcomes, "f4") == pytest.approx(expected, rel=1e-3, abs=1e-5)


def test_many_users_are_single_users():
    rows, belief = LearntDynamics("outcome").rows(3, PRIOR, "f8"), np.tile(log_prior(PRIOR), (3, 1))
    outcomes = [["won", "lost", "won"][number % 3] for number in range(12)]
    for number, signal in enumerate(likelihoods(0)):
        belief = update(belief, np.log(signal)).log_belief
        belief = rows.step(belief, np.arange(3), [outcomes[number], outcomes[(number + 1) % 12], None])
    assert np.exp(belief[0]) == pytest.approx(of_rows("outcome", likelihoods(0), outcomes)[-1], rel=1e-9)
    assert np.exp(belief[2]) == pytest.approx(of_rows("outcome", likelihoods(0), [None] * 12)[-1], rel=1e-9)


def test_states_go_on_to_the_bit():
    for by in BY:
        signals, outcomes = likelihoods(3), ["won", 2, None, "lost"] * 3
        rows, other = (LearntDynamics(by).rows(2, PRIOR, "f8") for _ in range(2))
        belief = log_prior(PRIOR)
        for signal, outcome in zip(signals, outcomes, strict=True):
            belief = rows.step(update(belief, np.log(signal)).log_belief, 1, outcome)
        other.restore(0, rows.state(1))
        assert np.array_equal(rows.step(belief, 1, "lost"), other.step(belief, 0, "lost"))
        other.reset(0)
        fresh = LearntDynamics(by).rows(1, PRIOR, "f8")
        assert np.array_equal(other.step(belief, 0, "lost"), fresh.step(belief, 0, "lost"))
        other.grow(5)
        fresh = LearntDynamics(by).rows(1, PRIOR, "f8")
        assert np.array_equal(other.step(belief, 4, "lost"), fresh.step(belief, 0, "lost"))
        with pytest.raises(InputError, match="not of these dynamics"):
            rows.restore(0, {"shares": np.zeros((2, 2))})


def test_a_type_that_never_comes_leaves_numbers_when_all_hazards_are_refuted():
    """Types take turns for so long that the hazards' probabilities are 0 in float32; the third has prior 0."""
    prior, belief = np.array([0.5, 0.5, 0.0]), log_prior([0.5, 0.5, 0.0]).astype("f4")
    rows = LearntDynamics("type").rows(1, prior, "f4")
    for episode in range(400):
        signal = np.where(np.arange(3) == episode % 2, 0.0, -60.0).astype("f4")
        belief = rows.step(update(belief, signal).log_belief, 0)
        assert np.isfinite(belief).all()
        assert belief[2] < -60
    assert (rows.shares[0, : len(HAZARDS)] @ np.exp(belief)).max() < 1e-30
    assert np.exp(belief) == pytest.approx([1.0, 0.0, 0.0], abs=0.01)


def test_the_share_that_has_just_changed_was_another_type():
    rows, before = LearntDynamics("time").rows(1, PRIOR, "f8"), np.array([0.9, 0.1, 0.0])
    after = rows.step(log_prior(before), 0)
    rate = HAZARDS @ HAZARD_WEIGHTS / HAZARD_WEIGHTS.sum()
    assert np.exp(after) == pytest.approx((1 - rate) * before + rate * PRIOR, rel=1e-9)
    assert rows.changed_share(after, 0) == pytest.approx(rate * PRIOR * (1 - before) / np.exp(after), rel=1e-9)
    alone = LearntDynamics("time").rows(1, np.ones(1), "f8")
    assert alone.changed_share(alone.step(np.zeros(1), 0), 0) == pytest.approx([0.0], abs=1e-15)


def test_arguments_that_break_their_rule():
    with pytest.raises(InputError, match="by must be 'time', 'type' or 'outcome'"):
        TypeDynamics.learnt("weather")  # pyright: ignore[reportArgumentType]
    rows = LearntDynamics("outcome").rows(1, PRIOR, "f8")
    with pytest.raises(InputError, match="outcome must be a word, a number or None"):
        rows.step(log_prior(PRIOR), 0, ("won", 3))
    rows.step(log_prior(PRIOR), 0, np.int64(3))
    LearntDynamics("outcome").rows(1, PRIOR, "f8").restore(0, rows.state(0))
    for number in range(MOST_CATEGORIES):
        rows.step(log_prior(PRIOR), 0, number)
    with pytest.raises(InputError, match=f"at most {MOST_CATEGORIES} ways"):
        rows.step(log_prior(PRIOR), 0, "one more")
