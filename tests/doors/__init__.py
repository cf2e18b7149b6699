"""Record of what every door answers, the command line and the API, to be compared with that of another version.

    python -m tests.doors record FOLDER
    python -m tests.doors compare FOLDER FOLDER [--allowed FILE]

Each file of `scripts/` is one machine: a list of commands and requests, run in turn in a folder of its own that holds
the files of `jobs/`. `record` writes one text file for each. Whatever differs from run to run is masked (`masks.py`).
"""
