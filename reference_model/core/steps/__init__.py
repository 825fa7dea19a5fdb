"""Steps of both methods: explicit, and by collocation."""
