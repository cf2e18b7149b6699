"""What every quantity means, for engineers: a sentence, a formula, where it is derived."""
