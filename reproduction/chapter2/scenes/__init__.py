"""Scenes of chapter 2: drawn, photographed, perturbed, and stored as rows of a result.

`arranged_scenes` and `real_scenes` give clouds, `perturbation` worsens them; `tabletop_pairs`, `skeletons` and
`scene_example` read them.
"""
