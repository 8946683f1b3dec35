"""Figures of pumping units and rotators."""
