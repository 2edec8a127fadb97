"""`lifelore doctor`: what is installed, what is missing, what is fast."""

from typing import Annotated

import typer


def doctor(
    memory: Annotated[str | None, typer.Option(metavar="FILE|URL", help="Which memory to look at.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Say what is installed, what is missing and what brings it, whether memory opens, how fast this is."""
    from lifelore.agent.doctor import examine
    from lifelore.app.console import print_json

    report = examine(memory)
    print_json(report) if as_json else _print(report)


def _print(report: dict) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console()
    console.print(
        f"lifelore {report['lifelore']}, Python {report['python']}, {report['cores']} cores, {report['system']}",
        highlight=False,
    )
    packages = Table("package", "version", "for")
    for entry in report["packages"]:
        packages.add_row(entry["name"], entry["version"] or "missing", entry["for"])
    console.print(packages)
    for entry in report["checks"]:
        console.print(f"{'ok  ' if entry['ok'] else 'BAD '} {entry['what']}: {entry['finding']}", highlight=False)
