"""The report: its matrix of verdicts, its page, and its files for programs."""
