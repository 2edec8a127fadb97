"""`lifelore teach`: record demonstrations of a person who walks to goals by keys."""

import io
import sys
from typing import Annotated

import typer

Option = typer.Option


def teach(
    out: Annotated[
        str, Option(metavar="FILE", help="File that the demonstrations are appended to, one JSON line a step.")
    ],
    name: Annotated[str, Option(help="Name of the person who teaches.")] = "person",
    domain: Annotated[
        str, Option(help="World: building, or the thesis's worlds lattice, noise and advice.")
    ] = "noise",
    map: Annotated[
        str | None, Option(metavar="YAML", help="building: a ROS map; default: a generated office.")
    ] = None,
    size: Annotated[int | None, Option(help="lattice and noise: cells per side.")] = None,
    tasks: Annotated[int, Option(help="Number of goals to walk to.")] = 3,
    seed: Annotated[int, Option(help="Draws the world, the goals and the starts.")] = 0,
    prior: Annotated[
        str | None,
        Option(metavar="FILE", help="File (npz) for the percept prior of the lesson, weighted by competence."),
    ] = None,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout; pictures go to stderr.")] = False,
) -> None:
    """Walk to goals by keyboard, to teach the agent a prior.

    Use w a s d or the arrow keys, and end each line with Enter. Use it to record demonstrations, from which the
    agent learns a prior. The keys may also come from a pipe.
    """
    from lifelore.agent.teach import teach as run
    from lifelore.app.console import print_json
    from lifelore.domains.worlds import WorldSettings

    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(errors="replace")  # undecodable bytes become unknown keys
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
    print(f"{report['shown']} tasks shown in {report['steps']} steps, appended to {report['out']}{skill}")
