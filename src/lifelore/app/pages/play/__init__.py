"""The page /play: the ball game for people, the study of §4.8.5, and its results."""
