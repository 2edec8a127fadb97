"""Lives of tabletop jobs: shared trays, types from the stream."""

import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop_job.job_stream import ALL_TYPES, TabletopJobs
from lifelore.domains.task_stream import TaskStream

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim
PAIR = TabletopSettings(n_objects=(2, 2))


@pytest.mark.slow
def test_lives_share_trays_and_differ_in_types():
    lives = [TabletopJobs(TaskStream(ALL_TYPES, seed=seed), 1, PAIR) for seed in (0, 1)]
    drawn = [[life.task(k) for k in range(3)] for life in lives]
    for (one, first), (other, second) in zip(*drawn, strict=True):
        assert first.tray is second.tray
        assert first.job_type.name == one.hidden_type
        assert one.number == other.number
    types = [[task.hidden_type for task, _ in life] for life in drawn]
    assert types[0] != types[1]


def test_mistakes_are_refused():
    with pytest.raises(NotFoundError, match="type must be one of"):
        TabletopJobs(TaskStream(("kind/firm",)), 1, PAIR).task(0)
    with pytest.raises(InputError, match="mix must be None"):
        TabletopJobs(TaskStream(ALL_TYPES), 1, TabletopSettings(mix={"on": 1.0})).task(0)
