"""What a building does to a robot: seconds of moves by hour, and places that are blocked.

Read in this order: `travel`, `move_costs`, `passes`, `edge_times`, `blocked_moves`.
"""

from lifelore.agent.travel.travel import Travel

__all__ = ["Travel"]
