"""Evidence that suchus is right: kept results, what shows that they are current, and the programs that renew them.

Not installed. ``store`` reads and writes ``results/NAME.json``; ``registry`` lists the results with the code that each
reaches and a probe of its behaviour; ``stale`` says which are old and what they cost; ``renew`` computes them again;
``tolerance`` says how far a number may move between processors and still mean the same. Nothing of ``src`` may import
this package. Start with ``registry``.
"""
