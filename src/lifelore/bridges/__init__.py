"""Connections to other programs: MiniGrid, Stable-Baselines3, rosbags, PDDL planners, clients of the service."""
