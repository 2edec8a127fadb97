"""Topology of contact point networks: substructure, functional similarity, holes and grasp seeds (thesis §2.3.6).

Read in this order: `substructure`, `functional_similarity`, `holes`, `grasp_seeds`; `sight` serves `holes`.
"""
