"""How many SQL statements a choice and its outcome take, and that both back ends answer alike."""

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.study import Study
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import open_memory

EACH = 3
"""One to read, one to write the contribution, one to write its cells and the belief."""


FIRST = 8
"""Statements of the first choice for a user, which makes the key."""


@pytest.fixture
def study():
    library = PolicyLibrary.from_means(np.array([[8.0, 1.0, 4.0], [1.0, 8.0, 4.0]]), 2.0)
    return Study("s", library, dict.fromkeys(library.policies, "active"), rule="sampling")


@pytest.mark.parametrize("back_end", ["sqlite", "postgresql"])
def test_a_known_users_choice_and_outcome_take_three_statements_each(back_end, new_place, study):
    with open_memory(new_place(back_end)) as memory:
        for number in range(20):
            began = memory.statements
            made = choose(memory, study, "ann")
            chosen = memory.statements
            update(memory, study, made["decision"], float(number % 3))
            assert (number, chosen - began, memory.statements - chosen) == (
                number,
                EACH if number else FIRST,
                EACH,
            )
        assert memory.check() == []


def test_the_database_is_asked_no_more_than_is_counted(tmp_path, study):
    asked: list[str] = []
    with open_memory(tmp_path / "m.db") as memory:
        made = choose(memory, study, "ann")
        with memory._store.pool.connection() as conn:
            conn._driver.set_trace_callback(asked.append)
        before = memory.statements
        update(memory, study, made["decision"], 1.0)
        choose(memory, study, "ann")
        counted = memory.statements - before
    words = [statement.split()[0] for statement in asked[: asked.index("COMMIT", asked.index("COMMIT") + 1) + 1]]
    assert words == 2 * ["SELECT", "BEGIN", *["INSERT"] * (EACH - 1), "COMMIT"]
    assert counted == 2 * EACH


def test_both_back_ends_give_the_same_answers_bit_for_bit(new_place, study):
    def lived(back_end):
        answers = []
        with open_memory(new_place(back_end)) as memory:
            made = [choose(memory, study, "ann", context="phone", seed=3) for _ in range(6)]
            for one in [made[2], *made[4:], *made[:2]]:
                answers.append(update(memory, study, one["decision"], len(answers) / 3))
            return [made, answers, choose(memory, study, "ann", seed=3)]

    assert lived("sqlite") == lived("postgresql")
