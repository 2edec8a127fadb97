"""docs/novelty.md: its Python runs as it stands, its table is that of results/bench_novelty.json."""

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "novelty.md").read_text(encoding="utf-8")
RESULT = json.loads((ROOT / "results" / "bench_novelty.json").read_text(encoding="utf-8"))
VALUES = {row["name"]: row["value"] for row in RESULT["rows"]}
KINDS = {"surveillance": "held-out targets", "telephone": "held-out callers", "golf": "other holes"}
TABLE = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in PAGE.splitlines()
    if line.startswith(("| surveillance", "| telephone", "| golf"))
]


def test_the_examples_run(capsys):
    code = "".join(re.findall(r"```python\n(.*?)```", PAGE, flags=re.S))
    exec(compile(code, "novelty.md", "exec"), {"__name__": "page"})
    known, new, probability = capsys.readouterr().out.splitlines()
    assert float(probability) > 0.9
    assert known.startswith("False None")
    assert new.startswith("True")


@pytest.mark.parametrize("cells", TABLE, ids=[cells[0] for cells in TABLE])
def test_the_table_is_measured(cells):
    case, low, high, power, delay, *aucs = cells
    kind = KINDS[case.split()[0].strip(",")]

    def value(name: str) -> float:
        return VALUES[f"{case}: {name}"]

    assert (low, high) == tuple(f"{100 * value(f'false alarms at {rate}'):.2g} %" for rate in ("1%", "5%"))
    assert power == f"{100 * value(f'{kind}: power at 5%'):.0f} %"
    assert delay == f"{value(f'{kind}: delay at 5%'):.0f}"
    statistics = ("belief's entropy", "sum of −log evidence", "standardised surprise", "shortfall", "joined")
    shown = [value(f"{kind}: AUC of {name} at 15") for name in (*statistics, "odds of no known type")]
    if not case.startswith("surveillance") and " U," not in case:
        assert aucs.pop(3) == "–"
        shown.pop(3)
    assert aucs == [f"{auc:.2f}" for auc in shown]


def test_the_table_has_every_case():
    assert {cells[0] for cells in TABLE} == {name.split(": ")[0] for name in VALUES if "false alarms" in name}
