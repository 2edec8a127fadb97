"""`lifelore advise`: advice for agents whose goals nobody knows."""

import json
import sys
from typing import Annotated

import typer

Option = typer.Option


def advise(
    world: Annotated[str, typer.Argument(metavar="MAP|MAZE", help="A ROS map's YAML, or NAME:SEED (advice:3).")],
    experts: Annotated[
        str, Option(metavar="FILE", help='JSON lines {"agent", "state", "action"} of who knows the way.')
    ],
    goals: Annotated[
        str | None, Option(metavar="FILE", help='JSON lines {"state"}; default: where experts ended.')
    ] = None,
    watch: Annotated[str, Option(metavar="FILE", help="Steps of the agents to advise; - is stdin.")] = "-",
    method: Annotated[
        str, Option(help="better (a goal at a time), or thesis (one prior over all goals).")
    ] = "better",
    kappa: Annotated[float, Option(help="Advise where the gain is at least κ nats.")] = 0.5,
    window: Annotated[int, Option(help="Steps of an agent that are looked back over.")] = 300,
    share: Annotated[
        float | None, Option(help="Most advised steps of an agent, as a share [0.4; thesis: 1].")
    ] = None,
    cell: Annotated[float | None, Option(help="Side of a grid cell, metres [map: 0.5].")] = None,
    robot_radius: Annotated[float | None, Option(help="Metres [map: 0.2].")] = None,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Watch agents step by step and tell the lost ones the way; one JSON line out for each line in."""
    from contextlib import nullcontext

    from lifelore.agent.advise.advise import AdviceDesk, AdviseSettings
    from lifelore.agent.advise.step_lines import read_steps
    from lifelore.app.console import print_json

    desk = AdviceDesk(AdviseSettings(world, experts, goals, method, kappa, window, share, cell, robot_radius))
    name = "stdin" if watch == "-" else watch
    with nullcontext(sys.stdin) if watch == "-" else _opened(watch) as lines:
        answers = (desk.answer(step) for step in read_steps(lines, desk.world, name))
        if as_json:
            print_json({"goals": desk.goals, "experts": desk.n_experts, "advice": list(answers)})
            return
        for answer in answers:
            # Whoever asks waits for this line before the agent's next step.
            print(json.dumps(answer, allow_nan=False), flush=True)


def _opened(path: str):
    from lifelore.core.errors import NotFoundError

    try:
        return open(path, encoding="utf-8")
    except OSError as error:
        raise NotFoundError(f"watch must be a file that can be read, got '{path}': {error.strerror}") from None
