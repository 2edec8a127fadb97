"""Draws what `make demo` lived: searches for hidden goals, drives to known ones, and the floor as it was learnt.

Run: python examples/demo/picture.py FOLDER, after the two lives of `make demo` have written there.
"""

import json
import sys
from pathlib import Path

from known_and_hidden import draw_known_and_hidden

from lifelore import open_memory
from lifelore.agent.live.buildings.recognition import recognised_place
from lifelore.agent.live.output.drive_figure import learnt_floor, lost_time
from lifelore.agent.travel.travel import Travel
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.figures.style import save_figure

folder = Path(sys.argv[1])
hidden, known = (json.loads((folder / name / "summary.json").read_text()) for name in ("hidden", "known"))
settings = WorldSettings()
occupancy = map_from_settings(settings)
world = world_from_settings(settings, occupancy)
with open_memory(folder / "lifelore.db", read_only=True) as memory:
    place = recognised_place(settings, world, occupancy, memory)
    travel = Travel.recalled(place.world, place.grid, memory)
metres = {
    name: [task["agents"][name]["steps_to_80"] * world.frame.cell for task in hidden["tasks"]]
    for name in ("lore", "scratch")
}
share = known["summary"]["lore_vs_map_only"]["last"]["seconds_ratio"]["value"]
saved = hidden["summary"]["lore_vs_scratch"]["steps_to_80_ratio"]["value"]
title = (
    f"One office, one memory. Last third: hidden goals with × {saved:.2f} of the metres, "
    f"known goals in × {share:.2f} of the seconds"
)
figure = draw_known_and_hidden(metres, lost_time(known), learnt_floor(travel), title=title)
print("wrote", save_figure(figure, folder / "demo.png"))
