"""What every wing stands on: errors, files, progress, threads, catalogs, jobs, rotations.

Nothing here knows a robot, a flow or an experiment, and nothing here imports another wing. A user sees the errors
(``core.errors``), the catalogs of robots, gaits and experiments (``core.catalog``), and where the things of a project
or of a plug-in come from (``core.sources``). Files appear whole or not at all (``core.writing``), are read up to a
size (``core.reading``), and say what made them (``core.files``). Many pieces of work are one job (``core.jobs``).

Start reading with ``core.errors``, then ``core.catalog``.
"""
