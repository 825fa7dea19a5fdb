"""What two or more studies share."""
