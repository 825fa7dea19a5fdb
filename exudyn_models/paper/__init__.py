"""The paper's pin and disc as Exudyn models, and their simulation."""
