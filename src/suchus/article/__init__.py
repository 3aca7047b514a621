"""The article as data, and the rules by which its claims are judged.

``article.paper`` holds tables, equations, claims and misprints of the article; ``article.verdict`` the rules as data,
what they say of measures, and the fraction of designs that agree. Nothing here knows robots, simulations or
experiments.

Start reading with ``article.paper.claims``, then ``article.verdict.rule``.
"""
