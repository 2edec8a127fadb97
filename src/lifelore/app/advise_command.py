"""`lifelore advise`: advise agents whose goals are unknown."""

from typing import Annotated

import typer

from lifelore.app.options import AsJson, Cell, RobotRadius

Option = typer.Option


def advise(
    world: Annotated[str, typer.Argument(metavar="MAP|MAZE", help="A ROS map's YAML, or NAME:SEED (advice:3).")],
    experts: Annotated[
        str,
        Option(
            metavar="FILE",
            help='JSON lines {"agent", "state", "action"} of agents that know the paths; '
            'for --method classes also "class".',
        ),
    ],
    goals: Annotated[
        str | None,
        Option(metavar="FILE", help='JSON lines {"state"} of the goals; default: the ends of the experts.'),
    ] = None,
    watch: Annotated[
        str,
        Option(
            metavar="FILE",
            help="JSON lines with the steps of the agents to advise; - is stdin. "
            'With --method classes an agent that shows its class, as by a uniform, has a "class", too.',
        ),
    ] = "-",
    method: Annotated[
        str,
        Option(
            help="better (one goal at a time), thesis (one prior over all goals, Eq. 3.16), or classes "
            "(one goal, by class)."
        ),
    ] = "better",
    shown: Annotated[
        str | None,
        Option(metavar="CLASS", help="With --method classes: the class of all agents whose lines show none."),
    ] = None,
    kappa: Annotated[float, Option(help="Least gain κ of advice, in nats.")] = 0.5,
    window: Annotated[int, Option(help="Number of last steps of an agent that count as evidence.")] = 300,
    share: Annotated[
        float | None, Option(help="Largest share of an agent's steps that are advised [0.4; thesis: 1].")
    ] = None,
    cell: Cell = None,
    robot_radius: RobotRadius = None,
    as_json: AsJson = False,
) -> None:
    """Advise agents that seem lost, step by step.

    Each JSON line of input, a step of an agent, gives one JSON line of output. Use it when experts have walked in
    the same world and you do not know the goals of the agents.
    """
    from lifelore.agent.advise.advise import AdviceSession, AdviseSettings
    from lifelore.agent.advise.step_lines import read_steps
    from lifelore.app.console import print_json, print_json_line
    from lifelore.core.json_lines import lines_of

    session = AdviceSession(
        AdviseSettings(world, experts, goals, method, kappa, window, share, cell, robot_radius, shown=shown)
    )
    steps = read_steps(lines_of(watch), session.world, "stdin" if watch == "-" else watch, session.classes)
    answers = (session.answer(step) for step in steps)
    if as_json:
        print_json({"goals": session.goals, "experts": session.n_experts, "advice": list(answers)})
        return
    for answer in answers:
        print_json_line(answer)  # The caller waits for this line before the agent's next step.
