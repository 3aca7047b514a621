"""How fast does it roll about its long axis, and with what?"""
