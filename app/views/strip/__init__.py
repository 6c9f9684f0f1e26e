"""Strip of results below the top bar: a card a method; the legend of all pictures."""
