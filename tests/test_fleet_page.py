"""docs/fleet.md tells the limits that the code has."""

from pathlib import Path

from lifelore.memory import leases, sqlite_file

PAGE = (Path(__file__).parents[1] / "docs" / "fleet.md").read_text(encoding="utf-8")


def test_its_limits_are_those_of_the_memory():
    assert leases.LEASE_SECONDS == 3600
    assert "or after an hour" in PAGE
    assert f"up to {sqlite_file.CHECKED_BYTES // 2**20} MiB" in PAGE
