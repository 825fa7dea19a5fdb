"""Measurement of studies in separate processes, with findings stored for a resumption."""
