"""The prior over types learnt from past posteriors: by hand, in any order, and against what it should notice."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.agent.types.type_prior import LIBRARY_TASKS, SHARED, TypePrior
from lifelore.core.errors import InputError

PRIOR = [0.5, 0.3, 0.2]
BELIEFS = ([1.0, 0, 0], [0, 0.25, 0.75], [0.2, 0.3, 0.5])
tasks = st.lists(st.tuples(st.integers(-3, 3), st.sampled_from(BELIEFS), st.integers(0, 9)), max_size=12)


def learnt(lived, **how) -> TypePrior:
    made = TypePrior(PRIOR, **how)
    for context, belief, date in lived:
        made.learn(context, belief, date)
    return made


def test_one_date_by_hand():
    """No date has been predicted yet, so all weights of all contexts count alike."""
    assert TypePrior(PRIOR).prior(4, date=3) == pytest.approx(PRIOR)
    made = learnt([(7, [1.0, 0, 0], 0), (7, [0, 1.0, 0], 0), (8, [0, 1.0, 0], 0)])
    anywhere = (np.array([1.0, 2.0, 0.0]) + LIBRARY_TASKS * np.array(PRIOR)) / (3 + LIBRARY_TASKS)
    own = [(np.array([1.0, 1.0, 0.0]) + k * anywhere) / (2 + k) for k in SHARED[:-1]]
    assert made.prior(7, date=0) == pytest.approx(np.mean([*own, anywhere], axis=0))


def test_decay_by_hand():
    made = learnt([(7, [1.0, 0, 0], 0), (7, [0, 1.0, 0], 4)], half_lives=[2.0])
    # Four dates are two half-lives, eight four; no other context has counts.
    counts = np.array([1 / 16, 1 / 4, 0.0])
    made.prior(7, 8)
    assert made._decayed(7, 8)[0] == pytest.approx(counts)
    assert made._decayed(None, 8)[0] == pytest.approx(counts)


@settings(max_examples=40)
@given(lived=tasks, order=st.randoms(use_true_random=False), date=st.integers(0, 12))
def test_neither_order_nor_sums_nor_questions_matter(lived, order, date):
    whole, parts = learnt(lived), learnt([])
    sums: dict = {}
    for place, (context, belief, when) in enumerate(order.sample(lived, len(lived))):
        if place % 2:
            sums[when, context] = np.add(sums.get((when, context), 0.0), belief)
        else:
            parts.learn(context, belief, when)
            parts.prior(1, date)  # a question between changes no later answer
    for (when, context), belief in sums.items():
        parts.learn(context, belief, when)
    for context in (-1, 0, 2):
        assert parts.prior(context, date) == pytest.approx(whole.prior(context, date), abs=1e-5)
        assert whole.prior(context, date).sum() == pytest.approx(1)


def test_it_answers_about_a_date_from_that_date_and_before():
    made = learnt([(0, np.eye(3)[0 if date < 10 else 2], date) for date in range(20)])
    assert made.prior(0, 9)[0] > 0.8
    assert made.prior(0, 19)[2] > made.prior(0, 12)[2]
    assert made.prior(0, 9)[2] < 0.1  # asked again, the later dates are still not known


def test_popularity_that_changes_is_followed_and_one_that_stays_is_not_forgotten():
    moved = learnt([(0, 10 * np.eye(3)[date // 30 % 3], date) for date in range(90)])
    drawn = np.random.default_rng(1).multinomial(10, [0.2, 0.3, 0.5], size=90)
    steady = learnt([(0, counts, date) for date, counts in enumerate(drawn)])
    assert moved.prior(0, 90)[2] > 0.8
    assert steady.prior(0, 90) == pytest.approx(drawn.sum(axis=0) / 900, abs=0.02)
    # Rows are half-lives, the longest first.
    short, long = moved._weights()[2:].sum(), steady._weights()[:2].sum()
    assert short > 0.99
    assert long > 0.65


def test_contexts_count_where_they_tell_something():
    random = np.random.default_rng(1)
    contexts, types = random.integers(3, size=(2, 400))
    date = np.arange(400) // 10
    told = learnt(zip(contexts, np.eye(3)[contexts], date, strict=True))
    idle = learnt(zip(contexts, np.eye(3)[types], date, strict=True))
    assert told.prior(1, 40)[1] > 0.95
    # A context that tells nothing gets the prior of all contexts, from three times the tasks.
    counted = [np.bincount(types[contexts == one], minlength=3) / (contexts == one).sum() for one in range(3)]
    assert np.ptp([idle.prior(one, 40) for one in range(3)], axis=0).max() < np.ptp(counted, axis=0).max() / 2


@pytest.mark.parametrize(
    ("make", "rule"),
    [
        (lambda: TypePrior([0.5, 0.6]), "library_prior must"),
        (lambda: TypePrior([]), "library_prior must"),
        (lambda: TypePrior(PRIOR, half_lives=[0.0]), "half_lives must"),
        (lambda: TypePrior(PRIOR, half_lives=[]), "half_lives must"),
        (lambda: TypePrior(PRIOR).learn(0, [0.5, 0.5], 0), "belief must"),
        (lambda: TypePrior(PRIOR).learn(0, [np.nan, 0.5, 0.5], 0), "belief must"),
    ],
)
def test_what_breaks_a_rule_is_refused(make, rule):
    with pytest.raises(InputError, match=rule):
        make()
