"""Types that change within a task: the belief by hand's arithmetic, and types learn from their own spans."""

import numpy as np
import pytest

from lifelore.agent.long_lived.changing_recognition import ChangingRecognition
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, live_task, recognition_of
from lifelore.agent.long_lived.recognition import Recognition
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.core.errors import InputError
from lifelore.domains.task_stream import DrawnTask, TaskStream
from tests.agent.long_lived.doors import Doors, DoorTask, N

FULL = AGENTS["full"]
CHANGE, UNKNOWN = 0.1, 0.05
FOLLOWING, STATIC = LivingSettings(n_episodes=8, change=CHANGE), LivingSettings(n_episodes=8)


class ChangingDoorTask(DoorTask):
    """The prize changes its door from some episode on, and is sure to be there."""

    def __init__(self, drawn: DrawnTask, later: str, first: int) -> None:
        super().__init__(drawn)
        self.later, self.first, self.begun = int(later), first, 0
        self.rng = type("Sure", (), {"random": staticmethod(lambda: 0.0)})()

    def begin(self):
        super().begin()
        if hasattr(self, "begun"):
            self.begun += 1
            self.door = self.later if self.begun > self.first else self.door


@pytest.fixture
def knowledge():
    """Two types, seen 30 times in one context."""
    family = Doors(TaskStream(("0", "1"), n_contexts=1, loyalty=0.0))
    made = Knowledge.empty(family)
    for number in range(30):
        live_task(made, *family.meet(number, FULL), FULL, LivingSettings(n_episodes=4), f"r.{number}")
    return made


def following(knowledge, prior):
    return ChangingRecognition(knowledge, np.array(prior), 0.05, UNKNOWN, 0, CHANGE, 8)


def row_of_door(knowledge, door):
    """The row of the type whose prize is behind a door."""
    laws = knowledge.known_types().laws(np.zeros((N, 2)))[:-1, :, 0]
    return int(laws[:, door].argmax())


def test_a_type_is_followed_by_another_one(knowledge):
    n = len(knowledge.known_types())
    assert n == 2
    recognition = following(knowledge, [0.6, 0.4])
    recognition.begin_episode()
    assert recognition.belief == pytest.approx([0.95 * 0.6, 0.95 * 0.4, 0.05])
    # With p = (0.57, 0.38, 0.05): another than the first, 0.38 / 0.43 the second; than an unknown one, p itself.
    b = np.array([0.57, 0.38, 0.05])
    p = b
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


def test_weights_of_starts_are_those_of_bayes_rule(knowledge):
    recognition = following(knowledge, [0.5, 0.5])
    recognition.begin_episode()
    recognition.observe(((0, 0), (1, 1), (2, 1)))
    old = recognition.belief
    recognition.begin_episode()
    new = recognition.belief
    stayed, fresh = old.copy(), (new - (1 - CHANGE) * old) / CHANGE
    known = knowledge.known_types()
    own = np.zeros((N, 2))
    own[[0, 1, 2], [0, 1, 1]] = 1
    # Door 0 is empty now: under the old start the scene has answered otherwise before.
    evidence = np.array(
        [
            (1 - CHANGE) * (stayed @ known.laws(own)[:, 0, 1]),
            CHANGE * (fresh @ known.laws(np.zeros((N, 2)))[:, 0, 1]),
        ]
    )
    recognition.observe(((0, 1),))
    assert recognition._weight == pytest.approx(evidence / evidence.sum())
    assert recognition._weight[1] > 0.5
    assert [span.first for span in recognition.spans()] == [0, 1]


