"""What editors ask for, a module for each kind of question."""
