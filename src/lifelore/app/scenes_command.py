"""`lifelore scenes`: simulate scenes of objects on a table and write their point clouds."""

from typing import Annotated

import typer

from lifelore.app.options import AsJson

Option = typer.Option


def scenes(
    n: Annotated[int, Option("--n", help="Number of scenes.")],
    out: Annotated[str, Option(metavar="DIR", help="Folder without scenes; it is made if it is missing.")],
    seed: Annotated[int, Option(help="Draws the scenes; the same seed gives the same files.")] = 0,
    mix: Annotated[
        str | None,
        Option(
            metavar="on=…,adjacent=…,both=…,none=…",
            help="Shares of the relations in scenes of arrangement pair, in any unit.",
        ),
    ] = None,
    camera: Annotated[str, Option(help="Depth camera: kinect or stereo.")] = "kinect",
    shapes: Annotated[str, Option(help="Shapes: training, held-out (other kinds of shapes) or all.")] = "training",
    arrangement: Annotated[
        str, Option(help="Arrangement: mixed, varied, pile, ramp, books, cartons or pair.")
    ] = "mixed",
    jobs: Annotated[int, Option(help="Processes; the files do not depend on their number.")] = 1,
    as_json: AsJson = False,
) -> None:
    """Simulate scenes of objects on a table (extra: sim).

    The objects fall on the table, and a simulated depth camera records them. Use it to make labelled scenes for
    learn-relations or for tests. It writes a PCD file for each scene, and the true relations, planes and gaps of
    all scenes as relations.csv, planes.csv and gaps.csv.
    """
    from lifelore.agent.perceive.scenes import make_scenes
    from lifelore.app.console import print_json, progress_bar

    shares = _mix(mix)
    with progress_bar("drawing") as progress:
        report = make_scenes(
            n, out, seed, mix=shares, camera=camera, shapes=shapes, arrangement=arrangement, jobs=jobs,
            progress=progress,
        )  # fmt: skip
    if as_json:
        print_json(report)
        return
    counts = ", ".join(f"{count} {relation}" for relation, count in report["pairs"].items())
    print(f"{report['scenes']} scenes in {report['out']} ({report['seconds']:.1f} s); pairs: {counts}")


def _mix(text: str | None) -> dict[str, float] | None:
    if text is None:
        return None
    from lifelore.core.errors import InputError

    try:
        return {name.strip(): float(share) for name, share in (part.split("=") for part in text.split(","))}
    except ValueError:
        raise InputError(f"mix must be RELATION=SHARE,…, such as on=70,adjacent=32, got '{text}'") from None
