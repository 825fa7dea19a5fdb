"""What every command needs at its door: options, refusals in a sentence, progress."""
