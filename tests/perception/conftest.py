"""Scenes put together by hand: box clouds, contacts where the test says, relations as given."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.contacts.contact_points import ContactPoint
from lifelore.perception.contacts.interface import Interface
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import Scene

UP = (0.0, 0.0, 1.0)


def box_surface(low, high, spacing=0.005):
    """Points on the six faces of an axis-parallel box, metres."""
    low, high = np.array(low, float), np.array(high, float)
    steps = [np.linspace(a, b, max(round((b - a) / spacing), 1) + 1) for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 3)
    return grid[((grid == low) | (grid == high)).any(axis=1)]


def contact(at, normal, other, strength=1.0):
    return ContactPoint(np.array(at, float), np.array(normal, float), np.zeros(3), strength, 7, other)


def interface(a, b, places, gap=0.0, normal=UP):
    """An interface whose contacts face each other in pairs; a place is a point or (point, normal into a)."""
    places = [place if len(np.shape(place[0])) else (place, normal) for place in places]
    first = tuple(contact(at, n, b) for at, n in places)
    second = tuple(contact(at, -np.array(n), a) for at, n in places)
    edges = np.array([[k, k] for k in range(len(places))], np.int64).reshape(-1, 2)
    return Interface(a, b, gap, first, second, edges)


@pytest.fixture
def box():
    return box_surface


@pytest.fixture
def meet():
    return interface


@pytest.fixture
def make_scene():
    """``make_scene({label: points}, [interface, …], [(a, b, relation[, confidence]), …])``."""

    def make(clouds, interfaces=(), relations=(), camera=None):
        clouds = {TABLE: np.zeros((1, 3)), **clouds}
        points = np.concatenate([np.asarray(cloud, float) for cloud in clouds.values()])
        labels = np.repeat(np.array(list(clouds), np.int64), [len(cloud) for cloud in clouds.values()])
        stated = tuple(Relation(a, b, name, *(rest or (1.0,)), 0.0) for a, b, name, *rest in relations)
        return Scene(LabelledCloud(points, labels, camera=camera), tuple(interfaces), stated)

    return make
