"""`lifelore learn-relations`: teach words for relations by labelled scenes."""

from typing import Annotated

import typer

Option = typer.Option


def learn_relations(
    folder: Annotated[str, typer.Argument(metavar="DIR", help="A labelled cloud a scene: NAME.pcd, ply, npz.")],
    truth: Annotated[
        str, Option(metavar="CSV", help="Columns scene, a, b, relation, confidence (3 certain … 1 doubtful).")
    ],
    memory: Annotated[str | None, Option(metavar="FILE|URL", help="SQLite file or postgresql:// URL.")] = None,
    name: Annotated[str, Option(help="Memory keeps the model under this name.")] = "default",
    out: Annotated[
        str | None, Option(metavar="FILE", help="Write the model to NAME.npz; without --memory only there.")
    ] = None,
    method: Annotated[str, Option(help="trees, or displacement (the thesis's).")] = "trees",
    adjacent_gap: Annotated[
        float, Option(help="Metres up to which things side by side are adjacent, not none.")
    ] = 0.0225,
    several: Annotated[bool, Option("--several", help="Several relations may hold of one pair.")] = False,
    labels: Annotated[
        str, Option(help="The label field: plain ids, parts (20–29 are one object), or auto.")
    ] = "auto",
    units: Annotated[str, Option(help="Of the coordinates: m or mm.")] = "m",
    up: Annotated[
        str | None,
        Option(metavar="table|z|X,Y,Z", help="Where up is in every cloud [as planes.csv has it, else table]."),
    ] = None,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Learn what words for relations mean from scenes in which they were said."""
    from lifelore.agent.perceive.learn_relations import LearnRelationsSettings
    from lifelore.agent.perceive.learn_relations import learn_relations as learn
    from lifelore.app.console import print_json, progress_bar
    from lifelore.app.perceive_command import direction, to_stderr

    upwards = None if up is None else direction(up)
    lesson = LearnRelationsSettings(folder, truth, name, method, adjacent_gap, several, labels, units, upwards)
    with progress_bar("learning") as progress:
        report = learn(lesson, memory, out, progress, to_stderr)
    if as_json:
        print_json(report)
        return
    said = ", ".join(f"{count} {relation}" for relation, count in report["pairs"].items())
    places = " and ".join(str(place) for place in (report["memory"], report["out"]) if place)
    far = sum(report["not_near"].values())
    not_near = f"; {far} labels are of things too far apart" if far else ""
    print(f"learnt from {report['scenes']} scenes ({said}{not_near}); model '{report['name']}' kept in {places}")
