"""The constants of the body wave, equation (20), as bare numbers: the article gives no units."""

C1 = 0.027
"""Linear coefficient of the envelope, printed without a unit."""
C2 = 0.30
"""Quadratic coefficient of the envelope, printed without a unit."""
K = 0.023
"""Wave number, printed without a unit."""
