"""Simulation on land and at the surface of the water: models, batches of runs, records, measures, faults.

``sim.model`` makes a MuJoCo model of a design, ``sim.land`` runs a batch, ``sim.record`` is the schema of what a run
records, ``sim.metrics`` reads measures from a record, ``sim.faults`` breaks joints, ``sim.hydro`` computes the forces
of water on pieces. Nothing here draws pictures.

Start reading with ``sim.land.simulation``.
"""
