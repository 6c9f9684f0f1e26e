"""Figure helpers that several views share: style, units, plot data for plotly and uPlot."""
