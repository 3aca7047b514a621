"""When things happen in the article's crawling experiments (IV.A)."""

CYCLE_PERIOD = 4.0
"""Duration of one crawling cycle [s]: seconds 1 to 5, then 5 to 9."""
CYCLES = 2
"""Number of cycles in an experiment [-]."""
CRAWL_START = 1.0
"""Time at which the first cycle begins [s]."""
CRAWL_END = CRAWL_START + CYCLES * CYCLE_PERIOD
"""Time at which the last cycle ends [s]."""
SNAPSHOT_TIMES = (1.2, 1.5, 1.8)
"""Times at which Fig. 14 shows the robot [s]."""
