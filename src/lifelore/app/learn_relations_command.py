"""`lifelore learn-relations`: train a relation model on labelled scenes."""

from collections.abc import Iterable
from typing import Annotated

import typer

from lifelore.app.options import AsJson, Labels, Units

Option = typer.Option


def learn_relations(
    folder: Annotated[
        str | None,
        typer.Argument(
            metavar="DIR",
            help="Folder with a labelled cloud for each scene: NAME.pcd, ply, npz. Without it, the scenes in"
            " memory are all.",
        ),
    ] = None,
    truth: Annotated[
        str | None,
        Option(metavar="CSV", help="Labels: columns scene, a, b, relation, confidence (3 certain … 1 doubtful)."),
    ] = None,
    memory: Annotated[
        str | None, Option(metavar="FILE|URL", help="Memory: SQLite file or postgresql:// URL.")
    ] = None,
    name: Annotated[
        str, Option(help="Name of the model in memory; scenes that memory has for this name count too.")
    ] = "default",
    anew: Annotated[bool, Option("--anew", help="Leave out the scenes that memory has for this name.")] = False,
    out: Annotated[
        str | None,
        Option(
            metavar="FILE", help="File NAME.npz for the model; without --memory the model is written only there."
        ),
    ] = None,
    method: Annotated[str, Option(help="Method: trees, or displacement (the thesis's).")] = "trees",
    adjacent_gap: Annotated[float, Option(help="Largest gap in metres between adjacent objects.")] = 0.0225,
    several: Annotated[bool, Option("--several", help="A pair may have several relations.")] = False,
    symmetric: Annotated[
        list[str] | None,
        Option(
            metavar="WORD",
            help="A relation that holds in both directions; give one for each. Others then never do."
            " Default: inferred from the labels.",
        ),
    ] = None,
    labels: Labels = "auto",
    units: Units = "m",
    up: Annotated[
        str | None,
        Option(
            metavar="table|z|X,Y,Z",
            help="Upward direction in every cloud [from planes.csv, else the table's normal].",
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Train a model of spatial relations on labelled scenes.

    Use it if the shipped model does not know your relations, objects or camera; then give the model to perceive.
    The scenes stay in memory, so a later lesson of the same name adds to them, also one of another robot.
    """
    from lifelore.agent.perceive.learn_relations import LearnRelationsSettings
    from lifelore.agent.perceive.learn_relations import learn_relations as learn
    from lifelore.agent.perceive.perceive import read_up
    from lifelore.app.console import print_json, progress_bar, to_stderr

    upwards = None if up is None else read_up(up)
    declared = None if symmetric is None else tuple(symmetric)
    settings = LearnRelationsSettings(
        folder, truth, name, method, adjacent_gap, several, declared, labels, units, upwards, anew
    )
    with progress_bar("learning") as progress:
        report = learn(settings, memory, out, progress, to_stderr)
    if as_json:
        print_json(report)
        return
    pairs = ", ".join(f"{count} {relation}" for relation, count in report["pairs"].items())
    locations = " and ".join(str(place) for place in (report["memory"], report["out"]) if place)
    far = sum(report["not_near"].values())
    not_near = f"; {far} labels are of objects too far apart" if far else ""
    remembered = f", {report['remembered']} of them remembered" if report["remembered"] else ""
    print(f"learnt from {report['scenes']} scenes{remembered} ({pairs}{not_near})")
    if words := sorted(set(report["relations"]) - {"on", "adjacent", "both", "none"}):
        both_ways = [word for word in words if word in report["symmetric"]]
        print(f"words with a direction: {_listed(set(words) - set(both_ways))}; symmetric: {_listed(both_ways)}")
        print("perceive takes on, adjacent, both and none from the shipped model and adds these words")
    print(f"model '{report['name']}' stored in {locations}")


def _listed(words: Iterable[str]) -> str:
    return ", ".join(sorted(words)) or "none"
