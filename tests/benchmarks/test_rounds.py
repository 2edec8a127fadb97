"""Rounds: the order of contenders, paired ratios, and lines by hand."""

from benchmarks.rounds import counted, interleaved, joined, paired_ratio


def test_rounds_are_interleaved_and_turn_round():
    order = []
    rates = interleaved({"a": lambda: 1.0, "b": lambda: 2.0}, 3, order.append)
    assert order == ["a", "b", "b", "a", "a", "b"]
    assert rates == {"a": [1.0] * 3, "b": [2.0] * 3}


def test_ratios_are_paired():
    # 1/2, 4/4, 9/3: the median of pairs is 1, of medians it were 4/3.
    assert paired_ratio([1.0, 4.0, 9.0], [2.0, 4.0, 3.0]) == 1.0


def test_parts_are_joined_and_pieces_counted():
    assert joined(([1], [2]), ([3, 4], [])) == {"rows": [1, 3, 4], "goals": [2]}
    told = []
    after = counted(lambda *at: told.append(at), 2)
    after("a")
    after("b")
    assert told == [(1, 2, "a"), (2, 2, "b")]
