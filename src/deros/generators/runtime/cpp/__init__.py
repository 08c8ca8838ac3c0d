"""C++ that is the same in all packages whose nodes need it; its namespace becomes the package."""
