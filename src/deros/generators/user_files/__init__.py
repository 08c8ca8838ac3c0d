"""What the files that belong to users lack of what newly generated code needs."""
