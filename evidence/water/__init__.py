"""Water for any MuJoCo model, against exact answers and published numbers: ``python -m evidence.water``."""
