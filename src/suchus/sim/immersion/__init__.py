"""Water for any MuJoCo model, in MuJoCo's own step: ``wet``, seas and currents, coefficients of geoms.

Knows no robot of suchus; the forces themselves are in ``sim.hydro``. ``wetting`` registers the plugin by which MuJoCo
calls them, ``structs`` derives where MuJoCo's fields lie. ``grains`` lets dry grains act instead. Start reading with
``door.wet``.
"""

from suchus.sim.immersion.coefficients import GeomCoefficients
from suchus.sim.immersion.door import WaterLoads, water_loads, wet
from suchus.sim.immersion.sea import Current, Wave, sea

__all__ = ["Current", "GeomCoefficients", "WaterLoads", "Wave", "sea", "water_loads", "wet"]
