"""What pins and discs share in the kernels: lanes, the step, the motion inside of it."""
