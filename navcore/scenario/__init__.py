"""The scenario: model, file, guide, schema, and the faults that only the whole of it can tell."""
