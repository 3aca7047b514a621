"""Questions and their answers: experiments, studies of many designs, searches.

``experiments.experiment`` is the contract of an experiment and its outcome, ``experiments.catalog`` holds one folder
for each question, ``experiments.claims`` the rules of all of them by claim, ``experiments.study`` varies designs, and
``experiments.optimise`` searches better ones. Nothing here knows the command line or reports.

Start reading with ``experiments.experiment``, then ``experiments.catalog.displacement``.
"""
