"""Design: which source an error is made of, how far it is from the best possible, which setting is best.

`stochastic` makes the model of the sensors from a scenario; `level` is one level channel with a method's
loop and gives the steady error budget; `floor` is the least error that any causal linear damping can reach;
`along` is the transient budget along the scenario's motion; `budget` joins them (theory.md 14 to 20).
"""
