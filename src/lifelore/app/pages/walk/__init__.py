"""The page `/walk`: a person explores a building, and the advisor helps where the person seems lost."""
