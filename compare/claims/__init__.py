"""What a verdict is made of: claims and studies, their errors, what agreement is worth."""
