"""An eel that swims by itself, from rest, and the film of it; the grid travels with it."""

from suchus import flow
from suchus.visual.figures.flow import FieldFilm, vorticity

grid = flow.Grid.covering((-1.0, 3.0), (-1.0, 1.0), cell=1 / 96)
eel = flow.FreeBody(shape=flow.eel(1.0, period=1.0), name="eel")
swim = flow.Simulation(flow.Setup(grid=grid, viscosity=1.4e-4, bodies=(eel,), follow="eel"))
print(f"{100 * swim.thin_fractions['eel']:.0f} % of the eel, its tail, is thinner than the grid resolves")
film = FieldFilm(interval=0.05, limit=12.0)
last = swim.run(4.0, checkpoint="eel.npz", watch=film).select_after(3.0)
film.save("eel.gif")
vorticity(swim, limit=12.0).savefig("eel.png")
print("speed in the fourth cycle", round(-last.column("velocity_x").mean(), 3), "lengths per period")
