"""Diagnosis of an engine: friction law, order and limit of its errors, from short motions at four steps."""
