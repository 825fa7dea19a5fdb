"""How a sweep is computed: chunks of work, those who execute them, what follows from it."""
