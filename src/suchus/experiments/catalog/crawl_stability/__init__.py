"""Does it crawl more steadily with spine and tail than without?"""
