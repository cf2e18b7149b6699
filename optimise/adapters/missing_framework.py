"""Error for an optional framework that is not installed."""

from ...model.errors import InputError


def missing_framework_error(framework: str, error: ImportError) -> InputError:
    """Return an error that names the extra to install; for any other missing import, return the error itself."""
    if error.name is None or error.name.partition(".")[0] != framework:
        raise error
    return InputError(f'{framework} is needed; it is not installed; run pip install "slidercrank[{framework}]"')
