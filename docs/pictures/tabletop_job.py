"""A tabletop job done in the best way, and done carelessly, as the depth camera sees it.

``python -m docs.pictures.tabletop_job`` draws ``docs/pictures/tabletop_job.png``; it needs the
extra ``sim``.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from docs.pictures.cloud_sequence import draw_cloud_sequence
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.streams import stream
from lifelore.domains.tabletop.photograph import FIRST_OBJECT, photograph
from lifelore.domains.tabletop_job.best_return import OutcomeTree
from lifelore.domains.tabletop_job.job import HAND_OVER_GENTLY, PICK, PUSH_APART, VERBS, TabletopJob
from lifelore.domains.tabletop_job.job_types import job_type_named
from lifelore.domains.tabletop_job.tray import Tray, sample_tray
from lifelore.figures.style import save_figure

PATH = Path("docs/pictures/tabletop_job.png")
TRAY = 7
"""Of seed 0: a bar lies across the target and its neighbour."""
BAR = 3
TYPE = job_type_named("patient/firm")


def draw_tabletop_job():
    """The best sequence above, and below a push at the bar before the target is picked."""
    tray = sample_tray(0, TRAY)
    n, target = len(tray.shapes), tray.target
    best = OutcomeTree(tray, TYPE.gripper).best(TYPE.user).actions
    careless = [PUSH_APART * n + BAR, PICK * n + target, HAND_OVER_GENTLY * n + target]
    pictures = [*_follow(tray, best, "best possible"), *_follow(tray, careless, "careless")]
    clouds, captions = zip(*pictures, strict=True)
    return draw_cloud_sequence(clouds, captions, target + FIRST_OBJECT, columns=len(best) + 1)


def _follow(tray: Tray, actions: Sequence[int], title: str) -> list[tuple[LabelledCloud, str]]:
    """The clouds before and after each action, with captions."""
    job = TabletopJob(tray, TYPE)
    pictures = [(_picture(job, 0), title)]
    for taken, action in enumerate(actions, 1):
        verb, number = divmod(action, job.n_objects)
        observation, reward, _ = job.step(action)
        assert observation.last is not None
        spilled = f", {len(observation.last.spilled)} spilled" if observation.last.spilled else ""
        caption = f"{VERBS[verb]} {number + FIRST_OBJECT}\n{reward:+.1f} points{spilled}"
        pictures.append((_picture(job, taken), caption))
    return pictures


def _picture(job: TabletopJob, taken: int) -> LabelledCloud:
    """What the job's camera sees after `taken` actions, with labels and with the colours of the start."""
    first, physics = job.tray.cloud, job._physics
    outlines = [physics.outline(k) for k in physics.here]
    rng = stream(job.seed, "tabletop job", "camera", taken)
    photo = photograph(physics, outlines, job.tray.view, job._camera, rng, fewest=0)
    if taken == 0 or photo is None:
        return first
    colours = np.asarray(photo.cloud.colours, float)
    for label in np.intersect1d(photo.cloud.labels, first.labels):
        own = photo.cloud.labels == label
        paint = np.asarray(first.colours)[first.labels == label].mean(axis=0)
        colours[own] *= paint / np.maximum(colours[own].mean(axis=0), 1)
    return replace(photo.cloud, colours=np.clip(colours, 0, 255).astype(np.uint8))


if __name__ == "__main__":
    save_figure(draw_tabletop_job(), PATH)
