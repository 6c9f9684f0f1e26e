"""The first five minutes: start card, guided tour, scenarios and networks with pictures."""
