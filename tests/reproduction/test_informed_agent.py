"""The informed agent of tabletop lives: it sees true relations, and is told the type."""

import numpy as np
import pytest

from lifelore.domains.tabletop.layout import stand
from lifelore.domains.tabletop.shapes import box
from lifelore.domains.tabletop_job.job import PICK, PUT_ASIDE, TabletopJob
from lifelore.domains.tabletop_job.job_types import job_type_named
from lifelore.domains.tabletop_job.tray import sample_tray, tray_of
from lifelore.domains.task_stream import TaskStream

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim

from benchmarks.lives.informed_agent import (  # noqa: E402
    ToldType,
    carried_shares,
    informed_returns,
    look_at_true_relations,
)
from lifelore.agent.long_lived.families.tabletop import TabletopFamily  # noqa: E402
from lifelore.agent.long_lived.families.tray_features import look_with_labels  # noqa: E402
from lifelore.agent.long_lived.known_types import KnownType, KnownTypes  # noqa: E402


def test_a_block_carries_all_of_what_stands_on_it():
    placed = [stand(box(0.1, 0.1, 0.06)), stand(box(0.06, 0.06, 0.05), height=0.06)]
    job = TabletopJob(tray_of(placed, 1), job_type_named("patient/firm"))
    np.testing.assert_allclose(carried_shares(job), [[0, 0], [1, 0]], atol=0.05)
    job.step(PICK * 2 + 1)
    job.step(PUT_ASIDE * 2 + 1)
    np.testing.assert_allclose(carried_shares(job), np.zeros((2, 2)), atol=0.01)


def test_it_sees_what_carries_what():
    job = TabletopJob(sample_tray(3, 1), job_type_named("patient/firm"))
    seen, perceived = look_at_true_relations(job), look_with_labels(job)
    assert seen is not None
    assert perceived is not None
    assert seen.objects == perceived.objects
    carried = carried_shares(job)
    for a in seen.objects:
        for b in seen.objects - {a}:
            assert (seen.carries.get((a, b), 0.0) == 1) == (carried[a, b] > 0.05)


@pytest.mark.slow
def test_it_knows_the_outcomes_of_its_first_life():
    """A single type: after four tasks told of their type, first episodes reach most of the best possible."""
    family = TabletopFamily(TaskStream(("patient/firm",), n_contexts=1), seed=3)
    returns = informed_returns(family, 4, 3, seed=0)
    best = [family.best_return(number) for number in range(4)]
    assert all(found <= high + 1e-9 for found, high in zip(returns, best, strict=True))
    assert returns.sum() > 0.7 * sum(best)


def test_the_type_is_told():
    family = TabletopFamily(TaskStream(("patient/firm", "hurried/wide")))
    known = KnownTypes(family, [KnownType.empty(family, name) for name in family.stream.types])
    assert ToldType(known, 1).belief.tolist() == [0, 1, 0]
