"""Mutation run over navcore: small changes of the code, and whether the tests notice (`make mutation`)."""
