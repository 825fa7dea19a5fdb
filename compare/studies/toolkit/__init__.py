"""Code shared by two or more studies."""
