"""How far does it still crawl when joints of its legs fail?"""
