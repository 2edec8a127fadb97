"""The checker names each mistake of a family in one line, and `live_long` names those that it meets."""

import itertools
import re
from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.long_lived.check_family import MOST_ACTS, check_family
from lifelore.agent.long_lived.families.by_name import family_named
from lifelore.agent.long_lived.knowledge import MOST_CONTEXTS
from lifelore.agent.long_lived.long_life import live_long
from lifelore.agent.long_lived.task_family import AgentTask, Plan, Step
from lifelore.core.errors import InputError
from lifelore.domains.task_stream import TaskStream
from tests.agent.long_lived.doors import Doors, DoorTask

STREAM = TaskStream(("0", "1"))


def family(of_family=None, of_task=None):
    """Doors with other attributes of the family or of its tasks."""
    task_class = type("Task", (DoorTask,), of_task or {})

    def meet(self, number, abilities, context=None):
        drawn = self.stream.draw(number, context)
        return drawn, task_class(drawn)

    return type("Family", (Doors,), {"meet": meet, **(of_family or {})})(STREAM)


def step(**changes):
    """Tasks whose every step has some other part."""
    return {"act": lambda self, act: replace(DoorTask.act(self, act), **changes)}


def plan(**changes):
    return {"plan": lambda self, *given: replace(DoorTask.plan(self, *given), **changes)}


def meet(change):
    """A family that changes what meeting a task returns."""
    return {"meet": lambda self, *given: change(*Doors.meet(self, *given))}


@pytest.mark.parametrize("name", ["factory-customers", "building-days"])
def test_our_families_pass(name):
    check_family(family_named(name, 0))


def test_doors_pass():
    check_family(Doors(STREAM), tasks=20)


COUNTER = itertools.count()
CONSTANTS = {
    "name must be a text without '/', got ''": {"name": ""},
    "name must be a text without '/', got 'a/b'": {"name": "a/b"},
    "acts must be a tuple of names, at least one, got ()": {"acts": ()},
    "n_causes must be a whole number from 1, got 0": {"n_causes": 0},
    "n_effects must be a whole number from 1, got 2.0": {"n_effects": 2.0},
    "possible must be an array of shape (3, 2), causes × effects, got (2, 3)": {
        "possible": np.full((2, 3), 1 / 3)
    },
    "rows of possible must be probabilities with sum 1, got [1.0, 1.0] for cause 0": {"possible": np.ones((3, 2))},
    "rows of possible must be probabilities with sum 1, got [-1.0, 2.0] for cause 2": {
        "possible": np.array([[0.5, 0.5], [1.0, 0.0], [-1.0, 2.0]])
    },
    "rows of possible must be probabilities with sum 1, got [nan, 1.0] for cause 0": {
        "possible": np.array([[np.nan, 1.0], [0.5, 0.5], [0.5, 0.5]])
    },
    "groups must be an array of shape (3,), a value a cause, got (2,)": {"groups": np.arange(2)},
    "groups must be numbers from 0, got -1": {"groups": np.array([-1, 0, 1])},
    "kinds must hold integer values, got float64": {"kinds": np.zeros(3)},
    "judges must be an array of shape (3,), a value a cause, got (3,)": {"judges": [True, True, False]},
    "judges must hold bool values, got int64": {"judges": np.ones(3, int)},
    "constancy must be finite and above 0, got 0.0": {"constancy": np.zeros(3)},
    "smoothed must keep the shape of counts, (1, 3, 2), got (1, 3)": {"smoothed": lambda self, n: n.sum(axis=2)},
}
IN_TASKS = {
    "meet must return (DrawnTask, task), got None": (meet(lambda drawn, task: None), None),
    "meet must return task 0, got task 1": (meet(lambda drawn, task: (replace(drawn, number=1), task)), None),
    f"a context must lie in 0..{MOST_CONTEXTS - 1}, got -1 in task 0": (
        meet(lambda drawn, task: (replace(drawn, context=-1), task)),
        None,
    ),
    "a context must lie in 0..1048575, got 'kitchen' in task 0": (
        meet(lambda drawn, task: (replace(drawn, context="kitchen"), task)),
        None,
    ),
    "best_return must be a finite number, got nan for task 0": ({"best_return": lambda *given: np.nan}, None),
    "plan must return a Plan, got NoneType": (None, {"plan": lambda *given: None}),
    "values of a plan must be of shape (%, %), types × behaviours, got (%,)": (None, plan(values=np.zeros(3))),
    "values of a plan must be of shape (%, %), types × behaviours, got (4, 1)": (
        None,
        plan(values=np.zeros((4, 1))),
    ),
    "values of a plan must be finite, got infinite or missing ones": (
        None,
        {
            "plan": lambda self, laws, *given: Plan(
                np.full((len(laws),) * 2, np.inf), *np.zeros((2, len(laws)), int)
            )
        },
    ),
    "acts of a plan must be of shape (%,), got (9,)": (None, plan(acts=np.zeros(9, int))),
    "acts of a plan must lie in 0..3, got %4%": (
        None,
        {
            "plan": lambda self, laws, *given: replace(
                DoorTask.plan(self, laws, *given), acts=np.full(len(laws), 4)
            )
        },
    ),
    "trying of a plan must lie in 0..3, got %-1%": (
        None,
        {
            "plan": lambda self, laws, *given: replace(
                DoorTask.plan(self, laws, *given), trying=np.full(len(laws), -1)
            )
        },
    ),
    "act must return a Step, got tuple for '%'": (None, {"act": lambda self, act: (0.0, (), True)}),
    "a reward must be a finite number, got nan for act '%'": (None, step(reward=float("nan"))),
    "a reward must be a finite number, got None for act '%'": (None, step(reward=None)),
    "cause must lie in 0..2 (n_causes = 3), got 3 for act '%'": (None, step(effects=((3, 0),))),
    "effect must lie in 0..1 (n_effects = 2), got -1 for act '%'": (None, step(effects=((0, -1),))),
    "effect must lie in 0..1 (n_effects = 2), got 'prize' for act '%'": (None, step(effects=((0, "prize"),))),
    "effects must be pairs (cause, effect), got (0,) for act '%'": (None, step(effects=((0,),))),
}
PLAYED = {
    "task 0 must be the same task each time, got %": (
        meet(lambda drawn, task: (replace(drawn, hidden_type=str(next(COUNTER))), task)),
        None,
    ),
    f"episode 0 of task 0 must end, got {MOST_ACTS} acts without an end; let the last Step have ended": (
        None,
        {"act": lambda self, act: Step(0.0, (), False)},
    ),
    "describe must return a text, got 3": (None, {"describe": lambda self: 3}),
    "best_acts must be of shape (1, 4), contexts × acts, got (1, 3)": (
        None,
        {"best_acts": lambda *given: (np.array([0]), np.ones((1, 3), bool))},
    ),
}


