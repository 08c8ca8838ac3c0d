"""C++ that is the same in every package with actions; its namespace becomes the package."""
