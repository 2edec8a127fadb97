"""The ledger is whole."""

from collections import Counter

from reproduction.engine.ledger import entries


def test_every_claim_stands_once():
    ids = [entry.id for entry in entries()]
    assert len(set(ids)) == len(ids)
    assert Counter(i.split(".")[0] for i in ids) == {"C2": 13, "C3": 19, "C4": 17, "C5": 8}


def test_entries_read_both_kinds_of_rows():
    found = {entry.id: entry for entry in entries()}
    assert found["C3.2"].where == "Fig 3.3"
    assert found["C3.2"].reports.startswith("23×23 lattice, prior from 10 tasks")
    assert found["C5.3"].where == ""
    assert all(entry.reports and "\n" not in entry.reports for entry in entries())
