"""C4.16: Algorithm 9 by hand, and measures that see a step that differs."""

import numpy as np
import pytest

from reproduction.chapter4.ball_game.moves import N_OUTCOMES, N_SIGNALS, PRIOR_MOVES
from reproduction.chapter4.c4_16_beat_is_reuse.run import Algorithm9, measure


def test_algorithm_9_by_hand():
    counts = np.zeros((2, N_SIGNALS, 2))
    # In context 0 type 0 always has outcome 0; type 1 has outcomes 0 and 1 as often.
    counts[1, 0] = [8, 4]
    counts[1, 1] = [0, 4]
    beat = Algorithm9(counts, np.array([[1.0, 0.0], [0.0, 2.0]]))
    assert beat.probabilities(0.4).tolist() == pytest.approx([0.2, 0.8])  # 0.5 to 1.0
    small, total = PRIOR_MOVES / N_OUTCOMES, 8 + PRIOR_MOVES
    first, second = (8 + small) / total, (4 + small) / total
    for _ in range(2):
        beat.update(1, 0, 0)
    assert beat.printed == pytest.approx([first**2 / 2, second**2 / 2])
    assert beat.belief == pytest.approx(np.array([first**2, second**2]) / (first**2 + second**2))
    assert beat.probabilities(0.0).tolist() == [1.0, 0.0]


def session(**changed):
    return {"steps": 10, "alike": 10, "apart": 0.0, "vanished": 0, **changed}


def test_a_step_that_differs_is_seen():
    found = measure(
        {}, [{"sessions": [session(), session(alike=8, vanished=7)]}, {"sessions": [session(apart=0.25)]}]
    )
    assert found["decisions_alike"].value == pytest.approx(28 / 30)
    assert found["beliefs_apart"].value == 0.25
    assert found["products_that_vanish"].value == pytest.approx(1 / 3)
