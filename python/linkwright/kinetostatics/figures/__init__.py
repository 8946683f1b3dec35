"""Figures of forces."""
