"""The classes of textX's plug-in registration, for the rooms that offer plug-ins to textX.

textX recognises a generator by its class. No other room imports textX.
"""

from textx.exceptions import TextXError
from textx.registration import GeneratorDesc, GeneratorParam, LanguageDesc

__all__ = ["GeneratorDesc", "GeneratorParam", "LanguageDesc", "TextXError"]
