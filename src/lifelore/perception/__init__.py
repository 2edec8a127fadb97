"""Clouds in, scene graph out: segmentation, separation, contact point networks, relations, logic (ch. 2)."""
