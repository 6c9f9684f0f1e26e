"""For developers: finds the texts of the page and keeps the catalogues of `schuler_bench.languages`."""
