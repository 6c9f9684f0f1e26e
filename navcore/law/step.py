"""One call of the law, compiled twice from one source: the plain step and the full one.

Policy and switching are asked through a choice made from their registries. Most runs need of all this only
what a `plain` policy and a `plain` switching method need; their step is inlined into the mechanization
without the rest, which takes half the time.
"""

from typing import Any, NamedTuple

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.registry import Registry
from navcore.law.added_call import (
    ADDED,
    ADDED_ID,
    decide_added,
    feed_added,
    follow_added,
    restore_added,
    switch_added,
)
from navcore.law.dispatch import Choice, dispatch
from navcore.law.history import remember
from navcore.law.network_state import advance_network, clear_network, rest, second_output
from navcore.law.policy import POLICIES
from navcore.law.records import (
    AS_DECIDED,
    AS_PRINTED,
    CLEAR,
    FREE,
    MASKED,
    NOTHING,
    REST,
    RESTORE,
    E,
    N,
)
from navcore.law.switching import SWITCHINGS
from navcore.law.tuned_network import retune


class Correction(NamedTuple):
    """Output of the law: velocity corrections c (m/s) and accelerations a fed back (m/s^2)."""

    c_e: float
    c_n: float
    a_e: float
    a_n: float


def _choices(registry: Registry[Any], function: str, added: Any = None, plain: bool = False) -> list[Choice]:
    """Compiled functions of a registry's own entries, those that have one, and what calls an added one's.

    With ``plain`` those of plain entries.
    """
    functions = ((i, name, getattr(registry[name], function)) for i, name in enumerate(registry.own))
    wanted = (each for each in functions if each[2] is not None)
    choices = [Choice(*each) for each in wanted if registry[each[1]].plain or not plain]
    return choices if added is None else [*choices, Choice(ADDED, ADDED_ID, added)]


_decide = dispatch("policies", _choices(POLICIES, "decide", decide_added), True)
_decide_plainly = dispatch("policies", _choices(POLICIES, "decide", plain=True), True)
_follow = dispatch("policies", _choices(POLICIES, "follow", follow_added), None)
_switch = dispatch("switchings", _choices(SWITCHINGS, "switch", switch_added), None)
_switch_plainly = dispatch("switchings", _choices(SWITCHINGS, "switch", plain=True), None)
_feed = dispatch("switchings", _choices(SWITCHINGS, "feed", feed_added), (0.0, 0.0))
_restore = dispatch("switchings", _choices(SWITCHINGS, "restore", restore_added), None)


@inlined
def _carry_out(law, u_e, u_n, full):
    """Do to the network what the switching method asks for."""
    p, s = law.p, law.s
    if full and p.tuning.code != 0 and s.to_xi > 0.0:
        retune(p, s, s.to_xi, u_e, u_n)
    if s.action == CLEAR or not s.started:
        clear_network(law, u_e, u_n)
    if full:
        if s.action == REST:
            rest(law, u_e, u_n)
        elif s.action == RESTORE:
            _restore(p.switching, law)
        elif s.action == MASKED:
            advance_network(law, u_e, u_n)


def _make_step(decide: Any, switch: Any, full: bool) -> Any:
    """Compile the step; without ``full`` what only some policies and methods need is left out."""

    @inlined
    def step(law, sensed):
        p, s = law.p, law.s
        internal = s.internal
        u_e = -sensed.v_e if internal else s.difference[E]
        u_n = -sensed.v_n if internal else s.difference[N]
        if full and p.keeps_history:
            remember(law, u_e, u_n, sensed)
        s.wanted = AS_DECIDED
        wanted = decide(p.policy, law, sensed)
        if s.wanted == AS_DECIDED:
            s.wanted = 1 if wanted else 0
        fed_anew = False
        if full and s.internal != internal:
            internal, fed_anew = s.internal, True
            u_e = -sensed.v_e if internal else s.difference[E]
            u_n = -sensed.v_n if internal else s.difference[N]
        if not internal and not s.valid:
            wanted, s.wanted = False, 0
        if full:
            if wanted and not s.damped:
                s.switch_time = s.clock
            _follow(p.policy, law, u_e, u_n)
        s.to_xi, s.action = 0.0, NOTHING
        switch(p.switching, law, wanted)
        if full and fed_anew and s.damped:
            s.action = CLEAR
        _carry_out(law, u_e, u_n, full)
        s.started = True
        if full and p.runs_on:
            u_e, u_n = _feed(p.switching, law)
        elif not s.damped:
            if not (full and p.freezes):
                s.correction[E] = s.correction[N] = 0.0
            return Correction(s.correction[E], s.correction[N], 0.0, 0.0)
        s.engaged = True
        a_e = a_n = 0.0
        if p.feeds_back:
            a_e = second_output(p.order, s.network, s, E, u_e)
            a_n = second_output(p.order, s.network, s, N, u_n)
        c_e, c_n = advance_network(law, u_e, u_n)
        if p.realisation == AS_PRINTED:
            c_e, c_n = as_printed(c_e, c_n, sensed, u_e, u_n)
        k1 = p.feedback_k1
        if full:
            k1 += s.feedback_gain
            c_e += s.offset[E]
            c_n += s.offset[N]
            s.offset[E] *= p.offset_decay
            s.offset[N] *= p.offset_decay
        s.correction[E], s.correction[N] = c_e, c_n
        if p.feeds_back:
            return Correction(c_e, c_n, a_e, a_n)
        return Correction(c_e, c_n, k1 * u_e, k1 * u_n)

    return step


@inlined
def as_printed(c_e, c_n, sensed, u_e, u_n):
    """Leave out the reference's transport rate: Deng 4 forms the platform's from the difference alone."""
    return c_e - (sensed.v_e + u_e), c_n - (sensed.v_n + u_n)


_plain_step = _make_step(_decide_plainly, _switch_plainly, full=False)
_inlined_full_step = _make_step(_decide, _switch, full=True)


@kernel
def _full_step(law, sensed):
    """Every policy and switching method."""
    return _inlined_full_step(law, sensed)


@inlined
def law_step(law, sensed):
    """Return the `Correction` of a call; `Law` and `Sensed` are those of `navcore.law.records`.

    The held difference V_r - V_c and its validity are already in the law's state.
    """
    if law.p.damping == FREE:
        return Correction(0.0, 0.0, 0.0, 0.0)
    if law.p.plain:
        return _plain_step(law, sensed)
    return _full_step(law, sensed)
