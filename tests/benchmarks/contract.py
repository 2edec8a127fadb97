"""The contract of every benchmark's answer, for all its tests."""

import json
import math


def checked(result: dict, told: list[tuple[int, int, str]]) -> dict[str, dict]:
    """The rows by name, once names, ratios, goals and the progress have been checked."""
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    rows = {line["name"]: line for line in result["rows"]}
    assert len(rows) == len(result["rows"])
    for line in rows.values():
        assert list(line) == ["name", "value", "unit", "ratio_to", "ratio"]
        assert line["ratio_to"] in (None, *rows)
        assert all(number is None or math.isfinite(number) for number in (line["value"], line["ratio"]))
    for goal in result["goals"]:
        assert list(goal) == ["name", "goal", "measured", "met"]
        assert (goal["measured"] is None) == (goal["met"] is None)
    assert [(done, of) for done, of, _ in told] == [(i + 1, len(told)) for i in range(len(told))]
    return rows
