"""Claims of chapter 2: perception: contact point networks and spatial relations.

One folder a claim; `scenes` and `scoring` serve several claims.
"""
