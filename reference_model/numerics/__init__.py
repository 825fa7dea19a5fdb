"""Mathematics that knows nothing of friction: roots, continuation, collocation."""
