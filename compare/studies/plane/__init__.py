"""Standard problems on a plane at rest, with closed forms: what an engine can show without a turntable."""
