"""Coarse and compass alignment: where navigation begins."""
