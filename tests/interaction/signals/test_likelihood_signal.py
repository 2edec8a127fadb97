"""A caller's own likelihood: what it may give and what not."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal


def test_what_the_function_gives():
    signal = LikelihoodSignal(lambda policy, words: [-float(len(words)), -np.inf, policy - 5.0], 3, 4)
    assert signal.log_likelihood(2, "ab").tolist() == [-2.0, -np.inf, -3.0]
    some = signal.take(types=[2, 0], policies=[3])
    assert some.log_likelihood(0, "abc").tolist() == [-2.0, -3.0]
    with pytest.raises(NotFoundError, match="unknown policy"):
        signal.log_likelihood(4, "ab")
    with pytest.raises(NotFoundError, match="unknown policy"):
        some.log_likelihood(1, "ab")


def weird(policy, signal):
    return signal


@pytest.mark.parametrize("given", [[np.nan, 0.0], [np.inf, 0.0], [0.0], [[0.0, 0.0]], "ab", None, [0.0, "x"]])
def test_what_is_no_likelihood_is_refused_and_the_function_named(given):
    with pytest.raises(InputError, match="log likelihood 'weird'"):
        LikelihoodSignal(weird, 2).log_likelihood(0, given)


def test_there_must_be_types():
    with pytest.raises(InputError, match="n_types"):
        LikelihoodSignal(weird, 0)
