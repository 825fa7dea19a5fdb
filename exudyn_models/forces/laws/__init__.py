"""What coefficient and load may be: numbers, tables and functions, and how compiled code asks them."""