def test_what_the_task_has_shown_fades_for_types_that_are_new_since(knowledge):
    recognition = following(knowledge, [0.5, 0.5])
    recognition.begin_episode()
    recognition.observe(((0, 0), (1, 1), (2, 1)))
    before = recognition.own
    assert before == pytest.approx(np.broadcast_to(before[0], before.shape))
    recognition.begin_episode()
    recognition.observe(((0, 1), (1, 0)))
    old, new = row_of_door(knowledge, 0), row_of_door(knowledge, 1)
    assert recognition.belief.argmax() == new
    assert recognition.own[new, 2, 1] < 0.1
    assert recognition.own[old, 2, 1] > 0.5


def test_without_a_rate_of_changes_the_type_stays(knowledge):
    prior = np.array([0.5, 0.5])
    assert type(recognition_of(knowledge, prior, STATIC, 0)) is Recognition
    assert type(recognition_of(knowledge, prior, FOLLOWING, 0)) is ChangingRecognition
    with pytest.raises(InputError, match="change must be at least 0 and below 1"):
        LivingSettings(change=1.0)


def taught_by_a_change(knowledge, living):
    """A task whose prize moves from door 0 to door 1 after four episodes; what it adds to the type of door 0."""
    drawn = DrawnTask(100, 0, "0")
    one = knowledge.known_types().types[row_of_door(knowledge, 0)].members[0]
    before = knowledge.types[one].effects.counts([0])[0]
    lived, _ = live_task(knowledge, drawn, ChangingDoorTask(drawn, "1", 4), FULL, living, "r.100")
    return lived, one, knowledge.types[one].effects.counts([0])[0] - before


def test_the_agent_follows_and_types_learn_from_their_own_spans(knowledge):
    other = knowledge.known_types().types[row_of_door(knowledge, 1)].members[0]
    lived, one, taught = taught_by_a_change(knowledge, FOLLOWING)
    opened = [episode[0].act for episode in lived.decisions]
    assert (opened[:4], opened[5:]) == ([0] * 4, [1] * 3)
    assert (lived.learnt, lived.changes) == (one, [(4, other)])
    # As far as it was believed at the end of its span, and nothing of the span after.
    assert 0.5 < taught[0] <= 1
    assert taught[1] < 0.05
    assert not lived.alarm


def test_the_static_agent_mixes_types(knowledge):
    lived, _, taught = taught_by_a_change(knowledge, STATIC)
    assert lived.changes == []
    # A type that there is not, or an old one with effects of both.
    assert lived.learnt == "r.100" or taught[1] > 0.1


def test_a_change_to_an_unknown_type_is_noticed_and_learnt(knowledge):
    drawn = DrawnTask(100, 0, "0")
    lived, _ = live_task(knowledge, drawn, ChangingDoorTask(drawn, "2", 4), FULL, FOLLOWING, "r.100")
    assert lived.changes == [(4, "r.100-4")]
    assert knowledge.types["r.100-4"].effects.counts([0, 1]) == pytest.approx(np.array([[0, 1], [0, 1]]))


def test_a_single_known_type_can_only_become_an_unknown_one():
    family = Doors(TaskStream(("0",), n_contexts=1))
    made = Knowledge.empty(family)
    for number in range(3):
        live_task(made, *family.meet(number, FULL), FULL, LivingSettings(n_episodes=4), f"r.{number}")
    assert len(made.known_types()) == 1
    recognition = following(made, [1.0])
    recognition.begin_episode()
    recognition.begin_episode()
    assert recognition.belief == pytest.approx(
        [0.9 * 0.95 + 0.1 * 0.05 * 0.95, 1 - 0.9 * 0.95 - 0.1 * 0.05 * 0.95]
    )


def test_an_agent_without_types_follows_too():
    family = Doors(TaskStream(("0",), n_contexts=1))
    drawn = DrawnTask(0, 0, "0")
    made = Knowledge.empty(family)
    lived, _ = live_task(made, drawn, ChangingDoorTask(drawn, "2", 4), FULL, FOLLOWING, "r.0")
    assert lived.changes
    assert lived.decisions[-1][0].act == 2
    assert sorted(made.types) == ["r.0", f"r.0-{lived.changes[0][0]}"]
