"""
Code that is the same in all nodes that deros generates.

A generated package carries a copy of the modules that it needs, or depends on this package.
"""

__version__ = '0.1.0'


class RuntimeVersionError(ImportError):
    """A package was generated for another version of this one."""


def require(version: str, package: str) -> None:
    """
    Refuse to be used by a package that was generated for another version.

    Generated packages call this when they are built and when they are imported, before anything
    else of them runs. Every version has this function.

    Raises RuntimeVersionError, which names both versions.
    """
    if version != __version__:
        raise RuntimeVersionError(
            f'{package} was generated for deros_runtime {version}, but {__version__} is '
            f'installed: build deros_runtime {version} (deros runtime), or generate {package} '
            'again'
        )
