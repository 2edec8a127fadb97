"""Topology of contact point networks: holes and grasp seeds (thesis §2.3.6).

Read in this order: `holes`, `grasp_seeds`; `sight` serves `holes`.
"""
