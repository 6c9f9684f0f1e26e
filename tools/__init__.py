"""Programs that serve the making: stages of `make test`, reports, measurements, mutations, translations."""
