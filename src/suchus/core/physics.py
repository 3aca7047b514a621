"""Constants of nature that every wing shares."""

GRAVITY = 9.81
"""Acceleration of free fall [m/s2]."""
WATER_DENSITY = 1000.0
"""Density of fresh water of 20 degrees Celsius, rounded [kg/m3]."""
WATER_VISCOSITY = 1e-3
"""Dynamic viscosity of fresh water of 20 degrees Celsius [Pa s]."""
