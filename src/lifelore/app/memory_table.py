"""Prints the content of a memory as tables."""

import re

from rich.console import Console
from rich.table import Table

from lifelore.memory.overview import grouped_lore


def print_memory(overview: dict) -> None:
    """Print robots with their tasks, then records with their sizes; large groups of records are one line."""
    console = Console()
    console.print(f"memory {overview['location']} (schema {overview['schema']})", highlight=False)
    robots = Table("robot", "tasks", "first", "last", title="robots")
    for entry in overview["robots"]:
        robots.add_row(entry["robot"], f"{entry['tasks']:,}", entry["first"][:19], entry["last"][:19])
    buildings = Table("building", "key", "maps", "grids", title="buildings")
    for entry in overview["buildings"]:
        buildings.add_row(entry["name"], entry["key"][:12], str(entry["maps"]), str(entry["grids"]))
    lore = Table("kind", "key", "version", "merges by", "slots", title="records")
    for entry in grouped_lore(overview["lore"]):
        # Hashes are shortened; what follows them, such as the name of a place, tells records apart.
        key = re.sub(r"\b([0-9a-f]{12})[0-9a-f]{20}\b", r"\1", entry["key"])
        key = key if entry["of"] == 1 else f"{key}… ({entry['of']:,})"
        lore.add_row(entry["kind"], key, str(entry["version"]), entry["merge"], f"{entry['slots']:,}")
    console.print(robots)
    if overview["buildings"]:
        console.print(buildings)
    console.print(lore)
    if overview["forgotten"]:
        console.print(f"{overview['forgotten']} contributions were forgotten and cannot be restored")
    if overview["forgotten_records"]:
        console.print(f"{overview['forgotten_records']} records were forgotten and cannot be restored")
