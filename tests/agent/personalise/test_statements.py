"""How many SQL statements a choice and its outcome take, and that both back ends answer alike."""

import pytest

from lifelore.agent.personalise.decisions import choose, update
from lifelore.memory import open_memory
from lifelore.memory.connection import Connection

from .studies import study_of

CHOICE = {"sqlite": 2, "postgresql": 2}
"""The user with the number of its decisions, and the decision."""
OUTCOME = {"sqlite": 4, "postgresql": 5}
"""The decision, its user (and on a server the decision again, once the user is locked), outcome and belief."""


@pytest.fixture
def statements(monkeypatch):
    """The statements so far, without those that begin and end transactions."""
    run = []

    def noted(name):
        real = getattr(Connection, name)

        def method(conn, *arguments):
            if name == "execute" or (conn.is_sqlite == (name == "change")):
                run.append(name)
            return real(conn, *arguments)

        monkeypatch.setattr(Connection, name, method)

    for name in ("execute", "change", "insert"):
        noted(name)
    return run


@pytest.mark.parametrize("back_end", ["sqlite", "postgresql"])
def test_a_known_users_choice_and_outcome_take_few_statements(back_end, new_place, statements):
    with open_memory(new_place(back_end)) as memory:
        study = study_of().keep(memory)
        choose(memory, study, "ann")
        for number in range(5):
            began = len(statements)
            made = choose(memory, study, "ann")
            chosen = len(statements)
            update(memory, study, made["decision"], float(number % 3))
            taken = chosen - began, len(statements) - chosen
            assert taken == (CHOICE[back_end], OUTCOME[back_end])


def test_both_back_ends_give_the_same_answers_bit_for_bit(new_place):
    def lived(back_end):
        with open_memory(new_place(back_end)) as memory:
            study = study_of(change=0.1).keep(memory)
            made = [choose(memory, study, "ann", context="phone", seed=3) for _ in range(6)]
            order = [made[2], *made[4:], *made[:2]]
            answers = [update(memory, study, one["decision"], place / 3) for place, one in enumerate(order)]
            answers += [*made, choose(memory, study, "ann", seed=3)]
            return [{key: value for key, value in one.items() if key != "decision"} for one in answers]

    assert lived("sqlite") == lived("postgresql")
