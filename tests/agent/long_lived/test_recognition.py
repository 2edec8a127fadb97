"""Types that change within a task: the belief by hand's arithmetic, and types learn from their own spans."""

from copy import deepcopy

import numpy as np
import pytest

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, live_task
from lifelore.agent.long_lived.recognition import Recognition
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.domains.task_stream import DrawnTask, TaskStream
from tests.agent.long_lived.doors import Doors, DoorTask, N

FULL = AGENTS["full"]
CHANGE, UNKNOWN = 0.1, 0.05
FOLLOWING, STATIC = LivingSettings(n_episodes=8, change=CHANGE), LivingSettings(n_episodes=8)


class ChangingDoorTask(DoorTask):
    """The prize, which is sure, is behind the door of the drawn type, and from episode 4 on behind another."""

    def __init__(self, drawn: DrawnTask, later: int) -> None:
        self.later, self.begun = later, -1
        super().__init__(drawn)
        self.rng = type("Sure", (), {"random": staticmethod(lambda: 0.0)})()

    def begin(self):
        super().begin()
        self.begun += 1
        self.door = self.later if self.begun > 4 else self.door


def after(types, n_tasks):
    """What is known after tasks of some types in one context."""
    family = Doors(TaskStream(types, n_contexts=1, loyalty=0.0))
    made = Knowledge.empty(family)
    for number in range(n_tasks):
        live_task(made, *family.meet(number, FULL), FULL, LivingSettings(n_episodes=4), f"r.{number}")
    return made


@pytest.fixture(scope="module")
def two():
    """Two types, after 20 tasks; read only."""
    made = after(("0", "1"), 20)
    assert len(made.known_types()) == 2
    return made


def following(knowledge, prior):
    made = Recognition(knowledge, np.array(prior), 0.05, UNKNOWN, 0, CHANGE, 8)
    made.begin_episode()
    return made


def row_of_door(knowledge, door):
    """The row of the type whose prize is behind a door."""
    laws = knowledge.known_types().laws(np.zeros((N, 2)))[:-1, :, 0]
    return int(laws[:, door].argmax())


def test_a_type_is_followed_by_another_one(two):
    recognition = following(two, [0.6, 0.4])
    assert recognition.belief == pytest.approx([0.95 * 0.6, 0.95 * 0.4, 0.05])
    # With p = (0.57, 0.38, 0.05): another than the first, 0.38 / 0.43 the second; than an unknown one, p itself.
    b = p = np.array([0.57, 0.38, 0.05])
    another = np.array(
        [
            b[1] * p[0] / (1 - p[1]) + b[2] * p[0],
            b[0] * p[1] / (1 - p[0]) + b[2] * p[1],
            b[0] * p[2] / (1 - p[0]) + b[1] * p[2] / (1 - p[1]) + b[2] * p[2],
        ]
    )
    assert another.sum() == pytest.approx(1)
    recognition.begin_episode()
    assert recognition.belief == pytest.approx((1 - CHANGE) * b + CHANGE * another)


def test_a_cause_tells_of_the_type_once_and_is_counted_each_time(two):
    recognition = Recognition(two, np.array([0.5, 0.5]), 0.05, UNKNOWN, 0)
    recognition.begin_episode()
    recognition.observe(((0, 0),))
    belief = recognition.belief
    assert belief.argmax() == row_of_door(two, 0)
    recognition.observe(((0, 0),))
    assert recognition.belief.tolist() == belief.tolist()
    assert recognition.own[0].tolist() == [2, 0]


def test_a_single_known_type_can_only_become_an_unknown_one():
    recognition = following(after(("0",), 3), [1.0])
    recognition.begin_episode()
    stays = 0.9 * 0.95 + 0.1 * 0.05 * 0.95
    assert recognition.belief == pytest.approx([stays, 1 - stays])


def test_weights_of_starts_are_those_of_bayes_rule(two):
    recognition = following(two, [0.5, 0.5])
    recognition.observe(((0, 0), (1, 1), (2, 1)))
    old = recognition.belief
    recognition.begin_episode()
    fresh = (recognition.belief - (1 - CHANGE) * old) / CHANGE
    known, own = two.known_types(), np.zeros((N, 2))
    own[[0, 1, 2], [0, 1, 1]] = 1
    # Door 0 is empty now: under the old start the scene has answered otherwise before.
    likely = old @ known.laws(own)[:, 0, 1], fresh @ known.laws(np.zeros((N, 2)))[:, 0, 1]
    evidence = np.array([1 - CHANGE, CHANGE]) * likely
    recognition.observe(((0, 1),))
    assert recognition._weight == pytest.approx(evidence / evidence.sum())
    assert recognition._weight[1] > 0.5
    assert [span.first for span in recognition.spans()] == [0, 1]


def test_what_the_task_has_shown_fades_for_types_that_are_new_since(two):
    recognition = following(two, [0.5, 0.5])
    recognition.observe(((0, 0), (1, 1), (2, 1)))
    assert recognition.own.tolist() == [[1, 0], [0, 1], [0, 1]]
    recognition.begin_episode()
    recognition.observe(((0, 1), (1, 0)))
    old, new = row_of_door(two, 0), row_of_door(two, 1)
    assert recognition.belief.argmax() == new
    assert recognition.own[new, 2, 1] < 0.1
    assert recognition.own[old, 2, 1] > 0.5


def lived(knowledge, later, living):
    """A task whose prize moves from door 0 to another after four episodes, and what is known then."""
    knowledge, drawn = deepcopy(knowledge), DrawnTask(100, 0, "0")
    names = [knowledge.known_types().types[row_of_door(knowledge, door)].members[0] for door in (0, 1)]
    before = knowledge.types[names[0]].effects.counts([0])[0]
    found, _ = live_task(knowledge, drawn, ChangingDoorTask(drawn, later), FULL, living, "r.100")
    return found, knowledge, names, knowledge.types[names[0]].effects.counts([0])[0] - before


def test_the_agent_follows_and_types_learn_from_their_own_spans(two):
    found, _, (one, other), taught = lived(two, 1, FOLLOWING)
    opened = [episode[0].act for episode in found.decisions]
    assert (opened[:4], opened[5:]) == ([0] * 4, [1] * 3)
    assert (found.learnt, found.changes, found.alarm) == (one, [(4, other)], False)
    # As far as it was believed at the end of its span, and nothing of the span after.
    assert 0.5 < taught[0] <= 1
    assert taught[1] < 0.05


def test_the_static_agent_mixes_types(two):
    found, _, _, taught = lived(two, 1, STATIC)
    assert found.changes == []
    # A type that there is not, or an old one with effects of both.
    assert found.learnt == "r.100" or taught[1] > 0.1


def test_a_change_to_an_unknown_type_is_noticed_and_learnt(two):
    found, knowledge, _, _ = lived(two, 2, FOLLOWING)
    assert found.changes == [(4, "r.100-4")]
    assert knowledge.types["r.100-4"].effects.counts([0, 1]) == pytest.approx(np.array([[0, 1], [0, 1]]))
    # An agent without types follows too.
    drawn, made = DrawnTask(0, 0, "0"), Knowledge.empty(knowledge.family)
    first, _ = live_task(made, drawn, ChangingDoorTask(drawn, 2), FULL, FOLLOWING, "r.0")
    assert first.decisions[-1][0].act == 2
    assert sorted(made.types) == ["r.0", f"r.0-{first.changes[0][0]}"]
