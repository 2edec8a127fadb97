"""Options that several verbs share."""

from typing import Annotated

import typer

Where = Annotated[
    str | None,
    typer.Option("--memory", metavar="FILE|URL", help="Memory, a file or postgresql:// URL; default: your own."),
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON document on stdout and nothing else.")]
MapFile = Annotated[
    str | None, typer.Option(metavar="YAML", help="ROS map of the building; default: a generated office.")
]
Building = Annotated[
    str | None, typer.Option(metavar="NAME", help="Name of the building; default: recognise it by its map.")
]
Cell = Annotated[float | None, typer.Option(help="Side of a grid cell in metres, as in `live` [0.5].")]
RobotRadius = Annotated[float | None, typer.Option(help="Radius of the robot in metres, as in `live` [0.2].")]
Robot = Annotated[str, typer.Option(help="Name of the robot in memory.")]
Units = Annotated[str, typer.Option(help="Unit of the coordinates: m, cm, mm or inch.")]
Labels = Annotated[str, typer.Option(help="Label field: plain ids, parts (20–29 are one object), or auto.")]
