"""What pins and discs share in the kernels: lanes and laws, what is asked of them, what shows an end."""
