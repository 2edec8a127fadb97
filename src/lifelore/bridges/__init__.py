"""Connections to other programs: Gymnasium, MiniGrid, Stable-Baselines3, rosbags and PDDL planners."""
