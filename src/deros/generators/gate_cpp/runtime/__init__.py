"""C++ that is the same in every package with gates; its namespace becomes the package."""
