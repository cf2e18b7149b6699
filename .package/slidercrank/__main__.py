"""Runs the command line: `python -m slidercrank` is the same as `slidercrank`."""

from slidercrank.service.cli import main

if __name__ == "__main__":
    main()
