"""The laboratory in one page: a robot that walks or swims in a browser, with MuJoCo's engine in WebAssembly.

Start reading with ``page``: it puts the facts of a robot (``description``), the engine (``engine``) and the modules in
JavaScript into one HTML file. The modules repeat what ``robot.motion``, ``sim.land``, ``sim.metrics`` and ``sim.hydro``
compute; tests compare them on the same inputs.
"""
