"""The ball game: `games`, signals of `moves`, players and their `play`, `learners`, and the `methods` compared."""
