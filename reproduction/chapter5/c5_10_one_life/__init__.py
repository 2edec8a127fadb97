"""Claim C5.10: `LongLivedAgent` and its ablations in eight families of `worlds`; see `run`."""
