"""What each word of a model is: where it is declared, its type and its unit."""
