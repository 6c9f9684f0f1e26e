"""The reproduction report: what each paper claims, what comes out here, and why they differ where they do.

``python -m tools.papers`` (or ``make papers``) writes ``docs/papers.md`` with its pictures.
The claims are data, one module a paper; every number on our side comes from a function of the runs.
"""
