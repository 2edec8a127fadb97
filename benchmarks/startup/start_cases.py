"""What the verbs of `bench start` are given: clouds to perceive, and a study to choose from."""

import csv
from pathlib import Path

from lifelore.agent.reuse.fit import FitSettings, fit
from lifelore.agent.reuse.one_user import choose
from lifelore.agent.reuse.study import open_study
from lifelore.core.streams import stream
from lifelore.domains.tabletop.scene_folder import save_cloud
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.memory import open_memory
from reproduction.chapter2.scenes.real_scenes import real_scenes_folder

REAL = ("learn22", "test47", "test49", "test45")
"""Real scenes of three to seven objects; the first is the one cloud, the others are the further ones."""
SIMULATED = (3, 4, 5, 6)
"""Objects of the simulated scenes that stand in for them."""
SEED = 7004
USERS, TYPES, POLICIES, OUTCOMES = 60, 4, 6, 8
"""Of the log that is fitted; each user has `OUTCOMES` lines."""


def clouds_to_perceive(folder: Path) -> tuple[list[Path], str]:
    """Four real Kinect clouds where they are, else simulated ones written to `folder`; and what to call one."""
    real = real_scenes_folder()
    if real is not None and all((real / f"{name}.pcd").is_file() for name in REAL):
        return [real / f"{name}.pcd" for name in REAL], "a Kinect's PCD"
    sources = [folder / f"scene{number}.pcd" for number in range(len(SIMULATED))]
    for number, (source, things) in enumerate(zip(sources, SIMULATED, strict=True)):
        save_cloud(source, sample_scene(SEED, number, TabletopSettings(n_objects=(things, things))))
    return sources, "a simulated camera's PCD"


def fitted_study(folder: Path) -> Path:
    """A memory in `folder` with a study fitted from a log."""
    place = folder / "study.db"
    write_log(folder / "log.csv")
    with open_memory(place) as memory:
        fit([folder / "log.csv"], memory, FitSettings(rule="information-directed"))
    return place


def open_decisions(place: Path, n: int) -> list[str]:
    """Identifiers of `n` decisions for different users in the memory of `fitted_study`, without outcomes."""
    with open_memory(place) as memory:
        study = open_study(memory)
        return [choose(memory, study, f"new user {user}")["decision"] for user in range(n)]


def write_log(path: Path) -> None:
    """A log of normal outcomes whose users' types it names."""
    generator = stream(0, "bench reuse start")
    means = generator.normal(scale=10, size=(TYPES, POLICIES))
    with path.open("w", newline="") as file:
        lines = csv.writer(file)
        lines.writerow(["user", "policy", "outcome", "type"])
        for user in range(USERS):
            type_ = user % TYPES
            for policy in generator.integers(POLICIES, size=OUTCOMES).tolist():
                outcome = float(generator.normal(means[type_, policy], 3))
                lines.writerow([f"user {user}", f"policy {policy}", outcome, f"type {type_}"])
