"""The settings of a life as JSON data."""

from dataclasses import asdict
from pathlib import Path

from lifelore.agent.live.life_settings import LifeSettings
from lifelore.domains.grids.grid_world import GridWorld


def settings_document(settings: LifeSettings, world: GridWorld, location: str) -> dict:
    """All settings in one flat dictionary, with the defaults of the world and the learner filled in."""
    prior = settings.prior
    document = {
        "domain": settings.world.domain,
        "map": path_text(settings.world.map),
        "tasks": settings.n_tasks,
        "cell": settings.world.cell,
        "robot_radius": settings.world.robot_radius,
        "destinations": settings.destinations,
        "learner": settings.learner,
        "prior": prior.condition,
        "sensor": settings.sensor.kind,
        "range": settings.sensor.reach,
        "agent": settings.agent,
        "robot": settings.memory.robot,
        "start": settings.start,
        "memory": location,
        **asdict(settings.learning),
        "episodes": settings.episode_cap(world.n_states),
        "max_steps": settings.step_cap,
        "seed": settings.seed,
        "jobs": settings.jobs,
        "density": settings.world.density,
        "discount": world.discount,
        "goal_reward": world.goal_reward,
        "wall_reward": world.wall_reward,
        "alpha0": prior.alpha0,
        "weight": prior.weight,
        "form": prior.form,
        "ties": prior.ties,
    }
    optional = {
        "goal": settings.goal,
        "goals": len(settings.goals) or None,
        "again": settings.again or None,
        "watch": settings.watch or None,
        "busy": settings.in_busy_building if settings.driven else None,
        "move_names": settings.move_names or None,
        "refresh": settings.memory.refresh or None,
        "compare": settings.compare,
        "building": settings.memory.building,
        "size": settings.world.size,
        "loops": settings.world.loops,
    }
    return document | {name: value for name, value in optional.items() if value is not None} | world.about


def path_text(path: str | Path | None) -> str | None:
    """A path as JSON data."""
    return None if path is None else str(path)
