"""What every class that can be added has to hold, for the program's own and for those of a user.

``pytest -p schuler_bench.contract.plugin --schuler-plugin mine.py`` holds the classes that a file registers
against it; the tests of the program call the same checks on its own classes.
"""
