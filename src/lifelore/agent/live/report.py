"""What `lifelore live --out` writes: the report, pictures of the life, and exports for other programs."""

import json
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from lifelore.agent.live.baselines import ROSTER
from lifelore.agent.live.exports import write_paths, write_prior_map
from lifelore.agent.live.greedy_paths import Ways, ways_of
from lifelore.agent.live.life import KEPT, Life
from lifelore.agent.live.summary import third
from lifelore.agent.live.task_result import THRESHOLD, TaskResult
from lifelore.core.errors import InputError, StoreError
from lifelore.figures.life_curves import draw_life
from lifelore.figures.prior_map import draw_prior_map
from lifelore.figures.style import save_figure
from lifelore.figures.task_curves import draw_task_curves
from lifelore.figures.world_map import draw_world_map

PRIOR_FILES = ("prior.png", "prior.pgm", "prior.yaml")
FILES = ("summary.json", "life.png", "learning_curves.png", "world.png", "paths.csv", *PRIOR_FILES)
"""All that a portfolio may hold; the prior's files only where the agent has one."""


def check_folder(path: str) -> None:
    """Make the folder and try to write into it, before a long run rather than after it.

    Raises
    ------
    InputError
        `path` is empty, a file, or lies below one; or a folder stands where a file is to be written.
    StoreError
        The disk refuses: read-only, full, not permitted.
    """
    folder = _folder(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as probe:
            probe.write(b"\0")
    except (FileExistsError, NotADirectoryError):
        raise InputError(
            f"out must name a folder, got {path}, which is or lies below a file; name another"
        ) from None
    except OSError as error:
        raise StoreError(f"cannot write into {path}: {error.strerror}; choose another folder with --out") from None
    for name in FILES:
        if (folder / name).is_dir():
            raise InputError(f"out must have no folder named {name}, {path} has one; choose another folder")


def write_portfolio(life: Life, out: str) -> list[str]:
    """Write the portfolio of a life into the folder `out`, made if need be.

    Every file appears whole or not at all. Files of an earlier portfolio are replaced; those that this life
    has none of are removed. A life without a finished task leaves only its report.

    Parameters
    ----------
    life : Life
    out : str

    Returns
    -------
    list of str
        Paths of the files written, in the order of `FILES`.

    Raises
    ------
    InputError, StoreError
        The folder cannot be written, see `check_folder`.
    """
    check_folder(out)
    folder = _folder(out)
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=".part-") as part:
            _write_all(life, Path(part))
            written = [name for name in FILES if (Path(part) / name).exists()]
            for name in FILES:
                if name in written:
                    os.replace(Path(part) / name, folder / name)
                else:
                    (folder / name).unlink(missing_ok=True)
    except StoreError:
        raise
    except OSError as error:
        raise StoreError(f"cannot write into {out}: {error.strerror}; choose another folder with --out") from None
    return [str(folder / name) for name in written]


def _folder(path: str) -> Path:
    if not path.strip() or "\0" in path:
        raise InputError(f"out must name a folder, got {path!r}")
    return Path(path)


def _write_all(life: Life, folder: Path) -> None:
    text = json.dumps(life.report, indent=2, allow_nan=False)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")
    if not life.results:
        return
    ways = _ways(life)
    save_figure(_life_figure(life), folder / "life.png")
    save_figure(_task_figure(life), folder / "learning_curves.png")
    save_figure(_world_figure(life, ways), folder / "world.png")
    write_paths(folder / "paths.csv", life.world, ways)
    if _has_prior(life):
        _write_prior(life, folder)


def _agents(life: Life) -> list[str]:
    """Names of those who lived, the one whose lore is kept first."""
    return list(life.results[0])


def _place(life: Life) -> str:
    report = life.report
    if report["map"]:
        return Path(report["map"]).stem
    return f"office {report['seed']}" if report["domain"] == "building" else report["domain"]


def _metres(life: Life) -> float | None:
    """Side of a cell where cells have a size in the world."""
    return life.world.frame.cell if life.report["domain"] == "building" else None


def _count(n: int, noun: str) -> str:
    return f"{n:,} {noun}" if n == 1 else f"{n:,} {noun}s"


