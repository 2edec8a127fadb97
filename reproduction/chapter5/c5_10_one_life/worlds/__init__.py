"""The eight families of claim C5.10 by name, each in a file."""

from reproduction.chapter5.c5_10_one_life.worlds.cart_pole import CART_POLE
from reproduction.chapter5.c5_10_one_life.worlds.door_key import DOOR_KEY
from reproduction.chapter5.c5_10_one_life.worlds.family import Family
from reproduction.chapter5.c5_10_one_life.worlds.multi_room import MULTI_ROOM
from reproduction.chapter5.c5_10_one_life.worlds.pacman import PACMAN
from reproduction.chapter5.c5_10_one_life.worlds.slippery_lake import SLIPPERY_LAKE
from reproduction.chapter5.c5_10_one_life.worlds.surveillance import SURVEILLANCE
from reproduction.chapter5.c5_10_one_life.worlds.taxi import TAXI
from reproduction.chapter5.c5_10_one_life.worlds.windy_grid import WINDY_GRID

FAMILIES: dict[str, Family] = {
    "windy grid": WINDY_GRID,
    "slippery lake": SLIPPERY_LAKE,
    "DoorKey": DOOR_KEY,
    "MultiRoom": MULTI_ROOM,
    "Taxi": TAXI,
    "CartPole": CART_POLE,
    "Pacman": PACMAN,
    "surveillance": SURVEILLANCE,
}
"""Each family by its name."""
