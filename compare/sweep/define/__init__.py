"""What a sweep computes: axes, distributions, the plan made of them, and where it refines."""
