"""General numerical methods, independent of friction: roots, continuation, collocation."""
