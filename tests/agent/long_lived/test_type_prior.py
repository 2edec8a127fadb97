"""The prior over types learnt from past posteriors: by hand, merged, dated, and against what it should notice."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.agent.long_lived.type_prior import LIBRARY_TASKS, TypePrior
from lifelore.core.errors import InputError

PRIOR = [0.5, 0.3, 0.2]
tasks = st.lists(
    st.tuples(
        st.integers(-3, 3), st.sampled_from([[1.0, 0, 0], [0, 0.25, 0.75], [0.2, 0.3, 0.5]]), st.integers(0, 9)
    ),
    max_size=12,
)


def learnt(lived, **settings) -> TypePrior:
    made = TypePrior(PRIOR, **settings)
    for context, belief, date in lived:
        made.learn(context, belief, date)
    return made


def test_without_tasks_it_is_the_librarys_prior():
    assert TypePrior(PRIOR).prior(4, date=3) == pytest.approx(PRIOR)


def test_one_date_by_hand():
    """No date has been predicted yet, so the four weights of all contexts count alike."""
    made = learnt([(7, [1.0, 0, 0], 0), (7, [0, 1.0, 0], 0), (8, [0, 1.0, 0], 0)])
    anywhere = (np.array([1.0, 2.0, 0.0]) + LIBRARY_TASKS * np.array(PRIOR)) / (3 + LIBRARY_TASKS)
    own = [(np.array([1.0, 1.0, 0.0]) + k * anywhere) / (2 + k) for k in (2.0, 8.0, 32.0)]
    assert made.prior(7, date=0) == pytest.approx(np.mean([*own, anywhere], axis=0))


def test_decay_by_hand():
    made = learnt([(7, [1.0, 0, 0], 0), (7, [0, 1.0, 0], 4)], half_lives=[2.0])
    # Four dates are two half-lives, eight four; no other context has counts.
    counts = np.array([1 / 16, 1 / 4, 0.0])
    found = made._decayed(7, 8) if made.prior(7, 8) is not None else None
    assert found[0] == pytest.approx(counts)
    assert made._decayed(None, 8)[0] == pytest.approx(counts)


@given(lived=tasks, order=st.randoms(use_true_random=False), date=st.integers(0, 12))
def test_order_and_merging_do_not_matter(lived, order, date):
    whole = learnt(lived)
    shuffled = list(lived)
    order.shuffle(shuffled)
    cut = len(lived) // 2
    parts = learnt(shuffled[:cut])
    parts.prior(1, date)  # a question between changes no later answer
    parts.merge(learnt(shuffled[cut:]))
    for context in (-1, 0, 2):
        assert np.array_equal(parts.prior(context, date), whole.prior(context, date))
        assert whole.prior(context, date).sum() == pytest.approx(1)


@given(lived=tasks, date=st.integers(0, 12))
def test_records_restore_every_bit(lived, date):
    whole = learnt(lived, key="people")
    other = learnt([(0, [1.0, 0, 0], 0)], key="trays")
    again = TypePrior.from_records([*whole.to_records(), *other.to_records()], PRIOR, "people")
    assert np.array_equal(again.prior(1, date), whole.prior(1, date))
    assert {record.about["date"] for record in whole.to_records()} == set(whole.dates)


def test_it_answers_about_a_date_from_that_date_and_before():
    made = learnt(
        [(0, [1.0, 0, 0], date) for date in range(10)] + [(0, [0, 0, 1.0], date) for date in range(10, 20)]
    )
    assert made.prior(0, 9)[0] > 0.8
    assert made.prior(0, 19)[2] > made.prior(0, 12)[2]
    assert made.prior(0, 9)[2] < 0.1  # asked again, the later dates are still not known


def test_popularity_that_changes_is_followed_and_one_that_stays_is_not_forgotten():
    moved = learnt([(0, np.eye(3)[date // 30 % 3], date) for date in range(90) for _ in range(10)])
    drawn = np.random.default_rng(1).choice(3, p=[0.2, 0.3, 0.5], size=(90, 10))
    steady = learnt([(0, np.eye(3)[type_], date) for date in range(90) for type_ in drawn[date]])
    short = sum(weight for (half_life, _), weight in moved.weights(90).items() if half_life <= 16)
    long = sum(weight for (half_life, _), weight in steady.weights(90).items() if half_life >= 64)
    assert short > 0.99
    assert long > 0.75
    assert moved.prior(0, 90)[2] > 0.8
    assert steady.prior(0, 90) == pytest.approx(np.bincount(drawn.ravel()) / 900, abs=0.02)


def test_contexts_count_where_they_tell_something():
    random = np.random.default_rng(1)
    told, idle = [], []
    for date in range(40):
        for context in random.integers(3, size=10).tolist():
            told.append((context, np.eye(3)[context], date))
            idle.append((context, np.eye(3)[random.integers(3)], date))
    assert learnt(told).prior(1, 40)[1] > 0.95
    # A context that tells nothing gets the prior of all contexts, from three times the tasks.
    apart = np.ptp([learnt(idle).prior(context, 40) for context in range(3)], axis=0).max()
    counted = np.ptp([np.bincount([int(b.argmax()) for c, b, _ in idle if c == context], minlength=3)
                      / sum(c == context for c, _, _ in idle) for context in range(3)], axis=0).max()  # fmt: skip
    assert apart < counted / 2


@pytest.mark.parametrize(
    ("make", "rule"),
    [
        (lambda: TypePrior([0.5, 0.6]), "library_prior must"),
        (lambda: TypePrior([]), "library_prior must"),
        (lambda: TypePrior(PRIOR, half_lives=[0.0]), "half_lives must"),
        (lambda: TypePrior(PRIOR, half_lives=[]), "half_lives must"),
        (lambda: TypePrior(PRIOR).learn(0, [0.5, 0.5], 0), "belief must"),
        (lambda: TypePrior(PRIOR).learn(0, [np.nan, 0.5, 0.5], 0), "belief must"),
        (lambda: TypePrior(PRIOR).merge(TypePrior([0.5, 0.5])), "priors must agree"),
        (lambda: TypePrior(PRIOR).merge(TypePrior(PRIOR, "other")), "priors must agree"),
    ],
)
def test_what_breaks_a_rule_is_refused(make, rule):
    with pytest.raises(InputError, match=rule):
        make()
