"""Systems at run time: names resolved, safety nodes added, topics known."""
