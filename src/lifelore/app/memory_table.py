"""What a memory holds, as tables."""

from rich.console import Console
from rich.table import Table


def print_memory(overview: dict) -> None:
    """Robots with their tasks, then each kind and key of lore with its size."""
    console = Console()
    console.print(f"memory {overview['location']} (schema {overview['schema']})", highlight=False)
    robots = Table("robot", "tasks", "first", "last", title="who lived")
    for entry in overview["robots"]:
        robots.add_row(entry["robot"], str(entry["tasks"]), entry["first"][:19], entry["last"][:19])
    lore = Table("kind", "key", "version", "merges by", "slots", title="what is known")
    for entry in overview["lore"]:
        lore.add_row(
            entry["kind"], entry["key"][:12], str(entry["version"]), entry["merge"], f"{entry['slots']:,}"
        )
    console.print(robots)
    console.print(lore)
    if overview["forgotten"]:
        console.print(f"{overview['forgotten']} contributions were forgotten and will not come back")
