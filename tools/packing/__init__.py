"""Packages of the tools for others: `tools/wheels`."""
