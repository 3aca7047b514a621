"""What ``make release`` and ``make matrix`` do: build, and try what was built in fresh environments."""
