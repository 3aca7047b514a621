"""How far does it crawl, with spine and tail and without?"""
