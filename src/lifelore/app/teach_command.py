"""`lifelore teach`: show a robot the way, key by key."""

import io
import sys
from typing import Annotated

import typer

Option = typer.Option


def teach(
    out: Annotated[str, Option(metavar="FILE", help="Demonstrations are added here, one JSON line a step.")],
    name: Annotated[str, Option(help="Who is teaching.")] = "person",
    domain: Annotated[str, Option(help="lattice, noise or building.")] = "noise",
    map: Annotated[str | None, Option(metavar="YAML", help="A ROS map, for building; else an office.")] = None,
    size: Annotated[int | None, Option(help="Cells a side, for lattice and noise.")] = None,
    tasks: Annotated[int, Option(help="Goals to walk to.")] = 3,
    seed: Annotated[int, Option(help="Draws the world, the goals and the starts.")] = 0,
    prior: Annotated[
        str | None, Option(metavar="FILE", help="Also write the lesson's percept prior (npz), weighted by skill.")
    ] = None,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout; pictures go to stderr.")] = False,
) -> None:
    """Walk to a few goals with w a s d or the arrow keys, each line ended by Enter; also from a pipe."""
    from lifelore.agent.teach import teach as run
    from lifelore.app.console import print_json
    from lifelore.domains.worlds import WorldSettings

    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(errors="replace")  # odd bytes are unknown keys, no reason to stop
    settings = WorldSettings(domain, map=map, size=size, seed=seed)
    pictures = sys.stderr if as_json else sys.stdout
    report = run(
        settings, sys.stdin, lambda text: print(text, file=pictures, flush=True),
        out=out, person=name, tasks=tasks, seed=seed, prior=prior,
    )  # fmt: skip
    if as_json:
        print_json(report)
        return
    skill = "" if report["competence"] is None else f"; estimated competence {report['competence']:.2f}"
    print(f"{report['shown']} tasks shown in {report['steps']} steps, added to {report['out']}{skill}")
