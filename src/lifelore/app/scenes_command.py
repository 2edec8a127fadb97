"""`lifelore scenes`: simulated scenes on a table, as files."""

from typing import Annotated

import typer

Option = typer.Option


def scenes(
    n: Annotated[int, Option("--n", help="Scenes.")],
    out: Annotated[str, Option(metavar="DIR", help="Folder that holds no scenes yet.")],
    seed: Annotated[int, Option(help="Same seed, same files.")] = 0,
    mix: Annotated[
        str | None,
        Option(metavar="on=…,adjacent=…,both=…,none=…", help="Shares of the pairs' relations; on any scale."),
    ] = None,
    camera: Annotated[str, Option(help="kinect or stereo.")] = "kinect",
    shapes: Annotated[str, Option(help="training, held-out (no kind in common) or all.")] = "training",
    arrangement: Annotated[
        str, Option(help="mixed, pair, apart, hole, no-hole, stack, ball-on-block, …")
    ] = "mixed",
    mesh: Annotated[
        list[str] | None, Option(metavar="FILE", help="A shape of yours, in metres; may be repeated.")
    ] = None,
    jobs: Annotated[int, Option(help="Processes; the files do not depend on them.")] = 1,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Let things fall on a table, settle them by physics, and photograph them with a depth camera (extra: sim).

    Writes a PCD a scene, and relations.csv, planes.csv and gaps.csv with what is true of all.
    """
    from lifelore.agent.perceive.scenes import make_scenes
    from lifelore.app.console import print_json, progress_bar
    from lifelore.app.perceive_command import to_stderr

    wanted = _mix(mix)
    with progress_bar("drawing") as progress:
        report = make_scenes(
            n, out, seed, mix=wanted, camera=camera, shapes=shapes, arrangement=arrangement,
            meshes=mesh or (), jobs=jobs, progress=progress,
        )  # fmt: skip
    if report["mix_missed"]:
        shares = ", ".join(f"{relation}={share:.2f}" for relation, share in report["mix"].items())
        to_stderr(f"the mix was missed: the pairs came to {shares}; draw more scenes, or ask for another mix")
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
