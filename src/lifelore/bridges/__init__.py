"""Connections to other programs: MiniGrid, Stable-Baselines3, rosbags and PDDL planners."""
