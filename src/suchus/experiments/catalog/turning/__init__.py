"""How tightly does it turn, and does it walk the circle that was asked for?"""
