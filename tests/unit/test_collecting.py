"""The garbage collector of a server: what lives as long as the server is not looked through again."""

import subprocess
import sys

_CHILD = """
import gc
from app.memory import collect_seldom

lasting = [[number] for number in range(10_000)]
collect_seldom()
later = [[number] for number in range(10_000)]
seen = {id(one) for one in gc.get_objects()}
print(sum(id(one) in seen for one in lasting), sum(id(one) in seen for one in later))
"""


def test_only_what_came_later_is_looked_through():
    made = subprocess.run([sys.executable, "-c", _CHILD], capture_output=True, text=True, check=True)
    lasting, later = map(int, made.stdout.split())
    assert (lasting, later) == (0, 10_000)
