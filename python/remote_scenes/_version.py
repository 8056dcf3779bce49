"""The suite's version; scripts/version writes it, the build refuses another one than its own."""
__version__ = "0.9.0"