# ---- pictures --------------------------------------------------------------------------------------


def _life_figure(life: Life):
    tasks = life.report["tasks"]
    agents = {
        name: {
            measure: [task["agents"][name][measure] for task in tasks]
            for measure in ("steps_to_80", "collisions", "reached")
        }
        for name in _agents(life)
    }
    return draw_life([task["index"] for task in tasks], agents, title=_headline(life))


def _headline(life: Life) -> str:
    """The life in one line, with its ratios to scratch where there are any."""
    title = f"{_count(len(life.results), 'task')} in {_place(life)}"
    name = _agents(life)[0]
    beside = life.report["summary"].get(f"{name}_vs_scratch")
    if not beside:
        return title
    ratios = {"steps": beside["steps_to_80_ratio"]["value"], "collisions": beside["collisions_ratio"]["value"]}
    words = [f"{what} × {_factor(value)}" for what, value in ratios.items() if value is not None]
    part = "last third" if len(life.results) > 2 else "last task"
    return f"{title} — {name} against scratch, {part}: {', '.join(words)}" if words else title


def _factor(value: float) -> str:
    """Two decimals, unless those would make nothing of something."""
    return f"{value:.2f}" if value >= 0.005 or value == 0 else f"{value:.1g}"


def _task_figure(life: Life):
    parts = {"Last third of the life": third(life.results, "last")}
    if len(life.results) > 1:
        parts = {"First third of the life": third(life.results, "first"), **parts}
    else:
        parts = {"The one task": life.results}
    panels = {f"{words} ({_count(len(part), 'task')})": _traces(life, part) for words, part in parts.items()}
    title = f"Learning within a task, in {_place(life)}: mean, and band of the middle half of the tasks"
    return draw_task_curves(panels, threshold=THRESHOLD, title=title)


def _traces(life: Life, results: list[dict[str, TaskResult]]) -> dict:
    return {name: [r[name].trace for r in results] for name in _agents(life)}


def _ways(life: Life) -> list[Ways]:
    """Paths of the first agent in the last tasks."""
    world, name = life.world, _agents(life)[0]
    start = life.report["settings"]["start"]
    fixed = None if start is None else int(world.state_of[tuple(start)])
    last = zip(life.report["tasks"][-KEPT:], life.results[-KEPT:], strict=True)
    return [
        ways_of(world, result[name].policy, task["index"], int(world.state_of[tuple(task["goal"])]), fixed)
        for task, result in last
    ]


def _world_figure(life: Life, ways: Sequence[Ways]):
    world = life.world
    shown = [
        {
            "label": f"task {way.task}, reached from {_percent(way.arriving)} of starts",
            "goal": world.cells[way.goal],
            "paths": [world.cells[path] for path in way.paths],
        }
        for way in ways
    ]
    earlier = [task["goal"] for task in life.report["tasks"][: -len(ways)]]
    title = f"{_place(life)}: ways that {_agents(life)[0]} takes in its last {_count(len(ways), 'task')}"
    return draw_world_map(
        world.shape, world.cells, world.neighbour, shown, goals=earlier, cell=_metres(life), title=title
    )


def _percent(share: float) -> str:
    """Rounded down, so that only all are 100 %."""
    return f"{int(100 * share)} %"


# ---- the prior -------------------------------------------------------------------------------------


def _has_prior(life: Life) -> bool:
    lore, wanted = life.lore, life.report["settings"]["prior"] != "none"
    uses = ROSTER[_agents(life)[0]].uses_prior
    return wanted and uses and not lore.prior.unseen(lore.scope.contexts).all()


def _write_prior(life: Life, folder: Path) -> None:
    lore, world = life.lore, life.world
    probs, counted = lore.prior.probs(lore.scope.contexts), ~lore.prior.unseen(lore.scope.contexts)
    given = "what is around a cell" if lore.scope.kind == "observation" else "the cell"
    title = f"{_place(life)}: the action prior given {given}"
    figure = draw_prior_map(
        world.shape, world.cells, world.neighbour, probs, counted, cell=_metres(life), title=title
    )
    save_figure(figure, folder / "prior.png")
    write_prior_map(folder / "prior.yaml", world, probs, counted)
