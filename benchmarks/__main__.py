"""Run all benchmarks and print their figures: `make benchmark`, or `python -m benchmarks` in the project's folder."""

from . import corners, evaluation, many_designs, methods, page, page_design, peak_accuracy, search, startup
from .report import machine, show


def main() -> None:
    """Measure and print."""
    print(machine())
    show("Evaluation", [*evaluation.speed(), *evaluation.accuracy(), *evaluation.memory()])
    show("Search", [row for job in ("feeder", "sieve") for row in search.compare(f"runs/{job}.toml")])
    show("Methods: hypervolume of the designs delivered over that of the default's", methods.compare())
    show("Many designs", many_designs.grows())
    show("Unusual jobs, each solved in a warm process", corners.corners())
    show("Commands", startup.commands())
    show(f"The page with a front of {page.DESIGNS} designs", page.measure())
    show("A design on the page", page_design.solved())
    show("Greatest relative error of peak torque, 1,000 random linkages", peak_accuracy.accuracy())


main()
