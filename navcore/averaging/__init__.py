"""Half-period averaging: oscillations cancelled by copies of the navigation that are half a period ahead.

Zhao 2015; theory.md sections 5 and 9.4. ``damping = "averaging"`` runs several free navigations on the same
IMU. All start from the same state after alignment, but each copy first runs some time on a *forecast* of the
IMU (the mean of the alignment record, with small motions of the base taken out), so that its oscillations
arrive with the opposite sign. The output is a mean of copies. What it can do is change the state at t = 0:
errors that arise later (sensor noise, biases turned by a manoeuvre) pass unhindered.

How the parts fit together::

    plan                 copies, forecast, notices: the same for both fidelities
      record             alignment record: one-second increments of a standing vehicle, disturbed or not
      forecast           base motion found and left out, means in the body axes of t = 0
      copies             how far each copy is ahead, and which give level and slow outputs
    error_model          driver shaped like `ErrorModelRun`
    strapdown            driver shaped like `StrapdownRun`: may be one of the runs of `drive`
    combine              means of rows, statistics, plot bins
    lines                amplitude of the Schuler, Foucault and 24 h lines: before and after

A simulation joins a method with ``damping = "averaging"`` in four steps:

1. ``made = prepare_averaging(method.averaging, truth_row_0, omega_s, earth, imu, alignment.duration_s,
   alignment.motion, seed)``; its ``notices`` go to the method's warnings.
2. The law is that of a free method (`prepare_law("free", UndampedNetwork(), ...)`).
3. Error model: ``run = start_error_model(made, start_state, earth, step_s, steps, output_step_s,
   coefficients, sensors, law)``; then ``run.advance(chunk)``, ``run.position``, ``run.diverged`` and
   ``run.recorder`` as of any other method.
4. Strapdown: ``run = start_strapdown(made, start, settings, earth, make_law, truth, before)``; then ``run``
   goes into `drive` beside the other methods' runs; ``reason``, ``recorder`` and ``navigation`` as of any
   `StrapdownRun`.
"""

from navcore.averaging.parameters import AlignmentMotion, Averaging

__all__ = ["AlignmentMotion", "Averaging"]
