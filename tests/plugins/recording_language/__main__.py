"""``deros`` with a fourth language, declared before anything else is imported."""

from deros.metamodels import languages
from tests.plugins.recording_language.language import RECORDING

languages.LANGUAGES = (*languages.LANGUAGES, RECORDING)

if __name__ == "__main__":
    from deros.cli.main import main

    main()
