"""How does it swim in six degrees of freedom, at the surface?"""
