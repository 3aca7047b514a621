"""How does a salamander's own swim, played joint by joint on its model, swim?"""
