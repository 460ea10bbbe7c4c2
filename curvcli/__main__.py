"""`python -m curvcli` is `curvcli`."""

from .commands.main import main

if __name__ == "__main__":
    main()
