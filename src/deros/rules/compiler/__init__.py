"""From rules as written to their program, or to what is wrong with them."""
