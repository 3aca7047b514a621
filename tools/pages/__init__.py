"""Pages of the documentation that are made at build: nothing of them is committed, so nothing grows old."""
