"""What users start: the command line, reports, the viewer and environments.

Nothing else may import this wing.

Start reading with ``apps.cli.entry``.
"""
