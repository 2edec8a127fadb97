"""How much types differ is learnt from counts, kind of cause by kind of cause."""

from dataclasses import dataclass

import numpy as np
import pytest

from lifelore.agent.long_lived.concentrations import USUAL, group_laws, learnt_concentrations

N_CAUSES, N_EFFECTS = 6, 4


@dataclass
class Family:
    """Six causes of two kinds; all effects are possible."""

    n_causes = N_CAUSES
    n_effects = N_EFFECTS
    kinds = np.repeat([0, 1], 3)
    groups = np.arange(N_CAUSES)
    possible = np.full((N_CAUSES, N_EFFECTS), 1 / N_EFFECTS)

    def smoothed(self, counts):
        return counts


def drawn_counts(rng, kappa, n_types=6, n_tasks=20):
    """Counts of types whose laws are drawn around a common law with concentration kappa of each kind of cause."""
    common = rng.dirichlet(np.ones(N_EFFECTS), N_CAUSES)
    around = np.array(kappa)[Family.kinds, None] * common + 1e-9
    laws = [[rng.dirichlet(row) for row in around] for _ in range(n_types)]
    return rng.multinomial(n_tasks, laws).astype(float)


def log_score(counts, more, kappa, alpha):
    """Log probability of more effects by the laws that the concentrations make of counts."""
    total = counts.sum(axis=0)
    pooled = total + alpha[:, None] * group_laws(Family(), total, alpha)
    pooled /= pooled.sum(axis=1, keepdims=True)
    laws = counts + kappa[:, None] * pooled
    return float((more * np.log(laws / laws.sum(axis=2, keepdims=True))).sum())


def test_nothing_known_is_usual_and_an_impossible_effect_may_be_seen():
    none = np.zeros((2, N_CAUSES, N_EFFECTS))
    kappa, alpha = learnt_concentrations(Family(), none, none)
    assert [*np.unique(kappa), *np.unique(alpha)] == [*USUAL]
    family = Family()
    family.possible = np.tile([1.0, 0.0, 0.0, 0.0], (N_CAUSES, 1))
    none[0, 0, 1] = 1
    assert np.isfinite(learnt_concentrations(family, none, none).kappa).all()


def test_each_kind_of_cause_has_its_own():
    """Types agree in the first kind and have nothing in common in the second."""
    counts = drawn_counts(np.random.default_rng(1), (200.0, 0.1))
    kappa, _ = learnt_concentrations(Family(), counts, counts)
    assert (kappa[:3] >= 16).all()
    assert (kappa[3:] <= 0.5).all()
    # The order of types does not matter: fleets merge counts in any order.
    turned = learnt_concentrations(Family(), counts[::-1], counts[::-1])
    assert (turned.kappa == kappa).all()


@pytest.mark.parametrize("kappa", [(50.0, 50.0), (0.1, 0.1)])
def test_effects_to_come_are_predicted_better(kappa):
    usual = np.full(N_CAUSES, USUAL[0]), np.full(N_CAUSES, USUAL[1])
    gains = []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        counts = drawn_counts(rng, kappa, n_tasks=8)
        # Half of each type's tasks predict the other half.
        half = rng.binomial(counts.astype(int), 0.5).astype(float)
        gains.append(
            log_score(half, counts - half, *learnt_concentrations(Family(), half, half))
            - log_score(half, counts - half, *usual)
        )
    assert np.mean(gains) > 2 * np.std(gains) / len(gains) ** 0.5


def test_surprises_elsewhere_are_expected_here():
    """Where causes often show what they never showed before, what never happened to a cause is not impossible."""
    counts = np.zeros((1, N_CAUSES, N_EFFECTS))
    counts[0, :3, 0] = counts[0, 3:, 0] = 20
    steady = learnt_concentrations(Family(), counts, counts).alpha
    counts[0, 1, 1:] = counts[0, 2, 1:] = 1
    surprised = learnt_concentrations(Family(), counts, counts).alpha
    assert surprised[0] > 2 * steady[0]
    assert surprised[3] == steady[3]


def test_the_law_of_a_group_leaves_own_counts_out():
    family = Family()
    family.groups = np.array([0, 0, 1, 2, 3, 4])
    counts = np.zeros((N_CAUSES, N_EFFECTS))
    counts[0, 0], counts[1, 1], counts[2, 2] = 9, 9, 9
    laws = group_laws(family, counts, np.ones(N_CAUSES))
    assert laws[0].argmax() == 1  # from its fellow
    assert np.allclose(laws[2], 0.25)  # alone in its group: as the family says
