"""Above the tabs: verification with the full strapdown."""
