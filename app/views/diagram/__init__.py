"""Tab "Diagram": the loop of the selected method as blocks, with the values in force."""
