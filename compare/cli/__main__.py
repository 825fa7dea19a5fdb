"""``python -m compare.cli`` is ``friction-discs``."""

from compare.cli import main

if __name__ == "__main__":
    main()
