"""What is made before anything is started."""
