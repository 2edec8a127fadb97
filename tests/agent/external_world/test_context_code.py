"""Codes of contexts: equal exactly where contexts are, in every process; and a shared one is found out."""

import os
import subprocess
import sys
from dataclasses import dataclass
from enum import Enum, IntEnum

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.external_world.context_code import CODE_BITS, MOST_ACTIONS, ContextCodes, context_code
from lifelore.core.errors import InputError


class Colour(Enum):
    RED = 1


class Size(IntEnum):
    SMALL = 1


@dataclass(frozen=True)
class Spot:
    row: int
    colour: Colour = Colour.RED


LEAVES = (
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False)
    | st.text() | st.binary() | st.just(Colour.RED) | st.builds(Spot, st.integers())
)  # fmt: skip
FLAT = LEAVES | st.lists(LEAVES, max_size=3).map(tuple) | st.frozensets(LEAVES, max_size=3)
PARTS = FLAT | st.lists(FLAT, max_size=3).map(tuple)


@pytest.mark.slow
@settings(max_examples=40)
@given(PARTS, PARTS)
def test_contexts_share_a_code_exactly_if_they_are_equal(one, other):
    assert (context_code(one) == context_code(other)) == (one == other)
    assert 0 <= context_code(one) < 2**CODE_BITS


def test_codes_by_hand():
    """Memories depend on these numbers: they never change."""
    assert context_code("hall") == 67260151065772
    assert context_code((1, "a", None, b"x", 0.5, frozenset({2, 1}))) == 78556516542077
    equal = [1, 1.0, True, np.int8(1), np.float32(1), np.bool_(True), Size.SMALL]
    assert len({context_code(value) for value in equal}) == 1
    apart = [
        1, 0.5, -1, None, "1", b"1", "none", "(1)", (), ((),), (1,), ((1,),), ("a,b",), ("a", "b"),
        frozenset(), frozenset({1}), Colour.RED, Spot(1),
    ]  # fmt: skip
    assert len({context_code(value) for value in apart}) == len(apart)


@pytest.mark.slow
def test_codes_of_states_and_moves_are_the_same_in_a_process_of_another_hash_seed():
    words = (
        "import numpy as np\n"
        "from lifelore.agent.external_world.context_code import context_code\n"
        "from lifelore.agent.external_world.gymnasium_world import hashable\n"
        "from lifelore.agent.any_tasks.moves import MoveCodes\n"
        "codes = MoveCodes()\n"
        "found = context_code(frozenset(('left', 'right', ('far', 2.5)))), codes.cause(codes.states['a', 1], 2)\n"
        "found += hashable({'b': np.eye(2), 'a': 'x', 'c': np.int8(3)})\n"
    )
    here: dict = {}
    exec(words, here)
    own = [sys.executable, "-c", words + "print(found)"]
    env = os.environ | {"PYTHONHASHSEED": "3"}
    other = subprocess.run(own, env=env, capture_output=True, text=True, check=True)
    assert other.stdout.strip() == str(here["found"])


def test_contexts_that_share_a_code_are_found_out():
    """Nine contexts do not fit eight codes."""
    codes = ContextCodes(bits=3)
    with pytest.raises(InputError, match=r"contexts .* and .* share the code"):
        [codes[context] for context in range(9)]
    assert len({ContextCodes()[context] for context in range(1000)}) == 1000


def test_the_largest_code_fits_a_slot_with_the_most_actions():
    prior = ActionPrior(MOST_ACTIONS)
    prior.update([2**CODE_BITS - 1], np.arange(MOST_ACTIONS)[None] == MOST_ACTIONS - 1)
    assert prior.to_record().slots.tolist() == [2**CODE_BITS * MOST_ACTIONS - 1]


@pytest.mark.parametrize("context", [object(), float("nan"), float("inf"), (1, object()), 1j, Spot, ["a"]])
def test_contexts_without_a_stable_code_are_refused(context):
    with pytest.raises(InputError, match=r"state or context must be (made of finite numbers|hashable, got list)"):
        ContextCodes()[context]
