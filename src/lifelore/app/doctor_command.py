"""`lifelore doctor`: examine the installation, or compile the kernels before their first use."""

from typing import Annotated

import typer

from lifelore.app.options import AsJson, Where


def doctor(
    memory: Where = None,
    warm: Annotated[
        bool,
        typer.Option(
            "--warm", help="Compile the kernels of live, perceive and reuse now instead of at their first use."
        ),
    ] = False,
    as_json: AsJson = False,
) -> int:
    """Examine the installation and a memory.

    It lists installed and missing packages, checks every byte of the memory, measures the speed of the kernels,
    and names the repair of what is bad. Use it after installing, or when a verb fails or is slow. The exit status
    is 1 if a check fails.
    """
    from lifelore.app.console import print_json
    from lifelore.core.errors import InputError

    if warm:
        if memory is not None:
            raise InputError("memory is not examined while kernels are compiled: leave --memory or --warm out")
        _compile(as_json)
        return 0
    from lifelore.agent.doctor import examine

    report = examine(memory)
    print_json(report) if as_json else _print(report)
    return 0 if all(entry["ok"] for entry in report["checks"]) else 1


def _compile(as_json: bool) -> None:
    from lifelore.agent.compile_kernels import compile_kernels
    from lifelore.app.console import print_json, progress_bar

    with progress_bar("compiling kernels") as progress:
        done = compile_kernels(progress)
    if as_json:
        print_json(done)
    else:
        print(f"{done['compiled']} kernels compiled in {done['folder']}")


def _print(report: dict) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)
    console.print(
        f"lifelore {report['lifelore']}, Python {report['python']}, {report['cores']} cores, {report['system']}"
    )
    always = [f"{one['name']} {one['version'] or 'missing'}" for one in report["packages"] if not one["extra"]]
    console.print(", ".join(always))
    optional = [entry for entry in report["packages"] if entry["extra"]]
    extras = Table("extra", "here", "needed for")
    for entry in optional:
        extras.add_row(entry["extra"], entry["version"] or "–", entry["for"])
    console.print(extras)
    if missing := sorted(entry["extra"] for entry in optional if not entry["version"]):
        console.print(f"For what is missing: pip install 'lifelore[{','.join(missing)}]'", markup=False)
    for entry in report["checks"]:
        console.print(f"{'ok  ' if entry['ok'] else 'BAD '} {entry['what']}: {entry['finding']}")
        if entry["advice"]:
            console.print(f"     To repair it: {entry['advice']}")
