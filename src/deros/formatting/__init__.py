"""The layout of models' texts: the same tokens and comments, in lines as they are best read."""
