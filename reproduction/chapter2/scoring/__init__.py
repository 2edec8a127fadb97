"""Scores of perception: relations, networks and times, with the panels that draw them.

Start with `relation_scoring`; `pair_validation` cross-validates, `method_panels` draws.
"""
