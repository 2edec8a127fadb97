"""Bayes' rule in NumPy has the bits of its kernel."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lifelore.interaction.beliefs import belief
from lifelore.interaction.beliefs.bayes_rule import bayes_rule
from lifelore.interaction.beliefs.belief import update
from lifelore.interaction.beliefs.belief_kernels import bayes_row

logs = st.one_of(st.floats(-800, 300), st.just(-np.inf), st.sampled_from([0.0, -0.0, -1e308, 1e308]))


def same_bits(one, other) -> bool:
    return np.asarray(one, np.float64).tobytes() == np.asarray(other, np.float64).tobytes()


@pytest.mark.slow
@settings(deadline=None, max_examples=300)
@given(st.data(), st.integers(1, 9))
def test_bayes_rule(data, n_types):
    prior = data.draw(arrays(float, n_types, elements=logs.map(lambda log: min(log, 0.0))))
    said = data.draw(arrays(float, n_types, elements=st.one_of(logs, st.sampled_from([np.nan, np.inf]))))
    compiled = prior.copy()
    evidence = bayes_row(compiled, said)
    after, plain = bayes_rule(prior, said)
    assert same_bits(after, compiled)
    assert same_bits(plain, evidence)


def test_the_belief_is_the_same_whichever_runs(monkeypatch):
    rng = np.random.default_rng(0)
    prior, said = np.log(rng.dirichlet(np.ones(7), (5, 3))), rng.normal(size=(5, 3, 7)) * 9
    compiled = update(prior, said)
    monkeypatch.setattr(belief, "kernel_pays", lambda numbers: False)
    plain = update(prior, said)
    assert same_bits(plain.log_belief, compiled.log_belief)
    assert same_bits(plain.log_evidence, compiled.log_evidence)
