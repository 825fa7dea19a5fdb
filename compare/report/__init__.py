"""The report: what it looks like (``style``, ``animation``) and how it is written (``write``)."""
