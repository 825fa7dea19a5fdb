"""Standard problems on a plane at rest, with closed forms."""
