"""Output for people: the style of figures, text from outside, and files that are never incomplete."""
