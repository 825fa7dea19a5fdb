"""How a sweep is computed: chunks of work, those who execute them, the store, what follows from it."""
