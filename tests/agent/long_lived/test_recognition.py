"""The belief over types in a task: what counts as evidence, and how often."""

import numpy as np
import pytest

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import live_task
from lifelore.agent.long_lived.recognition import Recognition
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.domains.task_stream import TaskStream
from tests.agent.long_lived.doors import Doors, N

FULL = AGENTS["full"]


def test_a_cause_tells_of_the_type_once_and_is_counted_each_time():
    two = Knowledge.empty(family := Doors(TaskStream(("0", "1"), n_contexts=1, loyalty=0.0)))
    for number in range(20):
        two.learn(live_task(two, *family.meet(number, FULL), FULL, f"r.{number}", n_episodes=4)[1])
    assert len(two.known_types()) == 2
    recognition = Recognition(two, np.array([0.6, 0.4]), 0.05, 0.05, 0)
    assert recognition.belief == pytest.approx([0.95 * 0.6, 0.95 * 0.4, 0.05])
    recognition.observe(((0, 0),))
    belief = recognition.belief
    assert belief.argmax() == two.known_types().laws(np.zeros((N, 2)))[:-1, 0, 0].argmax()
    recognition.observe(((0, 0),))
    assert recognition.belief.tolist() == belief.tolist()
    assert recognition.own[0].tolist() == [2, 0]