def pattern(message):
    """A line that is the message, in which % stands for anything."""
    parts = [re.escape(part) for part in message.split("%")]
    return re.compile(f"family '.*': {'.*'.join(parts)}")


@pytest.mark.parametrize("message", CONSTANTS)
def test_wrong_constants_are_named_before_a_task(message):
    wrong = family(CONSTANTS[message])
    for refuse in (check_family, live_long):
        with pytest.raises(InputError) as refused:
            refuse(wrong)
        assert pattern(message).fullmatch(str(refused.value)), refused.value


@pytest.mark.parametrize("message", IN_TASKS)
def test_mistakes_in_tasks_are_named_by_the_checker_and_in_a_life(message):
    wrong = family(*IN_TASKS[message])
    for refuse in (check_family, live_long):
        with pytest.raises(InputError) as refused:
            refuse(wrong, tasks=2)
        assert pattern(message).fullmatch(str(refused.value)), refused.value


@pytest.mark.parametrize("message", PLAYED)
def test_the_checker_alone_finds_what_costs_time(message):
    with pytest.raises(InputError) as refused:
        check_family(family(*PLAYED[message]))
    assert pattern(message).fullmatch(str(refused.value)), refused.value


def test_a_family_derives_from_the_base():
    with pytest.raises(InputError, match="family must derive from TaskFamily, got Stranger"):
        check_family(type("Stranger", (), {})())  # type: ignore[arg-type]


def test_what_is_missing_is_named():
    nameless = type("Nameless", (Doors,), {})(STREAM)
    with pytest.MonkeyPatch.context() as patch:
        patch.delattr(Doors, "n_effects")
        with pytest.raises(InputError, match="family Nameless must have an attribute n_effects"):
            check_family(nameless)
    with pytest.raises(TypeError, match="best_return"):
        type("Half", (Doors,), {"best_return": Doors.__mro__[1].best_return})(STREAM)


def test_a_late_mistake_is_found_in_the_task_that_has_it():
    """A reward that is wrong in task 5 alone: three tasks do not show it, six do."""

    class Late(DoorTask):
        def __init__(self, drawn):
            super().__init__(drawn)
            self.wrong = drawn.number == 5

        def act(self, act):
            found = super().act(act)
            return replace(found, reward=np.inf) if self.wrong else found

    late = type("Late", (Doors,), {"meet": lambda self, number, *given: (
        STREAM.draw(number), Late(STREAM.draw(number))
    )})(STREAM)  # fmt: skip
    check_family(late)
    with pytest.raises(InputError, match="got inf"):
        check_family(late, tasks=6)


def test_defaults_by_hand():
    class Bare(Doors):
        cause_name = Doors.__mro__[1].cause_name
        effect_name = Doors.__mro__[1].effect_name

    bare = Bare(STREAM)
    assert bare.possible.tolist() == [[0.5, 0.5]] * 3
    assert bare.groups.tolist() == [0, 1, 2]
    assert bare.kinds.tolist() == [0, 0, 0]
    assert bare.judges.tolist() == [True, True, True]
    assert bare.constancy.tolist() == [0.5, 0.5, 0.5]
    counts = np.arange(6.0).reshape(1, 3, 2)
    assert bare.smoothed(counts) is counts
    assert (bare.domain, bare.cause_name(2), bare.effect_name(2, 1)) == ("doors", "cause 2", "effect 1")
    assert type("Three", (Bare,), {"acts": ("a", "b", "c")})(STREAM).cause_name(2) == "c"


def test_a_task_has_defaults_too():
    class Short(AgentTask):
        def begin(self):
            self.tries = 0

        def act(self, act):
            self.tries += 1
            return Step(0.0, (), self.tries == 2)

        def plan(self, laws, tried, new, shared):
            acts = np.zeros(len(laws), np.int64)
            return Plan(np.zeros((len(laws), len(laws))), acts, acts)

    short = type("Few", (Doors,), {"meet": lambda self, number, *given: (STREAM.draw(number), Short())})(STREAM)
    check_family(short)
    assert (Short().context, Short().describe()) == (0, "")
    assert len(live_long(short, tasks=2)["tasks"]) == 2
