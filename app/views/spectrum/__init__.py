"""Tab "Spectrum": amplitude over period of an error."""
