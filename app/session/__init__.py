"""One visitor: scenario, history, pins, requirements, uploads, and how all of it is kept. No widgets."""
