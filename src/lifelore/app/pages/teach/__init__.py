"""The page /teach: a person assembles in the factory, and learners use the prior beside it (Figure 3.16)."""
