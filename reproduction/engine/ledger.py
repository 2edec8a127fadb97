"""The ledger: every claim of the thesis, whether its experiment is built or not; read from `ledger.md`."""

import re
from functools import cache
from pathlib import Path
from typing import NamedTuple

PATH = Path(__file__).with_name("ledger.md")
_ROW = re.compile(r"^\| (C\d+\.\d+) \| (.+) \|$")


class Entry(NamedTuple):
    """A claim's id, where the thesis makes it ("" for ideas it only proposes), and what it reports."""

    id: str
    where: str
    reports: str


@cache
def entries() -> tuple[Entry, ...]:
    """All claims, in the thesis's order."""
    found = []
    for line in PATH.read_text(encoding="utf-8").splitlines():
        row = _ROW.match(line)
        if row:
            where, _, reports = row[2].rpartition(" | ")
            found.append(Entry(row[1], where, reports))
    return tuple(found)
