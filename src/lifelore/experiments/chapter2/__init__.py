"""Claims of chapter 2: perception: contact point networks and spatial relations.

One folder a claim; the files beside the folders serve several claims.
"""
