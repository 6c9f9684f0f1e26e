"""Places in the law's records for code that was added from outside the program, and how it is called.

The kernels are compiled once, with one place for an added policy, one for an added switching method and one
for a user's whole law. The place holds the address of a function with the C calling convention, and room for
its numbers; the kernels call that address. Code that is added is therefore compiled by itself, in seconds,
and no kernel of the program is compiled anew (`navcore.law.added_code` compiles it).
"""

from typing import Any

from numba import extending, types
from numba.core import cgutils
from numba.core.cgutils import ir

from navcore.foundation.compiled import inlined
from navcore.foundation.records import COUNT, REAL, record_type

ADDED = 255
"""Number of an added policy or switching method in the law's parameters."""
ADDED_ID = "added"
"""Name of their place in the records."""
ROOM_NUMBERS, ROOM_MEMORY = 32, 64
"""Room for the numbers and for the memory of an added class, 8 bytes each."""
POLICY_NUMBERS = record_type(room=(REAL, (ROOM_NUMBERS,)), decide=COUNT, follow=COUNT)
SWITCHING_NUMBERS = record_type(room=(REAL, (ROOM_NUMBERS,)), switch=COUNT, restore=COUNT, feed=COUNT)
ADDED_MEMORY = record_type(room=(REAL, (ROOM_MEMORY,)), pair=(REAL, (2,)))
"""Its memory, and the two numbers that ``feed`` gives."""
GIVEN, COMMANDED = 9, 6
"""Numbers that a user's law is given, and that it gives (`navcore.exporting.step`, the contract's order)."""
USER_PARAMETERS = record_type(step=COUNT, handle=COUNT)
"""Address of a user's law, and what it is given to tell its instances apart; address 0: there is none."""
USER_STATE = record_type(
    given=(REAL, (GIVEN,)), commanded=(REAL, (COMMANDED,)), epoch=COUNT, last=(REAL, (2,)), asked=COUNT
)
"""What it is given and gives, the log epoch that it has seen, and the velocity of the call before."""

intrinsic: Any = extending.intrinsic  # its type does not tell that the typing context is left out
_POINTER, _WHOLE, _NUMBER = ir.IntType(8).as_pointer(), ir.IntType(64), ir.DoubleType()


@intrinsic
def _call_added(typingctx: Any, address: Any, own: Any, memory: Any, law: Any, a: Any, b: Any, c: Any) -> Any:
    """Call ``int64 address(own, memory, p, s, ring, rows, a, b, c)``."""
    p, s, ring = law.types
    signature = types.int64(types.int64, own, memory, law, types.float64, types.float64, types.float64)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        address, own, memory, law, *numbers = arguments
        parts = cgutils.unpack_tuple(builder, law, 3)
        array = context.make_array(ring)(context, builder, parts[2])
        rows = cgutils.unpack_tuple(builder, array.shape)[0]
        pointers = [builder.bitcast(one, _POINTER) for one in (own, memory, *parts[:2], array.data)]
        kind = ir.FunctionType(_WHOLE, [_POINTER] * 5 + [_WHOLE] + [_NUMBER] * 3)
        return builder.call(builder.inttoptr(address, kind.as_pointer()), [*pointers, rows, *numbers])

    return signature, generate


@intrinsic
def call_user_law(typingctx: Any, address: Any, handle: Any, state: Any) -> Any:
    """Call ``int64 address(handle, state)``: 0 where the law has given its commands."""
    signature = types.int64(types.int64, types.int64, state)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        address, handle, state = arguments
        kind = ir.FunctionType(_WHOLE, [_WHOLE, _POINTER])
        pointer = builder.inttoptr(address, kind.as_pointer())
        return builder.call(pointer, [handle, builder.bitcast(state, _POINTER)])

    return signature, generate


@inlined
def decide_added(own, memory, law, sensed):
    """Ask an added policy."""
    return _call_added(own.decide, own, memory, law, sensed.v_e, sensed.v_n, sensed.heading) != 0


@inlined
def follow_added(own, memory, law, u_e, u_n):
    """Let an added policy change the running network."""
    if own.follow != 0:
        _call_added(own.follow, own, memory, law, u_e, u_n, 0.0)


@inlined
def switch_added(own, memory, law, wanted):
    """Ask an added switching method."""
    _call_added(own.switch, own, memory, law, 1.0 if wanted else 0.0, 0.0, 0.0)


@inlined
def restore_added(own, memory, law):
    """Let an added switching method put the network's states back."""
    if own.restore != 0:
        _call_added(own.restore, own, memory, law, 0.0, 0.0, 0.0)


@inlined
def feed_added(own, memory, law):
    """Return what an added switching method feeds the network with, E and N, m/s."""
    if own.feed != 0:
        _call_added(own.feed, own, memory, law, 0.0, 0.0, 0.0)
        return memory.pair[0], memory.pair[1]
    return 0.0, 0.0
