"""How good are the tail's formulas, from straight to bent by a half turn and in the crawl?"""
