"""Rounds: the order of contenders, paired ratios, and lines by hand."""

from benchmarks.rounds import at_least, at_most, counted, interleaved, joined, paired_ratio, row, row_beside


def test_rounds_are_interleaved_and_turn_round():
    order = []
    rates = interleaved({"a": lambda: 1.0, "b": lambda: 2.0}, 3, order.append)
    assert order == ["a", "b", "b", "a", "a", "b"]
    assert rates == {"a": [1.0] * 3, "b": [2.0] * 3}


def test_ratios_are_paired():
    # 1/2, 4/4, 9/3: the median of pairs is 1, of medians it were 4/3.
    assert paired_ratio([1.0, 4.0, 9.0], [2.0, 4.0, 3.0]) == 1.0


def test_lines_by_hand():
    assert at_least("x", 2.0, 2.0) == {"name": "x", "goal": ">= 2.0", "measured": 2.0, "met": True}
    assert at_most("x", 2.0, 2.1)["met"] is False
    assert at_least("x", 2.0, None)["met"] is None
    assert row("x", 1.0, "s") == {"name": "x", "value": 1.0, "unit": "s", "ratio_to": None, "ratio": None}
    # Medians 2 and 3; pairs 1/2, 2/2, 9/3 have the median 1.
    rates = {"a": [1.0, 2.0, 9.0], "b": [2.0, 2.0, 3.0]}
    assert row_beside("a", rates, "s", "b") == row("a", 2.0, "s", "b", 1.0)
    assert row_beside("b", rates, "s") == row("b", 2.0, "s")


def test_parts_are_joined_and_pieces_counted():
    assert joined(([1], [2]), ([3, 4], [])) == {"rows": [1, 3, 4], "goals": [2]}
    told = []
    after = counted(lambda *at: told.append(at), 2)
    after("a")
    after("b")
    assert told == [(1, 2, "a"), (2, 2, "b")]
