"""The friction connectors of the Exudyn models on their own: what they exchange, and how they are linearised."""

from compare.studies.engines.connector.claims import STUDY

__all__ = ["STUDY"]
