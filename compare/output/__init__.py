"""What is written for people: how figures look, and files that are whole at every moment."""
