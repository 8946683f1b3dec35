"""Computes how machines move: from the motor through gearbox and shaft to the mechanism and its work."""
