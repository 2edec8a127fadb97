"""The ball game: `games`, players and their `play`, `learners`, and the `methods` that are compared."""
