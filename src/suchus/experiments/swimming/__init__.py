"""How does it swim?"""
